"""A rig of six lamps whose reference is the real Mitsuba's picture, and the same rig with one thing wrong in our picture."""
import copy
import json
import math
import pathlib
import subprocess

import rigs

SIZE, SAMPLES, SEEDS, LIMIT = "128x128", 6144, 16, "0.2%"


def lamp(name, shape, lumens, position, target, kelvin):
    direction = [t - p for t, p in zip(target, position)]
    return {"name": name, "shape": shape, "emission": {"flux": "%r lm" % lumens}, "colour": {"temperature": "%d K" % kelvin},
            "translation": list(position), "rotation": rigs.towards(direction)}


def rig():
    """3030 lm, of which the indicator gives 1 %."""
    grey = {"name": "grey", "model": "lambert", "base_colour": [0.4, 0.45, 0.5]}
    lights = [lamp("key", rigs.SHAPES["rect"], 1200, (-0.9, 1.8, 0.6), (0.1, 0, 0), 3000),
              lamp("fill", rigs.SHAPES["disk"], 700, (1.6, 1.3, 0.8), (0, 0.2, 0), 5000),
              lamp("spot", rigs.SHAPES["spot"], 700, (0.5, 2.0, -0.6), (0.3, 0, 0.3), 4000),
              lamp("back", rigs.SHAPES["sphere"], 300, (-0.4, 1.4, -1.6), (0, 0, 0), 6500),
              lamp("bulb", rigs.SHAPES["point"], 100, (1.3, 0.8, -1.2), (0, 0, 0), 2700),
              lamp("indicator", rigs.SHAPES["point"], 30, (-0.8, 0.35, 0.9), (0, 0, 0), 2700)]
    return {"etendue": 1, "lights": lights, "camera": rigs.camera_for("medium", rigs.FLOOR["lambert"]),
            "materials": [rigs.FLOOR["lambert"], grey],
            "objects": [{"name": "floor", "shape": {"type": "plane", "size": 8}, "material": "floor"},
                        {"name": "box", "shape": {"type": "box", "size": [0.4, 0.5, 0.3]}, "material": "grey", "translation": [0.3, 0.25, 0]}]}


def turned(document, name, degrees):
    """The light turned about the world's x axis, by the product of quaternions."""
    document = copy.deepcopy(document)
    entry = next(light for light in document["lights"] if light["name"] == name)
    x, y, z, w = entry["rotation"]
    s, c = math.sin(math.radians(degrees) / 2), math.cos(math.radians(degrees) / 2)
    entry["rotation"] = [c * x + s * w, c * y - s * z, c * z + s * y, c * w - s * x]
    return document


def without(document, name):
    document = copy.deepcopy(document)
    document["lights"] = [light for light in document["lights"] if light["name"] != name]
    return document


def cases():
    """What is wrong in our picture, the finding it must get, and the light that must be named."""
    return [("nothing", rig(), None, None), ("rectangle turned by 2 deg", turned(rig(), "key", 2), "LIGHT_TURNED", "key"),
            ("spot turned by 2 deg", turned(rig(), "spot", 2), "LIGHT_TURNED", "spot"),
            ("light of 1 % of the flux removed", without(rig(), "indicator"), "LIGHT_MISSING", "indicator")]


def run(etendue, *words):
    return subprocess.run([etendue, *map(str, words)], capture_output=True, text=True, check=False)


def findings(etendue, folder):
    """For each case its name, whether the verdict and the first finding are as they must be, and what was found; or None and why not."""
    folder = pathlib.Path(folder)
    true = folder / "true.rig.json"
    true.write_text(json.dumps(rig()))
    done = run(etendue, "validate", true, "--out", folder / "true", "--size", SIZE, "--spp", SAMPLES, "--seeds", SEEDS, "--max-diff", LIMIT,
               "--no-cache", "--quiet")
    if done.returncode not in (0, 1, 4):
        return None, done.stderr.strip()[-300:]
    results = []
    for number, (what, document, code, light) in enumerate(cases()):
        file = folder / ("%d.rig.json" % number)
        file.write_text(json.dumps(document))
        ours = folder / ("%d.exr" % number)
        run(etendue, "render", file, ours, "--size", SIZE, "--mitsuba-model", "--tolerance", "0.004", "--quiet")
        compared = json.loads(run(etendue, "compare", ours, folder / "true" / "mitsuba.exr", "--max-diff", LIMIT, "--json", "--quiet").stdout)
        result = compared["result"]
        found = result["findings"]
        if code is None:
            right = result["verdict"] != "differs" and not found
        else:
            right = result["verdict"] == "differs" and bool(found) and found[0]["code"] == code and "'%s'" % light in found[0]["text"]
        results.append((what, right, "; ".join([result["verdict"]] + ["%s: %s" % (f["code"], f["text"]) for f in found])))
    return results, ""
