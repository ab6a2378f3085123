"""A lever espresso machine in a photographer's set: soft box, strip light, rim, and a reflector for fill."""

import math

from modelling.mesh import aimed_mesh, merged
from modelling.model import Material, Model
from modelling.pixels import clouds, mix, noise, png
from modelling.props import coffee, cup, saucer
from modelling.rig import aimed, rig_file
from modelling.shapes import arc, block, cylinder, extrude, revolve, rounded, surface, tube
from scenes.espresso import GROUP, machine

FLOOR = -0.76  # y = 0 is the top of the table
KEY, KEY_SIZE = (-0.38, 0.83, -0.12), (0.60, 0.90)
STRIP, STRIP_SIZE = (0.62, 0.36, -0.10), (0.25, 1.10)
RIM = (0.42, 1.35, -0.62)
REFLECTOR, REFLECTOR_SIZE = (-0.85, 0.30, 0.85), (0.80, 1.00)
SUBJECT = (0.0, 0.27, 0.0)
TURN = -28.0  # the machine's, about y


def build():
    metals = {name: Model(name, {name: Material((0.8, 0.8, 0.8), 0.35, 1.0)}) for name in ("copper", "brass", "chrome")}
    set_model = Model("studio", materials())

    def put(metal, *meshes):
        metals[metal].add("machine", metal, *(m.turned("y", TURN) for m in meshes))

    def dress(material, *meshes):
        set_model.add("machine", material, *(m.turned("y", TURN) for m in meshes))

    machine(put, dress)
    sweep(set_model)
    lights_and_stands(set_model)
    files = {f"studio_{name}.glb": metal.glb() for name, metal in metals.items()}
    return {**files, "studio.glb": set_model.glb(), "studio.rig.json": rig()}


def materials():
    return {
        "paper": Material((0.46, 0.47, 0.49), 0.95),
        "walnut": Material((1.0, 1.0, 1.0), 0.30, texture=walnut()),
        "black fabric": Material((0.018, 0.018, 0.020), 0.85),
        "white fabric": Material((0.80, 0.80, 0.80), 0.9),
        "black metal": Material((0.03, 0.03, 0.032), 0.40),
        "stand steel": Material((0.45, 0.45, 0.46), 0.35, 1.0),
        "china": Material((0.82, 0.81, 0.78), 0.12),
        "coffee": Material((0.045, 0.020, 0.008), 0.12),
        "dial white": Material((0.78, 0.77, 0.72), 0.4),
        "ink": Material((0.01, 0.01, 0.01), 0.5),
        "red": Material((0.55, 0.02, 0.015), 0.4),
        "table": Material((0.22, 0.14, 0.08), 0.6),
    }


def walnut():
    def pixel(u, v):
        warp = 0.06 * noise(u, v, 2, 3, 31)
        rings = 0.5 + 0.5 * math.sin(2 * math.pi * (4 * (u + warp) + 0.6 * clouds(u, v, 2, 4, 3, 8)))
        return mix((0.24, 0.13, 0.075), (0.50, 0.31, 0.19), 0.6 * rings + 0.4 * clouds(u, v, 24, 3, 2, 19))

    return png(64, 128, pixel)


def sweep(model):
    """Background paper, 1.35 m wide: over the table, up a curve, to its roll; and the table below."""
    radius, back, top = 0.38, -0.95, 1.75
    path = [(0.47, -0.34), (0.468, -0.05), (0.461, -0.022), (0.448, -0.006), (0.43, 0.0)]
    path += [(0.43 + (back + radius - 0.43) * k / 4, 0.0) for k in range(1, 4)]
    path += [(back + radius + radius * c, radius + radius * s) for c, s in arc((0, 0), 1.0, 270, 180, 14)]
    path += [(back, top)]

    def point(u, v):
        place = v * (len(path) - 1)
        k = min(len(path) - 2, int(place))
        t = place - k
        z, y = (a + (b - a) * t for a, b in zip(path[k], path[k + 1]))
        return (-0.675 + 1.35 * u, y, z)

    model.add("sweep", "paper", surface(point, 1, len(path) - 1), tube([(-0.72, top, back - 0.03), (0.72, top, back - 0.03)], 0.035, 24))
    model.add("table", "table", block(-0.70, 0.70, -0.040, -0.004, -0.55, 0.425, 0.003))
    for x in (-0.64, 0.64):
        for z in (-0.48, 0.38):
            model.add("table", "table", block(x - 0.03, x + 0.03, FLOOR, -0.04, z - 0.03, z + 0.03, 0.003))
    model.add("floor", "table", block(-3, 3, FLOOR - 0.02, FLOOR, -2.5, 3, 0))
    for x in (-0.78, 0.78):
        stand(model, x, back - 0.03, top + 0.05)
    model.add("saucer", "china", saucer(0.062))
    model.add("cup", "china", cup(0.034, 0.056))
    model.add("cup", "coffee", coffee(0.034, 0.056))
    model.place("saucer", 0.215, 0.0, 0.175)
    model.place("cup", 0.215, 0.0055, 0.175, -30)
    spout = math.radians(TURN)
    model.place("cup", GROUP * math.sin(spout), 0.074, GROUP * math.cos(spout), -150)


def stand(model, x, z, top):
    """A light stand: tripod legs, two sections and their clamp collars."""
    model.add("stands", "stand steel", tube([(x, FLOOR + 0.25, z), (x, 0.45, z)], 0.015, 12), tube([(x, 0.40, z), (x, top, z)], 0.011, 12))
    model.add("stands", "black metal", cylinder(0.024, 0.07, 16).at(x, 0.40, z), cylinder(0.024, 0.06, 16).at(x, FLOOR + 0.55, z))
    for k in range(3):
        a = 2 * math.pi * k / 3 + 0.4
        model.add("stands", "black metal", tube([(x, FLOOR + 0.56, z), (x + 0.42 * math.sin(a), FLOOR + 0.012, z + 0.42 * math.cos(a))], 0.009, 8))


def soft_box(width, height, depth):
    """A fabric pyramid behind the diffuser, its lip in front of it, and the lamp head: (fabric, head). Faces -Z."""
    w, h, lip, thick = width / 2, height / 2, 0.045, 0.006
    ring = 0.075
    fabric = [
        block(-w - thick, w + thick, h, h + thick, -lip, 0.004, 0.002),
        block(-w - thick, w + thick, -h - thick, -h, -lip, 0.004, 0.002),
        block(-w - thick, -w, -h, h, -lip, 0.004, 0.002),
        block(w, w + thick, -h, h, -lip, 0.004, 0.002),
    ]
    corners = [(-w, -h), (w, -h), (w, h), (-w, h)]
    for (ax, ay), (bx, by) in zip(corners, corners[1:] + corners[:1]):

        def side(u, v, ax=ax, ay=ay, bx=bx, by=by):
            wide = ring / max(w, h) + (1 - ring / max(w, h)) * math.cos(math.pi / 2 * v)  # the rods bow outwards
            return (wide * (ax + (bx - ax) * u), wide * (ay + (by - ay) * u), 0.002 + depth * v)

        fabric.append(surface(side, 2, 8))
    head = merged(
        cylinder(0.085, 0.025, 32, 0.003).turned("x", 90).at(0, 0, depth - 0.005),
        extrude(rounded(0.13, 0.15, 0.02), 0.26, 0.008).at(0, 0, depth + 0.15),
    )
    return merged(*fabric), head


def lights_and_stands(model):
    for position, (width, height), depth in ((KEY, KEY_SIZE, 0.42), (STRIP, STRIP_SIZE, 0.36)):
        fabric, head = soft_box(width, height, depth)
        model.add("soft boxes", "black fabric", aimed_mesh(fabric, position, SUBJECT))
        model.add("soft boxes", "black metal", aimed_mesh(head, position, SUBJECT))
    stand(model, -0.98, -0.20, 1.45)
    stand(model, 1.02, -0.25, 0.50)
    model.add(
        "stands",
        "stand steel",
        tube([(-1.05, 1.47, -0.20), (-0.56, 1.18, -0.16)], 0.012, 12),
        tube([(1.02, 0.48, -0.25), (0.95, 0.44, -0.2)], 0.012, 12),
    )
    dish = revolve([(0.087, 0.0), (0.088, 0.002), (0.060, 0.10), (0.050, 0.12), (0.050, 0.30), (0, 0.30)], 32).turned("x", 90)
    model.add("rim head", "black metal", aimed_mesh(dish, RIM, SUBJECT))
    w, h = (size / 2 for size in REFLECTOR_SIZE)
    frame = [block(-w - 0.02, w + 0.02, s * h - 0.01, s * h + 0.01, 0.001, 0.02, 0.003) for s in (-1, 1)]
    frame += [block(s * w - 0.01, s * w + 0.01, -h, h, 0.001, 0.02, 0.003) for s in (-1, 1)]
    model.add("reflector", "black metal", aimed_mesh(merged(*frame), REFLECTOR, SUBJECT))


def rig():
    daylight = {"temperature": "5600 K"}

    def rect(name, position, size, emission):
        return {
            "name": name,
            "shape": {"type": "rect", "width": f"{size[0]} m", "height": f"{size[1]} m"},
            "emission": emission,
            "colour": daylight,
            "translation": list(position),
            "rotation": aimed(position, SUBJECT),
        }

    lights = [
        rect("key soft box", KEY, KEY_SIZE, {"flux": "2700 lm"}),
        rect("strip light", STRIP, STRIP_SIZE, {"flux": "2700 lm"}),
        {
            "name": "rim",
            "shape": {"type": "disk", "radius": "85 mm"},
            "emission": {"flux": "4500 lm"},
            "colour": daylight,
            "translation": list(RIM),
            "rotation": aimed(RIM, SUBJECT),
        },
        rect("reflector", REFLECTOR, REFLECTOR_SIZE, {"luminance": "300 nit"}),
        {"name": "spill", "shape": {"type": "environment"}, "emission": {"luminance": "30 nit"}, "colour": {"temperature": "4500 K"}},
    ]
    materials = [
        {"name": "copper", "model": "conductor", "eta": [0.2004, 0.9240, 1.1022], "k": [3.9129, 2.4528, 2.1422], "alpha": 0.11},
        {"name": "brass", "model": "conductor", "f0": [0.887, 0.789, 0.434], "alpha": 0.16},
        {"name": "chrome", "model": "conductor", "eta": [3.18, 3.18, 2.33], "k": [3.31, 3.33, 3.14], "alpha": 0.10},
    ]
    objects = [{"gltf": "studio.glb"}] + [{"gltf": f"studio_{name}.glb", "material": name} for name in ("copper", "brass", "chrome")]
    camera = {"position": [0.08, 0.42, 2.35], "target": [0.0, 0.300, 0.0], "vfov": "24 deg", "exposure": {"ev100": 8.3}}
    return rig_file(lights, camera, objects, materials)
