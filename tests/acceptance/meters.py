"""Meters in the real Mitsuba, for acceptance scripts: an exported scene's camera makes room for an irradiance meter all over a white sphere, or
for a ray that looks at a white wall."""
import json
import math
import os
import pathlib
import subprocess
import sys
import xml.etree.ElementTree as ET

ROOT = pathlib.Path(__file__).resolve().parents[2]
RADIUS = 12.0
PI = math.pi
Y = (0.2126, 0.7152, 0.0722)
FILM = 32  # pixels a side of the flux meter, all alike: one pixel's sum in single precision drifts by .4 % over a million equal samples


def reach_mitsuba():
    """Mitsuba of this interpreter, else the script again under the one of .venv or ETENDUE_MITSUBA; exit 77 without one."""
    try:
        import mitsuba  # noqa: F401
        return
    except ImportError:
        pass
    for place in [os.environ.get("ETENDUE_MITSUBA", ""), str(ROOT / ".venv")]:
        python = pathlib.Path(place) / "bin/python3" if place and pathlib.Path(place).is_dir() else pathlib.Path(place)
        if place and python.exists() and "ETENDUE_METERS" not in os.environ:
            os.environ["ETENDUE_METERS"] = "again"
            os.execv(str(python), [str(python), *sys.argv])
    print("no Mitsuba in .venv or ETENDUE_MITSUBA: skipped")
    sys.exit(77)


def start_mitsuba():
    """Mitsuba with its fast variant where LLVM is there."""
    llvm = os.environ.get("DRJIT_LIBLLVM_PATH") or next(
        (str(path) for version in (19, 20, 18, 17, 16) for path in sorted(pathlib.Path("/usr/lib").glob("*/libLLVM.so.%d*" % version))), "")
    if llvm:
        os.environ["DRJIT_LIBLLVM_PATH"] = llvm
    import mitsuba as mi
    mi.set_variant("llvm_ad_rgb" if llvm else "scalar_rgb")
    mi.set_log_level(mi.LogLevel.Error)
    return mi


def convert(etendue, light, folder, name):
    rig = folder / (name + ".rig.json")
    rig.write_text(json.dumps({"etendue": 1, "lights": [light]}))
    xml = folder / (name + ".xml")
    run = subprocess.run([etendue, "convert", str(rig), str(xml), "--force"], capture_output=True, text=True)
    if run.returncode != 0:
        raise RuntimeError(run.stderr.strip()[-400:])
    return xml


def wall(root, receiver, normal):
    """A white matte rectangle of 1 m around the receiver, and a meter for one ray that looks at it."""
    n = normal
    side = [n[2], n[0], n[1]]
    other = [n[1] * side[2] - n[2] * side[1], n[2] * side[0] - n[0] * side[2], n[0] * side[1] - n[1] * side[0]]
    rows = ["%.17g %.17g %.17g %.17g" % (side[i] / 2, other[i] / 2, n[i], receiver[i]) for i in range(3)]
    shape = ET.SubElement(root, "shape", type="rectangle")
    ET.SubElement(ET.SubElement(shape, "transform", name="to_world"), "matrix", value=" ".join(rows) + " 0 0 0 1")
    white(shape)
    sensor = ET.SubElement(root, "sensor", type="radiancemeter")
    origin = [receiver[i] + 0.01 * n[i] for i in range(3)]
    ET.SubElement(sensor, "point", name="origin", **dict(zip("xyz", map(repr, origin))))
    ET.SubElement(sensor, "vector", name="direction", **dict(zip("xyz", (repr(-float(c)) for c in n))))
    return sensor


def white(shape):
    bsdf = ET.SubElement(shape, "bsdf", type="diffuse")
    ET.SubElement(bsdf, "rgb", name="reflectance", value="1 1 1")


def white_sphere(root, centre):
    shape = ET.SubElement(root, "shape", type="sphere")
    ET.SubElement(shape, "point", name="center", **dict(zip("xyz", map(repr, centre))))
    ET.SubElement(shape, "float", name="radius", value=repr(RADIUS))
    ET.SubElement(shape, "boolean", name="flip_normals", value="true")
    white(shape)
    return ET.SubElement(shape, "sensor", type="irradiancemeter")


def with_meter(xml, add, pixels=1):
    """The exported file with the meter that `add` makes in place of its camera and integrator; lights and their files stay."""
    tree = ET.parse(xml)
    root = tree.getroot()
    for element in root.findall("sensor") + root.findall("integrator"):
        root.remove(element)
    film = ET.SubElement(add(root), "film", type="hdrfilm")
    for name in ("width", "height"):
        ET.SubElement(film, "integer", name=name, value=str(pixels))
    for name, value in (("pixel_format", "rgb"), ("component_format", "float32")):
        ET.SubElement(film, "string", name=name, value=value)
    ET.SubElement(film, "rfilter", type="box")
    for default in root.findall("default"):  # no sampler is left to use them
        root.remove(default)
    measured = xml.with_name(xml.stem + "_measured.xml")
    tree.write(measured)
    return measured


def measure(mi, xml, samples, seeds):
    """Mean of Y after one bounce and its standard error over the seeds."""
    import numpy as np
    scene = mi.load_file(str(xml))
    depths = [mi.load_dict({"type": "path", "max_depth": depth}) for depth in (2, 1)]

    def luminance(integrator, seed):
        picture = mi.render(scene, integrator=integrator, spp=samples, seed=seed)
        return float(np.array(picture, dtype=np.float64).mean(axis=(0, 1))[:3] @ Y)

    values = [luminance(depths[0], seed) - luminance(depths[1], seed) for seed in range(seeds)]
    return float(np.mean(values)), float(np.std(values, ddof=1) / math.sqrt(seeds))


def flux_in_white_sphere(mi, xml, centre, samples):
    """Lumens of an exported light at `centre` and their standard error. Light bounced once arrives evenly everywhere in a sphere, so that the
    mean illuminance E of its wall is what the meter sees of the first bounce (depth 2 minus depth 1 with the same seeds): flux = 4 pi R^2 E."""
    value, error = measure(mi, with_meter(xml, lambda root: white_sphere(root, centre), FILM), samples // FILM**2, 16)
    return 4 * PI * RADIUS**2 * value, 4 * PI * RADIUS**2 * error
