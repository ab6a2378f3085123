"""A table laid for coffee, with a bottle, a watch and a candle: daylight from the left, a desk lamp, and what else is lit in a room."""

import math

from modelling.mesh import aimed_mesh, merged
from modelling.model import Material, Model
from modelling.pixels import clouds, hashed, mix, noise, normal_png, png, smooth
from modelling.props import bottle, coffee, cup, saucer, window_frame
from modelling.rig import aimed, rig_file
from modelling.shapes import arc, block, cylinder, extrude, revolve, rounded, spline, surface, tube

WALL = -0.46
BULB, LAMP_TARGET = (0.235, 0.372, -0.085), (0.06, 0.0, 0.06)
WINDOW = (-1.05, 0.62, 0.20)  # the middle of the opening, which faces +x
WINDOW_SIZE = (1.20, 1.10)
STRIP = (0.0, 0.70, WALL + 0.06)
CANDLE = (-0.255, 0.217, -0.20)
SPOT, SPOT_TARGET = (0.55, 1.75, 1.05), (-0.04, 0.0, 0.10)


def build():
    model = Model("table", materials())
    room(model)
    wine(model)
    teapot(model)
    cups(model)
    candlestick(model)
    watch(model)
    desk_lamp(model)
    return {"table.glb": model.glb(), "table.rig.json": rig()}


def materials():
    return {
        "table oak": Material((1.0, 1.0, 1.0), 0.36, texture=oak(), normal=oak_normal()),
        "plaster": Material((0.36, 0.42, 0.43), 0.85),
        "panel": Material((0.30, 0.36, 0.37), 0.55),
        "frame white": Material((0.75, 0.75, 0.73), 0.4),
        "bottle glass": Material((0.010, 0.028, 0.012), 0.08),
        "capsule": Material((0.30, 0.015, 0.025), 0.35, 0.6),
        "label": Material((1.0, 1.0, 1.0), 0.7, texture=label()),
        "celadon": Material((0.22, 0.42, 0.35), 0.10),
        "china": Material((0.80, 0.78, 0.74), 0.12),
        "coffee": Material((0.045, 0.020, 0.008), 0.10),
        "brass": Material((0.87, 0.65, 0.33), 0.34, 1.0),
        "steel": Material((0.62, 0.62, 0.61), 0.28, 1.0),
        "wax": Material((0.78, 0.70, 0.55), 0.45),
        "enamel": Material((0.30, 0.020, 0.016), 0.18),
        "enamel white": Material((0.80, 0.79, 0.76), 0.35),
        "leather": Material((0.100, 0.040, 0.018), 0.50),
        "dial": Material((0.015, 0.030, 0.060), 0.5),
        "lume": Material((0.75, 0.75, 0.66), 0.5),
        "linen": Material((0.62, 0.60, 0.54), 0.95, normal=weave()),
        "cane": Material((0.40, 0.24, 0.10), 0.55),
    }


BOARDS = 5


def _oak(u, v):
    """Which board, the darkness of its grain, and how far the place is from the groove beside it."""
    board = min(BOARDS - 1, int(v * BOARDS))
    across = v * BOARDS - board
    bent = v + 0.010 * (noise(u, v, 3, 4, 40 + board) - 0.5)
    grain = 0.55 * clouds(u, bent, 3, 40, 3, 50) + 0.45 * noise(u, bent, 6, 90, 60)
    return board, grain, min(across, 1 - across)


def oak():
    def pixel(u, v):
        board, grain, edge = _oak(u, v)
        tone = 0.25 + 0.35 * hashed(board, 4, 2) + 0.75 * (grain - 0.5)
        wood = mix((0.38, 0.23, 0.13), (0.72, 0.52, 0.34), min(1.0, max(0.0, tone)))
        return tuple(c * (0.35 + 0.65 * smooth(0.004, 0.022, edge)) for c in wood)

    return png(192, 160, pixel)


def oak_normal():
    def depth(u, v):
        _, grain, edge = _oak(u % 1.0, v % 1.0)
        return 0.0016 * smooth(0.0, 0.035, edge) - 0.0011 * smooth(0.45, 0.85, grain)

    return normal_png(192, 160, depth, 0.9, 0.7)


def weave():
    return normal_png(
        48,
        48,
        lambda u, v: (
            0.0006
            * max(math.sin(2 * math.pi * 6 * u) * (1 if int(v * 12) % 2 else -1), math.sin(2 * math.pi * 6 * v) * (1 if int(u * 12) % 2 else -1))
        ),
        0.05,
        0.05,
    )


LETTERS = {
    "E": "1111 1000 1000 1110 1000 1000 1111",
    "T": "11111 00100 00100 00100 00100 00100 00100",
    "N": "10001 11001 11101 10111 10011 10001 10001",
    "D": "1110 1001 1001 1001 1001 1001 1110",
    "U": "1001 1001 1001 1001 1001 1001 0110",
}


def written(word, x, y):
    """Whether the cell (x, y) of a line of letters is inked; the line is seven cells high."""
    for letter in word:
        rows = LETTERS[letter].split()
        if 0 <= x < len(rows[0]):
            return 0 <= y < 7 and rows[y][x] == "1"
        x -= len(rows[0]) + 1
    return False


def label():
    """Cream paper with a border, a sun over hills, the name, and a band."""

    def pixel(u, v):
        x, y = int(u * 96), int(v * 112)
        paper, ink, red, gold = (0.90, 0.86, 0.76), (0.16, 0.12, 0.12), (0.50, 0.09, 0.10), (0.70, 0.53, 0.25)
        if min(x, 95 - x, y, 111 - y) == 3:
            return gold
        if 90 <= y < 100 and 8 <= x < 88:
            return red
        if 62 <= y < 76 and written("ETENDUE", (x - 12) // 2, (y - 62) // 2):
            return ink
        if y in (81, 84) and 24 <= x < 72:
            return ink
        hill = 50 - 7 * math.sin(u * 9) - 4 * math.sin(u * 17 + 1)
        if 10 <= x < 86 and hill < y < 56:
            return mix(red, ink, 0.5) if (x + y) % 4 else paper
        away = math.hypot(x - 58, y - 30)
        if away < 10 or (away < 20 and y < hill and int(math.degrees(math.atan2(y - 30, x - 58)) % 30) < 6):
            return gold
        return paper

    return png(96, 112, pixel)


def room(model):
    model.add("table top", "table oak", block(-0.70, 0.70, -0.035, 0.0, -0.40, 0.45, 0.004).textured_from("y", 0.90, 0.70))
    model.add("wall", "plaster", block(-1.6, 1.6, -0.8, 1.5, WALL - 0.05, WALL, 0))
    for k in range(-2, 3):  # raised and fielded panels of the wainscot, and its rail
        x = 0.46 * k
        for low, high, thick, edge in ((-0.70, 0.40, 0.012, 0.010), (-0.65, 0.35, 0.020, 0.018)):
            inset = 0.20 if thick < 0.015 else 0.15
            model.add("wainscot", "panel", block(x - inset, x + inset, low, high, WALL - 0.005, WALL + thick, edge, back=False))
    model.add("wainscot", "panel", block(-1.6, 1.6, 0.44, 0.475, WALL, WALL + 0.022, 0.008), block(-1.6, 1.6, 0.475, 0.49, WALL, WALL + 0.036, 0.006))
    x, y, z = WINDOW
    model.add("window", "frame white", window_frame(*WINDOW_SIZE, 3, 2, 0.06, 0.03).turned("y", 90).at(x + 0.05, y - WINDOW_SIZE[1] / 2, z))

    def cloth(u, v):
        a, b = 0.40 * (u - 0.5), 0.30 * (v - 0.5)
        fold = 0.0022 * (1 + math.sin(31 * a + 13 * b)) * smooth(0.05, 0.2, abs(a) + abs(b)) + 0.002
        return (a, fold, -b)

    napkin = surface(cloth, 24, 18)
    napkin.uvs = [(u * 8, v * 6) for u, v in napkin.uvs]
    model.add("napkin", "linen", napkin.turned("y", 16).at(0.175, 0.0, 0.13))


def wine(model):
    x, z, turn = -0.135, -0.115, 8
    model.add("wine", "bottle glass", bottle(0.305, 0.037, 0.0142).at(x, 0, z))
    model.add(
        "wine",
        "capsule",
        revolve([(0.0158, 0.250), (0.0158, 0.286), (0.0178, 0.288), (0.0178, 0.304), (0.0165, 0.3065), (0, 0.3065)], 32).at(x, 0, z),
    )

    def paper(u, v):
        a = 1.9 * (u - 0.5)
        return (0.0373 * math.sin(a), 0.062 + 0.098 * v, 0.0373 * math.cos(a))

    model.add("wine", "label", surface(paper, 20, 1).turned("y", turn).at(x, 0, z))


def teapot(model):
    x, z = 0.045, -0.075
    body = spline([(0.046, 0.006), (0.066, 0.022), (0.074, 0.052), (0.064, 0.086), (0.040, 0.104)], 5)
    pot = revolve([(0, 0.003), (0.040, 0.003), (0.042, 0), (0.046, 0), *body, (0.036, 0.106), (0, 0.106)], 44)
    lid = [(0.0395, 0.104), (0.0395, 0.1075)] + spline([(0.0375, 0.109), (0.026, 0.116), (0.010, 0.120)], 4) + [(0.005, 0.124)]
    lid += [(0.0105 * c, 0.134 + 0.0105 * s) for c, s in arc((0, 0), 1, -58, 90, 6)]
    spout = spline([(-0.058, 0.034, 0), (-0.088, 0.044, 0), (-0.104, 0.078, 0), (-0.124, 0.100, 0)], 5)
    radii = [0.0165 - 0.0093 * (k / (len(spout) - 1)) ** 0.8 for k in range(len(spout))]
    ear = [(0.060 + 0.044 * c, 0.060 + 0.036 * s, 0) for c, s in arc((0, 0), 1, -105, 105, 18)]
    for mesh in (pot, revolve(lid, 40), tube(spout, radii, 16)):
        model.add("teapot", "celadon", mesh.turned("y", 18).at(x, 0, z))
    model.add("teapot", "cane", tube(ear, 0.0052, 10).turned("y", 18).at(x, 0, z))


def cups(model):
    model.add("saucer", "china", saucer(0.072))
    model.add("cup", "china", cup(0.040, 0.062))
    model.add("cup", "coffee", coffee(0.040, 0.062))
    for x, z, base, turn in ((0.175, 0.115, 0.0035, -28), (-0.015, 0.135, 0.0, 205)):
        model.place("saucer", x, base, z)
        model.place("cup", x, base + 0.0055, z, turn)

    def bowl(u, v):
        x, z = 2 * u - 1, 1 - 2 * v
        return (0.0105 * x * math.sqrt(1.02 - z * z), 0.003 * (x * x + z * z), 0.016 * z)

    stem = spline([(0, 0.0045, 0.0155), (0, 0.008, 0.03), (0, 0.0065, 0.06), (0, 0.0080, 0.096)], 4)
    spoon = merged(surface(bowl, 8, 12), tube(stem, [0.0016] * 9 + [0.0019, 0.0023, 0.0026, 0.0022], 8))
    model.add("spoon", "steel", spoon.turned("x", -6).turned("y", 62).at(0.160, 0.0195, 0.166))
    cube = block(-0.0075, 0.0075, 0, 0.011, -0.0075, 0.0075, 0.0012)
    model.add("sugar", "china", cube.turned("y", 20).at(0.035, 0.0135, 0.178), cube.turned("y", -25).at(0.018, 0.0155, 0.188))


def candlestick(model):
    x, _, z = CANDLE
    stick = [
        (0, 0),
        (0.044, 0),
        (0.046, 0.004),
        (0.043, 0.008),
        (0.030, 0.012),
        (0.014, 0.020),
        (0.0085, 0.034),
        (0.014, 0.042),
        (0.016, 0.047),
        (0.013, 0.052),
        (0.0075, 0.060),
        (0.0068, 0.092),
        (0.012, 0.100),
        (0.0125, 0.106),
        (0.009, 0.111),
        (0.020, 0.116),
        (0.0235, 0.119),
        (0.0225, 0.1225),
        (0.013, 0.121),
        (0.0125, 0.134),
        (0.0105, 0.134),
    ]
    model.add("candlestick", "brass", revolve(stick, 40, 30).at(x, 0, z))
    wax = [(0.0102, 0.125), (0.0098, 0.190), (0.0088, 0.193), (0.006, 0.1905), (0, 0.190)]
    model.add("candlestick", "wax", revolve(wax, 24, 60).at(x, 0, z))
    model.add("candlestick", "leather", tube([(x, 0.190, z), (x + 0.0005, 0.199, z), (x + 0.001, 0.2035, z)], 0.0009, 6))


def watch(model):
    """A wrist watch on its closed strap: 40 mm case with lugs and crown, dial with hands. Modelled facing +z around the origin."""
    parts = {"steel": [], "dial": [], "lume": [], "leather": []}
    case = [
        (0, -0.006),
        (0.0175, -0.006),
        (0.0195, -0.004),
        (0.0198, 0.001),
        (0.0190, 0.0030),
        (0.0192, 0.0036),
        (0.0176, 0.0052),
        (0.0168, 0.0050),
        (0.0166, 0.0030),
    ]
    parts["steel"] += [revolve(case, 56, 25).turned("x", 90), cylinder(0.0030, 0.0045, 16, 0.0006).turned("z", -90).at(0.0195, 0, -0.001)]
    for s in (-1, 1):
        for t in (-1, 1):
            lug = extrude([(-0.0016, 0), (0.0016, 0), (0.0013, 0.0095), (-0.0013, 0.0095)], 0.0055, 0.0006)
            parts["steel"].append(lug.turned("z", 0 if t > 0 else 180).turned("x", 24 * t).at(s * 0.0117, t * 0.0150, -0.002))
    parts["dial"].append(revolve([(0.0167, 0.0030), (0, 0.0030)], 48).turned("x", 90))
    for hour in range(12):
        long = 0.0026 if hour % 3 else 0.0038
        mark = block(-0.0005, 0.0005, 0.0150 - long, 0.0150, 0.0030, 0.0035, 0.0002, back=False)
        parts["lume"].append(mark.turned("z", -30 * hour))
    for length, wide, turn, lift in ((0.0085, 0.0008, -305, 0.0036), (0.0130, 0.0006, -60, 0.0040)):
        hand = extrude([(-0.7 * wide, -0.002), (0.7 * wide, -0.002), (wide, 0.6 * length), (0, length), (-wide, 0.6 * length)], 0.0003)
        parts["lume"].append(hand.turned("z", turn).at(0, 0, lift))
    parts["steel"].append(revolve([(0.0012, 0.0030), (0.0012, 0.0046), (0, 0.0046)], 14).turned("x", 90))
    parts["steel"].append(block(-0.0002, 0.0002, -0.004, 0.014, 0.0043, 0.0045, 0).turned("z", 140))
    for side in (1, -1):  # two halves of the strap, from the lugs round the back
        path = spline(
            [(side * 0.0205, -0.0035), (side * 0.0275, -0.012), (side * 0.0300, -0.027), (side * 0.0215, -0.044), (-side * 0.002, -0.0515)], 6
        )
        if side < 0:
            path = [(y, z - 0.003 * smooth(0.6, 1.0, k / (len(path) - 1))) for k, (y, z) in enumerate(path)]
        thick = 0.0013
        outline = [(y * (1 + thick / math.hypot(y, z + 0.027)), z + (z + 0.027) * thick / math.hypot(y, z + 0.027)) for y, z in path]
        inline = [(y * (1 - thick / math.hypot(y, z + 0.027)), z - (z + 0.027) * thick / math.hypot(y, z + 0.027)) for y, z in path]
        ring = outline + inline[::-1]
        if sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(ring, ring[1:] + ring[:1])) < 0:
            ring = ring[::-1]
        # extruded along z with (x, y) = (y, z) of the watch: turn it so that its slab lies along the watch's x
        strap = extrude(ring, 0.0195, 0.0006, 40)
        parts["leather"].append(strap.mapped(lambda p: (p[2], p[0], p[1]), lambda n: (n[2], n[0], n[1])))
    for material, meshes in parts.items():
        for mesh in meshes:
            model.add("watch", material, mesh.turned("x", -38).turned("y", 24).at(-0.150, 0.0395, 0.215))


def desk_lamp(model):
    """An enamelled dome shade around the bulb, on a jointed arm that comes from the right."""
    shade = (
        [(0.094, -0.058), (0.0935, -0.056)]
        + spline([(0.090, -0.040), (0.074, 0.000), (0.046, 0.030), (0.026, 0.040)], 5)
        + [(0.024, 0.044), (0.024, 0.075), (0.018, 0.080), (0, 0.080)]
    )
    inside = (
        [(0, 0.036), (0.024, 0.036)]
        + [(r - 0.0022, y - 0.001) for r, y in spline([(0.026, 0.038), (0.046, 0.028), (0.074, -0.001), (0.090, -0.041)], 5)]
        + [(0.0915, -0.0585), (0.094, -0.058)]
    )

    def hung(mesh):  # modelled hanging down, turned to face along -Z, then aimed
        return aimed_mesh(mesh.turned("x", 90), BULB, LAMP_TARGET)

    model.add("desk lamp", "enamel", hung(revolve(shade, 48)))
    model.add("desk lamp", "enamel white", hung(revolve(inside, 48)))
    model.add(
        "desk lamp", "brass", hung(revolve([(0.0145, 0.0305), (0.0145, 0.037), (0, 0.037)], 24)), hung(cylinder(0.012, 0.018, 20).at(0, 0.079, 0))
    )
    top = tuple(b + 0.095 * (b - t) / math.dist(BULB, LAMP_TARGET) for b, t in zip(BULB, LAMP_TARGET))
    elbow, foot = (0.50, 0.585, -0.20), (0.46, 0.03, -0.26)
    model.add(
        "desk lamp",
        "brass",
        tube([top, elbow], 0.006, 12),
        tube([elbow, foot], 0.007, 12),
        cylinder(0.016, 0.03, 20).turned("x", 90).at(elbow[0], elbow[1], elbow[2] - 0.015),
    )
    model.add(
        "desk lamp", "enamel", revolve([(0, 0), (0.085, 0), (0.088, 0.006), (0.080, 0.018), (0.020, 0.030), (0, 0.032)], 40).at(foot[0], 0, foot[2])
    )
    model.add(
        "strip fitting", "frame white", extrude(rounded(0.022, 0.012, 0.002, 2), 1.04, 0.001).turned("y", 90).at(STRIP[0], STRIP[1] + 0.014, STRIP[2])
    )


def rig():
    half = math.sqrt(0.5)
    lights = [
        {
            "name": "window",
            "shape": {"type": "rect", "width": f"{WINDOW_SIZE[0]} m", "height": f"{WINDOW_SIZE[1]} m"},
            "emission": {"luminance": "1000 nit"},
            "colour": {"daylight": "7000 K"},
            "translation": list(WINDOW),
            "rotation": [0, round(-half, 7), 0, round(half, 7)],
        },
        {
            "name": "desk lamp",
            "shape": {"type": "sphere", "radius": "30 mm"},
            "emission": {"flux": "249 lm"},
            "colour": {"temperature": "2700 K"},
            "translation": list(BULB),
        },
        {
            "name": "LED strip",
            "shape": {"type": "tube", "length": "1.0 m", "radius": "6 mm", "caps": "flat"},
            "emission": {"flux": "420 lm"},
            "colour": {"temperature": "3000 K"},
            "translation": list(STRIP),
        },
        {
            "name": "candle",
            "shape": {"type": "tube", "length": "14 mm", "radius": "4 mm", "caps": "round"},
            "emission": {"flux": "12.57 lm"},
            "colour": {"temperature": "2000 K"},
            "translation": list(CANDLE),
            "rotation": [0, 0, round(half, 7), round(half, 7)],
        },
        {
            "name": "accent spot",
            "shape": {"type": "spot", "inner": "8 deg", "outer": "37 deg"},
            "emission": {"flux": "344 lm"},
            "colour": {"temperature": "3000 K"},
            "translation": list(SPOT),
            "rotation": aimed(SPOT, SPOT_TARGET),
        },
        {"name": "rest of the room", "shape": {"type": "environment"}, "emission": {"luminance": "16 nit"}, "colour": {"temperature": "4000 K"}},
    ]
    camera = {"position": [0.02, 0.40, 0.98], "target": [0.01, 0.115, 0.0], "vfov": "30 deg", "exposure": {"ev100": 6.9}}
    return rig_file(lights, camera, [{"gltf": "table.glb"}])
