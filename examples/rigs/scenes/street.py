"""A town house at dusk: an opal sodium lantern on its post, a second street light down the road, lit windows, a lamp at the door."""

import math

from modelling.masonry import BRICK_SIZE, around, bonded, brick_colour, brick_normal
from modelling.mesh import merged, plus
from modelling.model import Material, Model
from modelling.pixels import clouds, mix, png
from modelling.props import window_frame
from modelling.rig import TOWARDS_VIEWER, aimed, rig_file
from modelling.shapes import arc, ball, block, box, cylinder, extrude, revolve, tube

LEFT, RIGHT = -6.6, 4.3
GROUND, FIRST, TOP = 3.45, 6.35, 8.75  # string course, sill band of the second floor, wall's top
DOOR = (0.95, 2.15, 0.34, 3.02)  # with its fanlight
GROUND_WINDOWS = [(x - 0.55, x + 0.55, 0.95, 2.75) for x in (-4.9, -2.85, -0.75, 3.35)]
FIRST_WINDOWS = [(x - 0.50, x + 0.50, 4.05, 5.90) for x in (-4.9, -2.85, -0.75, 1.55, 3.35)]
SECOND_WINDOWS = [(x - 0.50, x + 0.50, 6.75, 8.00) for x in (-4.9, -2.85, -0.75, 1.55, 3.35)]
LIT = [FIRST_WINDOWS[2], GROUND_WINDOWS[1], SECOND_WINDOWS[4]]
KERB = 2.45
LAMP = (-2.2, 3.86, 2.10)
LANTERN = (0.15, 0.235, 0.50)  # half widths of its floor and its top, height
DOOR_LAMP = (0.60, 2.42, 0.24)
SECOND_LAMP, SECOND_TARGET = (-8.2, 6.0, 4.2), (-1.0, 1.6, 0.3)


def build():
    model = Model("street", materials())
    walls(model)
    for index, opening in enumerate(GROUND_WINDOWS + FIRST_WINDOWS + SECOND_WINDOWS):
        window(model, opening, index)
    door(model)
    cornices(model)
    street(model)
    railing(model)
    lantern(model)
    door_lantern(model)
    return {"street.glb": model.glb(), "street.rig.json": rig()}


def materials():
    return {
        "brick": Material((1.0, 1.0, 1.0), 0.85, texture=brick_colour(), normal=brick_normal()),
        "stone": Material((0.52, 0.47, 0.39), 0.75),
        "stone joint": Material((0.20, 0.18, 0.16), 0.9),
        "paint": Material((0.70, 0.69, 0.65), 0.40),
        "door blue": Material((0.020, 0.060, 0.110), 0.28),
        "brass": Material((0.86, 0.62, 0.30), 0.25, 1.0),
        "glass": Material((0.012, 0.014, 0.018), 0.08),
        "iron": Material((0.020, 0.022, 0.024), 0.35),
        "slab": Material((0.30, 0.29, 0.275), 0.55),
        "kerb": Material((0.36, 0.35, 0.33), 0.6),
        "asphalt": Material((1.0, 1.0, 1.0), 0.30, texture=asphalt()),
        "curtain": Material((0.45, 0.20, 0.13), 0.95),
        "roof": Material((0.05, 0.055, 0.065), 0.6),
    }


def asphalt():
    """Wet asphalt, dark with lighter grit; one tile is 1.5 m."""
    return png(96, 96, lambda u, v: mix((0.14, 0.14, 0.145), (0.36, 0.36, 0.36), clouds(u, v, 24, 24, 2, 3) ** 2))


def walls(model):
    upper = FIRST_WINDOWS + SECOND_WINDOWS
    pieces = [block(a, b, low, high, -0.28, 0, 0) for a, b, low, high in around(LEFT, RIGHT, GROUND, TOP, upper)]
    model.add("brickwork", "brick", merged(*pieces).textured_from("z", *BRICK_SIZE))
    below = GROUND_WINDOWS + [DOOR]
    for a, b, low, high in around(LEFT, RIGHT, 0.0, GROUND, below):
        model.add("ashlar bed", "stone joint", block(a, b, low, high, -0.28, 0.035, 0))
    for a, b, low, high in bonded(LEFT, RIGHT, 0.50, GROUND, 0.86, 0.42, 0.022, [(o[0] - 0.14, o[1] + 0.14, o[2], o[3] + 0.14) for o in below]):
        model.add("ashlar", "stone", block(a, b, low, high, 0.0, 0.075, 0.018, back=False))
    for a, b in ((LEFT, DOOR[0] - 0.14), (DOOR[1] + 0.14, RIGHT)):
        model.add("ashlar", "stone", block(a, b, 0.0, 0.48, 0.0, 0.12, 0.020))
    model.add(
        "far houses",
        "roof",
        block(6.5, 24, 0, 4.2, -16, -12, 0),
        block(8.2, 9.0, 4.2, 5.3, -15, -14, 0),
        extrude([(5.8, 4.2), (24.5, 4.2), (24.5, 5.6), (8.0, 5.9)], 4.0).at(0, 0, -14),
    )


def window(model, opening, index):
    x0, x1, y0, y1 = opening
    middle, wide = (x0 + x1) / 2, x1 - x0
    ground = y1 < GROUND
    face = 0.075 if ground else 0.0
    rows = 4 if not y0 > FIRST else 3
    model.add(
        "frames",
        "paint",
        window_frame(wide, y1 - y0, 3 if ground else 2, rows, 0.05, 0.024, 0.05).at(middle, y0, -0.14),
        block(x0, x1, (y0 + y1) / 2 - 0.025, (y0 + y1) / 2 + 0.025, -0.16, -0.105, 0.004),
    )
    if opening in LIT:
        for s in (-1, 1):
            drape(model, middle + s * (wide / 2 - 0.14), 0.28, y0, y1)
    else:
        model.add("panes", "glass", block(x0, x1, y0, y1, -0.155, -0.150, 0))
        if index % 3 == 1:
            model.add("blinds", "paint", block(x0, x1, y1 - 0.30 * (y1 - y0), y1, -0.150, -0.146, 0))
    model.add("sills", "stone", block(x0 - 0.14, x1 + 0.14, y0 - 0.10, y0 + 0.005, -0.12, face + 0.085, 0.012))
    for a, b in ((x0 - 0.13, x0 + 0.006), (x1 - 0.006, x1 + 0.13)):
        model.add("surrounds", "stone", block(a, b, y0, y1, -0.02, face + 0.035, 0.008))
    model.add("surrounds", "stone", block(x0 - 0.13, x1 + 0.13, y1 - 0.006, y1 + 0.17, -0.02, face + 0.040, 0.008))
    if not y0 > FIRST:
        keystone = extrude([(-0.075, 0), (0.075, 0), (0.105, 0.24), (-0.105, 0.24)], 0.10, 0.01)
        model.add("surrounds", "stone", keystone.at(middle, y1 - 0.012, face + 0.03))
    if FIRST > y0 > GROUND:  # the principal floor has hoods on brackets
        model.add(
            "hoods",
            "stone",
            block(x0 - 0.22, x1 + 0.22, y1 + 0.24, y1 + 0.29, 0, 0.17, 0.010),
            block(x0 - 0.26, x1 + 0.26, y1 + 0.29, y1 + 0.34, 0, 0.22, 0.014),
        )
        for s in (-1, 1):
            bracket = extrude([(0, 0), (0.06, 0.02), (0.14, 0.13), (0.15, 0.22), (0, 0.22)], 0.10, 0.008).turned("y", -90)
            model.add("hoods", "stone", bracket.at(middle + s * (wide / 2 + 0.10), y1 + 0.02, 0.0))


def drape(model, x, wide, y0, y1):
    """A curtain in folds behind the frame, a silhouette against the lit room."""
    outline = [(x - wide / 2 + wide * k / 24, 0.022 * math.sin(2 * math.pi * k / 6)) for k in range(25)]
    back = [(px, pz - 0.004) for px, pz in reversed(outline)]
    model.add("curtains", "curtain", extrude(([*back, *outline])[::-1], y1 - y0, 0, 80).turned("x", 90).at(0, (y0 + y1) / 2, -0.22))


def door(model):
    x0, x1, y0, y1 = DOOR
    leaf, z = 2.30 + y0, -0.17
    model.add("door", "door blue", block(x0 + 0.05, x1 - 0.05, y0, leaf - 0.03, z - 0.04, z, 0.003))
    middle = (x0 + x1) / 2
    for s in (-1, 1):
        for low, high in ((0.16, 0.78), (0.98, 1.62), (1.74, 2.12)):
            a, b = sorted((middle + s * 0.07, middle + s * 0.46))
            model.add(
                "door",
                "door blue",
                block(a, b, y0 + low, y0 + high, z - 0.01, z + 0.010, 0.003),
                block(a + 0.035, b - 0.035, y0 + low + 0.035, y0 + high - 0.035, z, z + 0.026, 0.016),
            )
    model.add(
        "door fittings",
        "brass",
        ball(0.036, 20, 10).at(middle + 0.02, y0 + 1.08, z + 0.06),
        cylinder(0.014, 0.06, 14).turned("x", 90).at(middle + 0.02, y0 + 1.08, z),
        block(middle - 0.13, middle + 0.13, y0 + 0.855, y0 + 0.905, z, z + 0.016, 0.004),
        block(x0 + 0.07, x1 - 0.07, y0 + 0.012, y0 + 0.11, z, z + 0.006, 0.002),
    )
    ring = [(middle + 0.05 * c, y0 + 1.66 + 0.05 * s, z + 0.03) for c, s in arc((0, 0), 1, 0, 345, 23)]
    model.add("door fittings", "brass", tube(ring, 0.008, 8, closed=True), ball(0.02, 14, 8).at(middle, y0 + 1.715, z + 0.02))
    model.add(
        "frames",
        "paint",
        block(x0, x0 + 0.055, y0, y1, -0.20, -0.10, 0.006),
        block(x1 - 0.055, x1, y0, y1, -0.20, -0.10, 0.006),
        block(x0, x1, y1 - 0.05, y1, -0.20, -0.10, 0.006),
        block(x0, x1, leaf - 0.04, leaf + 0.04, -0.20, -0.07, 0.008),
    )
    for k in range(1, 6):  # the fanlight's bars
        a = math.radians(30 * k)
        model.add(
            "frames",
            "paint",
            tube(
                [
                    (middle + 0.12 * math.cos(a), leaf + 0.05 + 0.08 * math.sin(a), -0.15),
                    (middle + 0.53 * math.cos(a), leaf + 0.05 + 0.27 * math.sin(a), -0.15),
                ],
                0.010,
                6,
            ),
        )
    model.add("panes", "glass", block(x0, x1, leaf, y1, -0.165, -0.16, 0))
    for x in (x0 - 0.176, x1 + 0.176):  # pilasters with base and capital, an entablature on them
        model.add(
            "door case",
            "stone",
            block(x - 0.13, x + 0.13, y0, y1 + 0.06, 0, 0.16, 0.010),
            block(x - 0.17, x + 0.17, y0, y0 + 0.22, 0, 0.20, 0.012),
            block(x - 0.16, x + 0.16, y1 - 0.02, y1 + 0.06, 0, 0.20, 0.012),
            block(x - 0.05, x + 0.05, y0 + 0.34, y1 - 0.14, 0.15, 0.175, 0.010),
        )
    for low, high, out, reach in ((0.06, 0.22, 0.14, 0.18), (0.22, 0.27, 0.19, 0.26), (0.27, 0.34, 0.23, 0.34)):
        model.add("door case", "stone", block(x0 - 0.15 - out, x1 + 0.15 + out, y1 + low, y1 + high, 0, reach, 0.012))
    for k in range(2):
        model.add("steps", "kerb", block(x0 - 0.34, x1 + 0.34, 0.173 * k, 0.173 * (k + 1), -0.1, 0.90 - 0.34 * k, 0.014))


def cornices(model):
    for low, high, reach in (
        (GROUND - 0.02, GROUND + 0.10, 0.11),
        (GROUND + 0.10, GROUND + 0.19, 0.17),
        (FIRST - 0.02, FIRST + 0.08, 0.06),
        (TOP - 0.16, TOP, 0.06),
        (TOP + 0.12, TOP + 0.20, 0.40),
        (TOP + 0.20, TOP + 0.32, 0.50),
        (TOP, TOP + 0.12, 0.14),
    ):
        model.add("cornices", "stone", block(LEFT - 0.02, RIGHT + 0.6 * reach, low, high, -0.3, reach, 0.018))
    count = 36
    for k in range(count):  # modillions under the crown
        x = LEFT + (RIGHT - LEFT) * (k + 0.5) / count
        model.add("cornices", "stone", block(x - 0.06, x + 0.06, TOP + 0.0, TOP + 0.12, 0.12, 0.34, 0.012, back=False))
    model.add("roof", "roof", extrude([(0.30, 0), (-4, 2.4), (-4, 0)], RIGHT - LEFT).turned("y", -90).at((LEFT + RIGHT) / 2, TOP + 0.32, 0))
    pipe = [(RIGHT - 0.22, TOP, 0.30), (RIGHT - 0.22, TOP - 0.22, 0.10), (RIGHT - 0.22, 0.16, 0.16)]
    model.add(
        "downpipe",
        "iron",
        tube(pipe, 0.05, 12),
        *(cylinder(0.062, 0.05, 16).at(RIGHT - 0.22, y, 0.115 + 0.05 * (TOP - y) / TOP) for y in (1.2, 3.0, 4.8, 6.6)),
    )


def street(model):
    model.add("joints", "stone joint", block(LEFT - 6, RIGHT + 9, -0.02, -0.008, 0, KERB, 0))
    for row, z in enumerate((0.02, 0.62, 1.22, 1.82)):
        for a, b, _, _ in bonded(LEFT - 2, RIGHT + 3.6, 0, 0.6, 0.90, 0.6, 0.010, start=LEFT - 2 - 0.45 * (row % 2)):
            model.add("paving", "slab", block(a, b, -0.05, 0.0, z + 0.005, min(z + 0.595, KERB), 0.006))
    for a, b, _, _ in bonded(LEFT - 2, RIGHT + 3.6, 0, 0.6, 1.0, 0.6, 0.010):
        model.add("kerb", "kerb", block(a, b, -0.14, 0.006, KERB + 0.003, KERB + 0.16, 0.018))
    model.add("road", "asphalt", block(LEFT - 8, RIGHT + 12, -0.16, -0.12, KERB + 0.1, 12, 0).textured_from("y", 1.5, 1.5))
    model.add("joints", "slab", block(RIGHT, 30, -0.05, -0.008, -20, 0, 0))
    post = [
        (0, 0),
        (0.11, 0),
        (0.11, 0.05),
        (0.085, 0.07),
        (0.075, 0.10),
        (0.062, 0.62),
        (0.072, 0.64),
        (0.072, 0.67),
        (0.060, 0.69),
        (0.058, 0.80),
        (0.078, 0.82),
        (0.078, 0.86),
    ]
    post += [(0.078 * c, 0.86 + 0.075 * s) for c, s in arc((0, 0), 1, 15, 90, 6)]
    model.add("bollard", "iron", revolve(post, 20))
    for x in (-5.0, -3.5, -0.7, 0.9, 2.5):
        model.place("bollard", x, 0, KERB - 0.24)


def railing(model):
    """Area railings on a stone plinth in front of the ground floor, left and right of the door."""
    z = 1.02
    for a, b in ((-5.6, 0.35), (2.75, 4.2)):
        model.add("railing plinth", "stone", block(a - 0.08, b + 0.08, 0, 0.16, z - 0.09, z + 0.09, 0.012))
        model.add("railing", "iron", block(a, b, 0.26, 0.30, z - 0.008, z + 0.008, 0.002), block(a, b, 1.02, 1.06, z - 0.008, z + 0.008, 0.002))
        count = round((b - a) / 0.125)
        for k in range(count + 1):
            x = a + (b - a) * k / count
            spear = [(0.010, 0.15), (0.010, 1.07), (0.020, 1.09), (0.011, 1.11), (0.023, 1.16), (0.0, 1.25)]
            model.add("railing", "iron", revolve(spear, 6).at(x, 0, z))
        for x in (a, b):
            newel = [(0.028, 0.15), (0.028, 1.12), (0.040, 1.14), (0.040, 1.17), (0.020, 1.19)] + [
                (0.042 * c, 1.24 + 0.045 * s) for c, s in arc((0, 0), 1, -60, 90, 6)
            ]
            model.add("railing", "iron", revolve(newel, 12).at(x, 0, z))


def lantern(model):
    """A cast-iron post with a ladder bar and a four-sided lantern: its frame stands between the lamp and the facade."""
    x, y, z = LAMP
    low = y - 0.5 * LANTERN[2]  # the lantern's floor
    post = [
        (0, 0),
        (0.20, 0),
        (0.20, 0.08),
        (0.165, 0.12),
        (0.150, 0.40),
        (0.165, 0.44),
        (0.150, 0.50),
        (0.095, 0.62),
        (0.085, 0.74),
        (0.098, 0.77),
        (0.080, 0.81),
        (0.062, 1.00),
        (0.048, 2.85),
        (0.066, 2.88),
        (0.066, 2.93),
        (0.046, 2.97),
        (0.040, low - 0.20),
        (0.060, low - 0.17),
        (0.060, low - 0.13),
        (0.030, low - 0.10),
        (0.026, low),
    ]
    model.add(
        "lamp post",
        "iron",
        revolve(post, 28).at(x, 0, z),
        tube([(x - 0.34, 2.90, z), (x + 0.34, 2.90, z)], 0.016, 10),
        ball(0.028, 14, 8).at(x - 0.35, 2.90, z),
        ball(0.028, 14, 8).at(x + 0.35, 2.90, z),
    )
    bottom, top, tall = LANTERN

    def corner(i, height, grow=1.0):
        r = (bottom + (top - bottom) * height / tall) * grow
        return (x + r * (1, 1, -1, -1)[i], low + height, z + r * (1, -1, -1, 1)[i])

    for i in range(4):
        j = (i + 1) % 4
        model.add(
            "lantern",
            "iron",
            tube([corner(i, 0), corner(i, tall)], 0.011, 6),
            tube([corner(i, 0), corner(j, 0)], 0.012, 6),
            tube([corner(i, tall), corner(j, tall)], 0.016, 6),
            tube([corner(i, 0), (x, low - 0.06, z)], 0.011, 6),
        )
    model.add("lantern", "iron", box(0.50, 0.02, 0.50, 0.006).at(x, low + tall, z))
    roof = [
        (0.30, 0),
        (0.30, 0.02),
        (0.20, 0.10),
        (0.10, 0.20),
        (0.085, 0.22),
        (0.085, 0.28),
        (0.10, 0.29),
        (0.04, 0.34),
        (0.018, 0.36),
        (0.022, 0.39),
        (0, 0.44),
    ]
    model.add("lantern", "iron", revolve(roof, sides=4).turned("y", 45).at(x, low + tall + 0.015, z))


def door_lantern(model):
    x, y, z = DOOR_LAMP
    model.add(
        "door lamp",
        "brass",
        tube([(x, y + 0.16, 0.05), (x, y + 0.19, z * 0.6), (x, y + 0.16, z), (x, y + 0.07, z)], 0.010, 10),
        cylinder(0.05, 0.02, 24).turned("x", 90).at(x, y + 0.16, 0.075),
        revolve([(0.085, 0.045), (0.088, 0.052), (0.030, 0.085), (0, 0.09)], 28).at(x, y, z),
    )


def panes():
    """The lantern's four opal panes: trapezia just inside its bars, each emitting outwards."""
    bottom, top, tall = LANTERN
    lean = math.atan2(top - bottom, tall)
    half, edge = 0.5 * tall / math.cos(lean), 0.018
    points = [[-bottom + edge, -half + edge], [bottom - edge, -half + edge], [top - edge, half - edge], [-top + edge, half - edge]]
    for name, across, along in (("front", 0, 1), ("right", 1, 0), ("back", 0, -1), ("left", -1, 0)):
        normal = (across * math.cos(lean), -math.sin(lean), along * math.cos(lean))
        middle = (LAMP[0] + across * (bottom + top) / 2, LAMP[1], LAMP[2] + along * (bottom + top) / 2)
        yield {
            "name": f"street lantern, {name} pane",
            "shape": {"type": "polygon", "points": [[round(x, 4) for x in p] for p in points]},
            "emission": {"flux": "900 lm"},
            "colour": {"temperature": "2000 K"},
            "translation": [round(x, 4) for x in middle],
            "rotation": aimed(middle, plus(middle, normal)),
        }


def rig():
    room = {"temperature": "2700 K"}
    lights = [
        *panes(),
        {
            "name": "street light down the road",
            "shape": {"type": "spot", "inner": "30 deg", "outer": "65 deg"},
            "emission": {"flux": "4000 lm"},
            "colour": {"temperature": "3000 K"},
            "translation": list(SECOND_LAMP),
            "rotation": aimed(SECOND_LAMP, SECOND_TARGET),
        },
        {
            "name": "lamp at the door",
            "shape": {"type": "sphere", "radius": "60 mm"},
            "emission": {"flux": "470 lm"},
            "colour": room,
            "translation": list(DOOR_LAMP),
        },
    ]
    for (x0, x1, y0, y1), luminance, name in zip(LIT, (16, 20, 10), ("first floor", "ground floor", "second floor")):
        lights.append(
            {
                "name": f"lit window, {name}",
                "shape": {"type": "rect", "width": f"{round(x1 - x0, 3)} m", "height": f"{round(y1 - y0, 3)} m"},
                "emission": {"luminance": f"{luminance} nit"},
                "colour": room,
                "translation": [round((x0 + x1) / 2, 4), round((y0 + y1) / 2, 4), -0.27],
                "rotation": TOWARDS_VIEWER,
            }
        )
    lights.append({"name": "sky", "shape": {"type": "environment"}, "emission": {"luminance": "3.0 nit"}, "colour": {"daylight": "20000 K"}})
    camera = {"position": [-3.7, 1.6, 9.6], "target": [-0.15, 3.7, 0.0], "vfov": "49 deg", "exposure": {"ev100": 3.2}}
    return rig_file(lights, camera, [{"gltf": "street.glb"}])
