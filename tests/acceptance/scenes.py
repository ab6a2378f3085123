"""Rigs around glTF files: the file's own lights and cameras, and three area lights and a spot at places that follow from its size."""
import json
import pathlib
import shutil

import rigs

CORPUS = pathlib.Path(__file__).resolve().parents[3] / "shared/corpus/gltf"
MIXED = "bevyengine__bevy/assets/models/MixedLightingExample/MixedLightingExample.gltf"
SAMPLES = "sbtron__glTF-Sample-Models/2.0/%s/glTF-pbrSpecularGlossiness/%s.gltf"

# name: file, centre and half the extent of what it shows, whether it wants a floor, edits of its JSON
SCENES = {
    "mixed lighting": (MIXED, (0, 0.35, 0), 0.5, False, None),
    "mixed lighting, velvet": (MIXED, (0, 0.35, 0), 0.5, False, "second variant"),
    "cubes": ("bevyengine__bevy/assets/models/cubes/Cubes.glb", (0, 1, 0.5), 3.5, False, None),
    "lights": ("KhronosGroup__glTF/extensions/2.0/Khronos/KHR_lights_punctual/schema/examples/lights.gltf", (0, 10, 0), 12, True, None),
    "avocado": (SAMPLES % ("Avocado", "Avocado"), (0, 0.031, 0), 0.033, True, None),
    "box textured": (SAMPLES % ("BoxTextured", "BoxTextured"), (0, 0, 0), 0.7, True, None),
    "duck": (SAMPLES % ("Duck", "Duck"), (0.1, 0.85, 0), 1.0, True, None),
}


def second_variant(document):
    """Each primitive with the material of KHR_materials_variants' last variant: here one with a transformed, scaled normal map."""
    for mesh in document["meshes"]:
        for primitive in mesh["primitives"]:
            mappings = primitive.get("extensions", {}).get("KHR_materials_variants", {}).get("mappings", [])
            if mappings:
                primitive["material"] = mappings[-1]["material"]


def lights_around(centre, size):
    """Three area lights and a spot whose illuminance at the centre does not depend on the size."""
    def light(name, shape, candela, place, **keys):
        position = [c + size * p for c, p in zip(centre, place)]
        return dict({"name": name, "shape": shape, "emission": {"intensity": "%r cd" % (candela * size * size)}, "translation": position,
                     "rotation": rigs.towards([-p for p in place])}, **keys)
    metres = lambda x: "%r m" % (x * size)
    return [
        light("key", {"type": "rect", "width": metres(1.2), "height": metres(0.7)}, 4000, (1.6, 2.0, 1.3), colour={"temperature": "4000 K"}),
        light("fill", {"type": "disk", "radius": metres(0.5)}, 1500, (-2.0, 0.9, 1.2), colour={"temperature": "7000 K"}),
        light("back", {"type": "sphere", "radius": metres(0.25)}, 1200, (-0.8, 1.8, -1.6), colour={"rgb": [1, 0.8, 0.7]}),
        light("spot", {"type": "spot", "inner": "10 deg", "outer": "25 deg"}, 5000, (0.3, 3.0, 1.5), colour={"rgb": [0.8, 0.9, 1]}),
    ]


def rig_around(path, asset, centre, size, floor):
    objects = [{"gltf": asset}]
    if floor:
        objects.append({"name": "floor", "shape": {"type": "plane", "size": 12 * size}, "material": "floor",
                        "translation": [centre[0], centre[1] - size, centre[2]]})
    eye = [centre[0] + 0.9 * size, centre[1] + 1.1 * size, centre[2] + 2.9 * size]
    rig = {"etendue": 1, "lights": lights_around(centre, size), "camera": {"position": eye, "target": list(centre), "vfov": "42 deg"},
           "materials": [rigs.FLOOR["lambert"]], "objects": objects}
    path.write_text(json.dumps(rig, indent=1))
    return path


def corpus_rig(name, folder):
    """The rig file of a scene of the corpus, with a copy of its asset beside it."""
    file, centre, size, floor, edit = SCENES[name]
    source, folder = CORPUS / file, pathlib.Path(folder) / name.replace(",", "").replace(" ", "_")
    if source.suffix == ".glb":
        folder.mkdir()
        shutil.copy(source, folder)
    else:
        shutil.copytree(source.parent, folder)
    if edit:
        document = json.loads((folder / source.name).read_text())
        second_variant(document)
        (folder / source.name).write_text(json.dumps(document))
    return rig_around(folder / "scene.rig.json", source.name, centre, size, floor)
