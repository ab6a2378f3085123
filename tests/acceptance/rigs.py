"""Rig files for the acceptance scripts: every kind of light at near, medium and grazing positions over a floor."""
import json
import math
import pathlib
import struct

FLOOR = {"lambert": {"name": "floor", "model": "lambert", "base_colour": [0.6, 0.5, 0.4]}}


def standard(smoothness, metal, base_colour=(0.8, 0.5, 0.2)):
    return {"name": "floor", "model": "standard", "base_colour": list(base_colour), "metal": metal, "smoothness": smoothness}


def conductor(alpha):
    return {"name": "floor", "model": "conductor", "f0": [0.9, 0.7, 0.4], "alpha": alpha}


def principled(alpha, metallic):
    return {"name": "floor", "model": "principled", "base_colour": [0.8, 0.5, 0.2], "metallic": metallic, "roughness": math.sqrt(alpha)}


def towards(direction):
    """Quaternion (x, y, z, w) that turns -Z into `direction`: the half-way construction from two unit vectors."""
    length = math.sqrt(sum(c * c for c in direction))
    x, y, z = (c / length for c in direction)
    # cross((0, 0, -1), d) = (y, -x, 0); w = 1 + dot = 1 - z
    if z > 1 - 1e-12:
        return [0.0, 1.0, 0.0, 0.0]
    q = [y, -x, 0.0, 1.0 - z]
    norm = math.sqrt(sum(c * c for c in q))
    return [c / norm for c in q]


def write_pfm(path, rows):
    """Rows of pixels (three numbers each), the upper one first."""
    with open(path, "wb") as out:
        out.write(b"PF\n%d %d\n-1.0\n" % (len(rows[0]), len(rows)))
        for row in reversed(rows):  # PFM starts with the bottom row
            out.write(struct.pack("<%df" % (3 * len(row)), *(c for pixel in row for c in pixel)))


def blob_environment(path, direction, width=64, height=32):
    """A sky with one soft bright spot, as a PFM file; centre column +Z, +X at a quarter of the width, +Y at the top."""
    length = math.sqrt(sum(c * c for c in direction))
    towards_blob = [c / length for c in direction]
    rows = []
    for row in range(height):
        theta = math.pi * (row + 0.5) / height
        line = []
        for column in range(width):
            longitude = math.pi - 2 * math.pi * (column + 0.5) / width
            d = (math.sin(theta) * math.sin(longitude), math.cos(theta), math.sin(theta) * math.cos(longitude))
            blob = 40 * math.exp(30 * (sum(a * b for a, b in zip(d, towards_blob)) - 1))
            line.append((0.5 + blob, 0.7 + 0.8 * blob, 1.0 + 0.6 * blob))
        rows.append(line)
    write_pfm(path, rows)


CUBE = {
    "positions": [[x, y, z] for x in (-0.15, 0.15) for y in (-0.15, 0.15) for z in (-0.15, 0.15)],
    "indices": [0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3],
}
STAR = [[0.4 * (1 if i % 2 == 0 else 0.45) * math.cos(math.pi * i / 5), 0.4 * (1 if i % 2 == 0 else 0.45) * math.sin(math.pi * i / 5)]
        for i in range(10)]

SHAPES = {
    "point": {"type": "point"},
    "spot": {"type": "spot", "inner": "20 deg", "outer": "45 deg"},
    "frustum": {"type": "frustum", "width_angle": "60 deg", "height_angle": "40 deg"},
    "rect": {"type": "rect", "width": "0.8 m", "height": "0.5 m"},
    "rect-two-sided": {"type": "rect", "width": "0.8 m", "height": "0.5 m"},
    "disk": {"type": "disk", "radius": "0.35 m"},
    "sphere": {"type": "sphere", "radius": "0.2 m"},
    "capsule": {"type": "tube", "length": "0.8 m", "radius": "0.06 m"},
    "polygon": {"type": "polygon", "points": STAR},
    "mesh": dict({"type": "mesh"}, **CUBE),
}
PLACES = {
    # name: position, direction it emits in; "grazing" is turned and low enough to cross the floor's plane
    "near": ((0.2, 0.5, -0.1), (0.1, -1.0, 0.15)),
    "medium": ((0.8, 1.7, -0.9), (-0.4, -1.0, 0.45)),
    "grazing": ((-1.7, 0.18, -0.3), (1.0, -0.06, 0.1)),
}
SUN_DIRECTIONS = {"near": (0.1, -1.0, 0.1), "medium": (-0.7, -1.0, -0.3), "grazing": (1.0, -0.12, 0.2)}
KINDS = [*SHAPES, "directional", "sun", "environment"]
# Those that Mitsuba shows within .2 % only of the exporter's plugins, or not as what they are.
MORE_SHAPES = {
    "line": {"type": "line", "length": "0.8 m"},
    "photometric": {"type": "photometric", "file": "lamp.ies"},
    "rect-textured": SHAPES["rect"],
    "tube-flat": dict(SHAPES["capsule"], caps="flat"),
    "tube-open": dict(SHAPES["capsule"], caps="none"),
}


def emission_texture(path):
    """Brighter to the right, redder upwards."""
    write_pfm(path, [[(0.2 + 0.8 * (x + 1) / 8, 0.3 + 0.5 * (y + 1) / 6, 0.4 + 0.3 * ((x + y) % 2)) for x in range(8)] for y in range(6)])


def photometric_file(path):
    """A type C web in steps of 10 and 30 degrees: most light ahead, more to one side."""
    polar, azimuth = range(0, 181, 10), range(0, 361, 30)
    candelas = [[200 + 800 * max(0, math.cos(math.radians(p))) ** 2 * (1 + 0.5 * math.cos(math.radians(a))) for p in polar] for a in azimuth]
    rows = [" ".join("%.3f" % c for c in plane) for plane in candelas]
    head = ["IESNA:LM-63-2002", "[TEST] a lopsided lamp", "[TESTLAB] -", "[ISSUEDATE] -", "[MANUFAC] -", "TILT=NONE",
            "1 -1 1 %d %d 1 2 0 0 0" % (len(polar), len(azimuth)), "1 1 100", " ".join(map(str, polar)), " ".join(map(str, azimuth))]
    path.write_text("\n".join(head + rows) + "\n")


def light(kind, place, folder):
    if kind in ("directional", "sun"):
        diameter = {"directional": "0 deg", "sun": "0.53 deg"}[kind]
        return {"name": kind, "shape": {"type": "distant", "angular_diameter": diameter}, "emission": {"illuminance": "50 klx"},
                "colour": {"temperature": "5600 K"}, "rotation": towards(SUN_DIRECTIONS[place])}
    if kind == "environment":
        name = "environment-%s.pfm" % place
        blob_environment(pathlib.Path(folder) / name, [-c for c in SUN_DIRECTIONS[place]])
        return {"name": kind, "shape": {"type": "environment", "file": name}}
    position, direction = PLACES[place]
    if kind == "photometric":
        photometric_file(pathlib.Path(folder) / "lamp.ies")
    entry = {"name": kind, "shape": {**SHAPES, **MORE_SHAPES}[kind], "emission": {"flux": "1500 lm"}, "colour": {"temperature": "3000 K"},
             "translation": list(position), "rotation": towards(direction)}
    if kind == "rect-two-sided":
        entry["two_sided"] = True
    if kind == "rect-textured":
        emission_texture(pathlib.Path(folder) / "emission.pfm")
        entry["emission"]["texture"] = "emission.pfm"
    return entry


def camera_for(place, material):
    """Matte floors from above; metal from opposite the light, so that its reflection is in the picture."""
    metal = material["model"] == "conductor" or material.get("metal", material.get("metallic", 0)) > 0.5
    if metal and place == "grazing":
        return {"position": [2.6, 0.9, 0.4], "target": [0, 0, 0], "vfov": "42 deg"}
    return {"position": [0, 2.2, 3.2], "target": [0, 0.0, 0.1], "vfov": "42 deg"}


def single_light_rig(kind, place, material, folder):
    rig = {"etendue": 1, "lights": [light(kind, place, folder)], "camera": camera_for(place, material), "materials": [material],
           "objects": [{"name": "floor", "shape": {"type": "plane", "size": 8}, "material": "floor"}]}
    path = pathlib.Path(folder) / ("%s-%s.rig.json" % (kind, place))
    path.write_text(json.dumps(rig, indent=1))
    return path


def occluder_rig(material, folder):
    """Several lights of different kinds, with boxes and a ball that throw shadows, and lights that occlude one another."""
    lights = [dict(light(kind, "medium", folder), name=kind) for kind in ("rect", "sphere", "capsule", "point")]
    for entry, position in zip(lights, ((0.8, 1.7, -0.9), (-0.9, 1.2, -0.4), (0.0, 0.9, 1.2), (-0.4, 1.9, 0.9))):
        entry["translation"] = list(position)
        entry["rotation"] = towards([-position[0], -position[1], -position[2]])
    grey = {"name": "grey", "model": "lambert", "base_colour": [0.4, 0.45, 0.5]}
    rig = {"etendue": 1, "lights": lights, "camera": camera_for("medium", material), "materials": [material, grey],
           "objects": [{"name": "floor", "shape": {"type": "plane", "size": 8}, "material": "floor"},
                       {"name": "box", "shape": {"type": "box", "size": [0.4, 0.5, 0.3]}, "material": "grey", "translation": [0.4, 0.25, 0.1],
                        "rotation": [0, 0.2588190451, 0, 0.9659258263]},
                       {"name": "ball", "shape": {"type": "sphere", "radius": 0.25}, "material": "grey", "translation": [-0.6, 0.25, 0.3]}]}
    path = pathlib.Path(folder) / "occluders.rig.json"
    path.write_text(json.dumps(rig, indent=1))
    return path


def blinds_rig(material, folder):
    """A large light close to the floor behind five slats: penumbrae over one another nearly everywhere."""
    slats = [{"name": "slat %d" % i, "shape": {"type": "box", "size": [1.6, 0.02, 0.08]}, "material": "grey",
              "translation": [0, 0.45, -0.5 + 0.25 * i]} for i in range(5)]
    lamp = {"name": "window", "shape": {"type": "rect", "width": "1.2 m", "height": "0.8 m"}, "emission": {"flux": "1500 lm"},
            "translation": [0, 1.1, -0.3], "rotation": towards((0, -1, 0.3))}
    grey = {"name": "grey", "model": "lambert", "base_colour": [0.4, 0.45, 0.5]}
    rig = {"etendue": 1, "lights": [lamp], "camera": {"position": [0, 1.5, 2.4], "target": [0, 0.1, 0.3], "vfov": "36 deg"},
           "materials": [material, grey],
           "objects": [{"name": "floor", "shape": {"type": "plane", "size": 8}, "material": "floor"}, *slats]}
    path = pathlib.Path(folder) / "blinds.rig.json"
    path.write_text(json.dumps(rig, indent=1))
    return path
