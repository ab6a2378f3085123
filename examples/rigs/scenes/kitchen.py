"""A kitchen in the evening: five downlights, a tube under the cabinets, an opal pendant and a window at blue hour."""

from modelling.masonry import bonded
from modelling.mesh import merged
from modelling.model import Material, Model
from modelling.pixels import clouds, hashed, mix, noise, png, smooth
from modelling.props import bottle, bowl, cup, handle, jar, jar_lid, leafy, orange, plate, stool, window_frame
from modelling.rig import DOWN, TOWARDS_VIEWER, rig_file
from modelling.shapes import arc, block, cylinder, extrude, revolve, rounded, spline, tube

LEFT, RIGHT, FRONT, CEILING = -2.1, 2.1, 4.2, 2.5  # the room; its back wall is z = 0
DEPTH = 0.60  # of the worktop; doors stand at .56
PLINTH, CARCASS, TOP = 0.10, 0.86, 0.90
DOOR = 0.56
UPPER_LOW, UPPER_HIGH, UPPER_DEPTH = 1.45, 2.17, 0.33
DOWNLIGHTS = [(-1.25, 0.95), (0.0, 0.95), (1.25, 0.95), (-1.25, 3.35), (0.95, 3.35)]
PENDANT = (-0.35, 1.72, 1.75)
WINDOW = (-0.65, 0.65, 1.08, 2.12)


def build():
    model = Model("kitchen", materials())
    room(model)
    base_units(model)
    sink_and_tap(model)
    upper_units(model)
    tiles(model)
    island(model)
    on_the_worktop(model)
    fittings(model)
    return {"kitchen.glb": model.glb(), "kitchen.rig.json": rig()}


def materials():
    return {
        "plaster": Material((0.72, 0.70, 0.66), 0.9),
        "ceiling": Material((0.80, 0.80, 0.78), 0.9),
        "floor oak": Material((1.0, 1.0, 1.0), 0.42, texture=planks()),
        "front green": Material((0.090, 0.150, 0.125), 0.45),
        "island white": Material((0.68, 0.66, 0.60), 0.40),
        "worktop stone": Material((0.62, 0.60, 0.57), 0.22),
        "worktop oak": Material((0.42, 0.24, 0.115), 0.38),
        "butcher block": Material((1.0, 1.0, 1.0), 0.33, texture=butcher_block()),
        "carcass": Material((0.05, 0.05, 0.05), 0.7),
        "tile": Material((0.74, 0.72, 0.66), 0.14),
        "grout": Material((0.42, 0.41, 0.39), 0.9),
        "brass": Material((0.86, 0.62, 0.30), 0.28, 1.0),
        "steel": Material((0.58, 0.57, 0.55), 0.42, 1.0),
        "black glass": Material((0.010, 0.010, 0.012), 0.10),
        "black metal": Material((0.025, 0.025, 0.027), 0.45),
        "frame white": Material((0.75, 0.75, 0.73), 0.35),
        "china": Material((0.80, 0.79, 0.76), 0.12),
        "blue glaze": Material((0.035, 0.110, 0.220), 0.15),
        "green bottle": Material((0.012, 0.060, 0.020), 0.10),
        "amber bottle": Material((0.20, 0.060, 0.010), 0.10),
        "orange": Material((0.80, 0.26, 0.020), 0.42),
        "leaf": Material((0.070, 0.210, 0.035), 0.5),
        "terracotta": Material((0.45, 0.16, 0.075), 0.8),
        "board": Material((0.36, 0.19, 0.085), 0.5),
        "cloth": Material((0.62, 0.13, 0.10), 0.95),
    }


def planks():
    """Four oak boards side by side with grain, a butt joint in each and dark gaps; the tile is .6 m x 1.2 m."""

    def pixel(u, v):
        board = min(3, int(u * 4))
        across = u * 4 - board
        joint = hashed(board, 1, 7)
        along = (v - joint) % 1.0
        grain = clouds(u, v, 32, 4, 3, 11 + board)
        streak = noise(u + 0.01 * noise(u, v, 4, 6, 5), v, 64, 3, 23)
        tone = 0.35 + 0.35 * hashed(board, 2, 7) + 0.22 * (grain - 0.5) + 0.22 * (streak - 0.5)
        colour = mix((0.42, 0.27, 0.15), (0.70, 0.51, 0.33), tone)
        gap = smooth(0, 0.02, across) * smooth(0, 0.02, 1 - across) * smooth(0, 0.004, along) * smooth(0, 0.004, 1 - along)
        return tuple(c * (0.35 + 0.65 * gap) for c in colour)

    return png(160, 192, pixel)


def butcher_block():
    """Oak staves 45 mm wide of uneven length, glued; the tile is .72 m x .72 m, the grain runs along u."""

    def pixel(u, v):
        row = int(v * 16)
        piece = int(u * 3 + hashed(row, 3, 5)) % 3
        grain = clouds(u, v, 3, 64, 2, 40 + piece)
        tone = 0.15 + 0.6 * hashed(row, piece, 17) + 0.5 * (grain - 0.5)
        seam = smooth(0, 0.10, v * 16 - row) * smooth(0, 0.012, (u * 3 + hashed(row, 3, 5)) % 1.0)
        return tuple(c * (0.72 + 0.28 * seam) for c in mix((0.56, 0.37, 0.21), (0.80, 0.60, 0.39), tone))

    return png(128, 128, pixel)


def room(model):
    model.add("floor", "floor oak", block(LEFT, RIGHT, -0.05, 0, 0, FRONT, 0).textured_from("y", 0.6, 1.2))
    model.add("ceiling", "ceiling", block(LEFT, RIGHT, CEILING, CEILING + 0.05, -0.3, FRONT, 0))
    x0, x1, y0, y1 = WINDOW
    walls = [
        block(LEFT - 0.1, LEFT, -0.05, CEILING, -0.3, FRONT, 0),
        block(RIGHT, RIGHT + 0.1, -0.05, CEILING, -0.3, FRONT, 0),
        block(LEFT, x0, -0.05, CEILING, -0.3, 0, 0),
        block(x1, RIGHT, -0.05, CEILING, -0.3, 0, 0),
        block(x0, x1, -0.05, y0, -0.3, 0, 0),
        block(x0, x1, y1, CEILING, -0.3, 0, 0),
    ]
    model.add("walls", "plaster", *walls)
    model.add(
        "cornice",
        "ceiling",
        block(LEFT, RIGHT, CEILING - 0.06, CEILING, 0, 0.03, 0.012),
        block(LEFT, LEFT + 0.03, CEILING - 0.06, CEILING, 0, FRONT, 0.012),
    )
    model.add(
        "window",
        "frame white",
        window_frame(x1 - x0, y1 - y0, 2, 2).at(0, y0, -0.14),
        block(x0 - 0.04, x1 + 0.04, y0 - 0.03, y0 + 0.004, -0.16, 0.10, 0.003),
    )


def front(model, x0, x1, y0, y1, pull="top", z=DOOR, name="front green", part="fronts"):
    """A shaker door or drawer front with 3 mm gaps: four rails around a sunk panel, and its handle."""
    x0, x1, y0, y1 = x0 + 0.0015, x1 - 0.0015, y0 + 0.0015, y1 - 0.0015
    rail = min(0.065, 0.3 * (y1 - y0))
    model.add(
        part,
        name,
        block(x0, x1, y0, y0 + rail, z, z + 0.020),
        block(x0, x1, y1 - rail, y1, z, z + 0.020),
        block(x0, x0 + rail, y0 + rail, y1 - rail, z, z + 0.020),
        block(x1 - rail, x1, y0 + rail, y1 - rail, z, z + 0.020),
        block(x0 + rail - 0.002, x1 - rail + 0.002, y0 + rail - 0.002, y1 - rail + 0.002, z, z + 0.009, 0.001),
    )
    middle = (x0 + x1) / 2
    if pull == "top":
        model.add("handles", "brass", handle(min(0.20, 0.6 * (x1 - x0))).at(middle, y1 - rail / 2, z + 0.020))
    elif pull in ("left", "right"):
        side = x0 + rail / 2 if pull == "left" else x1 - rail / 2
        height = y1 - 0.16 if y0 < 1 else y0 + 0.16
        model.add("handles", "brass", handle(0.20).turned("z", 90).at(side, height, z + 0.020))


def drawers(model, x0, x1, z=DOOR, name="front green"):
    for low, high in ((PLINTH, 0.39), (0.39, 0.68), (0.68, CARCASS)):
        front(model, x0, x1, low, high, "top", z, name)


def base_units(model):
    model.add("carcass", "carcass", block(LEFT, 1.5, PLINTH, CARCASS, 0, DOOR - 0.002, 0), block(LEFT, 1.5, 0, PLINTH, 0, 0.50, 0))
    drawers(model, -2.1, -1.5)
    oven(model, -1.5, -0.9)
    drawers(model, -0.9, -0.45)
    front(model, -0.45, 0.0, PLINTH, CARCASS, "right")
    front(model, 0.0, 0.45, PLINTH, CARCASS, "left")
    front(model, 0.45, 1.05, PLINTH, CARCASS, "top")
    front(model, 1.05, 1.482, PLINTH, CARCASS, "left")
    x0, x1, z0, z1 = -0.306, 0.306, 0.124, 0.506  # the sink's cut-out, in the middle of its walls
    model.add(
        "worktop",
        "worktop stone",
        block(LEFT, x0, CARCASS, TOP, 0, DEPTH + 0.01, 0.004),
        block(x1, 1.5, CARCASS, TOP, 0, DEPTH + 0.01, 0.004),
        block(x0, x1, CARCASS, TOP, 0, z0, 0.004),
        block(x0, x1, CARCASS, TOP, z1, DEPTH + 0.01, 0.004),
    )
    tall_unit(model)


def oven(model, x0, x1):
    z = DOOR
    model.add(
        "oven", "steel", block(x0 + 0.002, x1 - 0.002, 0.735, CARCASS - 0.002, z, z + 0.020), block(x0 + 0.002, x1 - 0.002, 0.26, 0.73, z, z + 0.016)
    )
    model.add("oven", "black glass", block(x0 + 0.045, x1 - 0.045, 0.30, 0.665, z + 0.014, z + 0.020))
    model.add("handles", "steel", handle(0.48, 0.009, 0.045).at((x0 + x1) / 2, 0.70, z + 0.016))
    knob = merged(cylinder(0.021, 0.022, 24, 0.003), block(-0.003, 0.003, 0.02, 0.026, -0.018, 0.018, 0.001)).turned("x", 90)
    for k in range(4):
        model.add("oven", "black metal", knob.at(x0 + 0.10 + 0.075 * k + (0.10 if k > 1 else 0), 0.797, z + 0.020))
    model.add("oven", "black glass", block(x0 + 0.245, x0 + 0.335, 0.775, 0.82, z + 0.018, z + 0.0215, 0.001))
    front(model, x0, x1, PLINTH, 0.255, "top")
    model.add("hob", "black glass", block(x0 + 0.01, x1 - 0.01, TOP, TOP + 0.006, 0.06, 0.55, 0.002))
    for x, zz, r in ((x0 + 0.16, 0.18, 0.07), (x1 - 0.16, 0.18, 0.09), (x0 + 0.16, 0.42, 0.09), (x1 - 0.16, 0.42, 0.07)):
        model.add("hob", "steel", revolve([(r - 0.002, TOP + 0.0062), (r, TOP + 0.0066), (r - 0.0035, TOP + 0.0066)], 40, 80).at(x, 0, zz))


def tall_unit(model):
    """A built-in fridge and freezer, to the right of the worktop."""
    model.add("carcass", "carcass", block(1.5, RIGHT, PLINTH, UPPER_HIGH, 0, DOOR - 0.002, 0), block(1.5, RIGHT, 0, PLINTH, 0, 0.5, 0))
    model.add(
        "fronts",
        "front green",
        block(1.482, 1.5, 0, UPPER_HIGH, 0, DOOR + 0.02, 0.002),
        block(1.482, RIGHT, UPPER_HIGH, UPPER_HIGH + 0.02, 0, DOOR + 0.02, 0.002),
    )
    front(model, 1.5, RIGHT, PLINTH, 0.78, "left")
    front(model, 1.5, RIGHT, 0.78, UPPER_HIGH, "left")


def sink_and_tap(model):
    x0, x1, z0, z1, low = -0.30, 0.30, 0.13, 0.50, 0.71
    model.add(
        "sink",
        "china",
        block(x0 - 0.012, x0, low - 0.01, TOP + 0.004, z0 - 0.012, z1 + 0.012, 0.003),
        block(x1, x1 + 0.012, low - 0.01, TOP + 0.004, z0 - 0.012, z1 + 0.012, 0.003),
        block(x0, x1, low - 0.01, TOP + 0.004, z0 - 0.012, z0, 0.003),
        block(x0, x1, low - 0.01, TOP + 0.004, z1, z1 + 0.012, 0.003),
        block(x0, x1, low - 0.01, low, z0, z1, 0),
    )
    neck = (
        [(0, TOP, 0.075), (0, TOP + 0.20, 0.075)]
        + [(0, TOP + 0.26 + y, 0.165 - x) for x, y in arc((0, 0), 0.09, 0, 180, 12)]
        + [(0, TOP + 0.20, 0.255)]
    )
    model.add(
        "tap",
        "brass",
        tube(neck, 0.011, 14),
        cylinder(0.024, 0.012).at(0, TOP, 0.075),
        cylinder(0.017, 0.07).at(0, TOP, 0.075),
        tube([(0.015, TOP + 0.055, 0.075), (0.075, TOP + 0.085, 0.085)], [0.007, 0.005], 10),
        cylinder(0.0135, 0.03).at(0, TOP + 0.185, 0.255),
    )


def upper_units(model):
    for x0, x1, side in ((0.80, 1.15, "left"), (1.15, 1.482, "left")):
        model.add("carcass", "front green", block(x0, x1, UPPER_LOW, UPPER_HIGH, 0, UPPER_DEPTH, 0.001))
        front(model, x0, x1, UPPER_LOW, UPPER_HIGH, side, UPPER_DEPTH)
    hood(model)
    for height in (1.42, 1.80):
        model.add("shelves", "worktop oak", block(LEFT, -1.58, height, height + 0.03, 0, 0.24, 0.003))
        for x in (-2.0, -1.68):
            model.add("shelves", "brass", tube([(x, height - 0.10, 0.006), (x, height - 0.006, 0.006), (x, height - 0.006, 0.22)], 0.006, 8))
    model.add("plate", "china", plate(0.115))
    for k in range(5):
        model.place("plate", -1.95, 1.45 + 0.011 * k, 0.12)
    model.add("small bowl", "blue glaze", bowl(0.075, 0.055))
    for k in range(3):
        model.place("small bowl", -1.72, 1.45 + 0.022 * k, 0.12)
    model.add("mug", "blue glaze", cup(0.042, 0.085))
    model.place("mug", -2.01, 1.83, 0.12, -40)
    model.place("mug", -1.88, 1.83, 0.12, -75)
    model.add("wine bottle", "green bottle", bottle(0.30, 0.036))
    model.place("wine bottle", -1.74, 1.83, 0.11)
    model.place("wine bottle", -0.80, TOP, 0.12)
    model.add("oil bottle", "amber bottle", bottle(0.23, 0.034))
    model.place("oil bottle", -1.64, 1.83, 0.13)
    model.place("oil bottle", -0.71, TOP, 0.15)


def hood(model):
    """An extractor: a bevelled canopy that tapers into its chimney."""
    outline = [(-0.30, 0), (0.30, 0), (0.30, 0.05), (0.13, 0.22), (0.13, 0.80), (-0.13, 0.80), (-0.13, 0.22), (-0.30, 0.05)]
    model.add("hood", "steel", extrude(outline, 0.36, 0.004).at(-1.2, 1.62, 0.18))
    model.add("hood", "black metal", block(-1.43, -0.97, 1.612, 1.622, 0.06, 0.30, 0.002))


def tiles(model):
    """Metro tiles, 150 x 75 mm in half bond with 3 mm joints, bevelled, on a bed of grout."""
    x0, x1, sill, _ = WINDOW
    fields = [(LEFT, x0 - 0.04, TOP, 1.62), (x0 - 0.04, x1 + 0.04, TOP, sill - 0.03), (x1 + 0.04, 1.482, TOP, UPPER_LOW)]
    for fx0, fx1, fy0, fy1 in fields:
        model.add("grout", "grout", block(fx0, fx1, fy0, fy1, 0, 0.004, 0))
        for a, b, low, high in bonded(fx0, fx1, fy0, fy1, 0.153, 0.078, 0.003, start=LEFT):
            model.add("tiles", "tile", block(a, b, low, high, 0.002, 0.010, 0.005, back=False))


def island(model):
    x0, x1, z0, z1 = -1.15, 0.45, 1.40, 2.10
    model.add("island", "island white", block(x0 + 0.05, x1 - 0.05, PLINTH, CARCASS, z0 + 0.03, z1 - 0.18, 0.002))
    for k in range(3):
        a = x0 + 0.05 + 0.5 * k
        front(model, a, a + 0.5, PLINTH, CARCASS, "none", z1 - 0.18, "island white", "island")
    model.add("carcass", "carcass", block(x0 + 0.09, x1 - 0.09, 0, PLINTH, z0 + 0.07, z1 - 0.22, 0))
    model.add("island top", "butcher block", block(x0, x1, CARCASS, TOP, z0, z1, 0.005).textured_from("y", 0.72, 0.72))
    wood, metal = stool(0.65)
    model.add("stool", "worktop oak", wood)
    model.add("stool", "black metal", metal)
    model.place("stool", -0.74, 0, 2.24, 20)
    model.place("stool", -0.02, 0, 2.30, -8)
    model.add("fruit", "blue glaze", bowl(0.15, 0.08).at(-0.62, TOP, 1.72))
    model.add("orange", "orange", orange(0.038))
    for x, y, z in ((-0.68, 0.022, 1.70), (-0.59, 0.022, 1.66), (-0.58, 0.022, 1.77), (-0.655, 0.028, 1.785), (-0.625, 0.078, 1.725)):
        model.place("orange", x, TOP + y, z)
    model.add("cup", "china", cup(0.041, 0.072))
    model.place("cup", -0.08, TOP, 1.82, -50)
    model.place("cup", 0.14, TOP, 1.66, 30)
    model.add("book", "cloth", block(0.16, 0.34, TOP, TOP + 0.022, 1.80, 2.04, 0.003))
    model.add("book", "china", block(0.165, 0.342, TOP + 0.003, TOP + 0.019, 1.803, 2.037, 0.001))


def on_the_worktop(model):
    for x, r, h, name in ((0.98, 0.048, 0.17, "china"), (1.10, 0.044, 0.14, "china"), (1.21, 0.040, 0.115, "china")):
        model.add("jars", name, jar(r, h).at(x, TOP, 0.14))
        model.add("jars", "worktop oak", jar_lid(r, h).at(x, TOP, 0.14))
    board = extrude(rounded(0.26, 0.40, 0.03), 0.018, 0.004)
    model.add("board", "board", board.turned("x", -14).at(-1.72, TOP + 0.20, 0.075))
    pot = revolve([(0, 0), (0.040, 0), (0.053, 0.075), (0.058, 0.075), (0.059, 0.098), (0.053, 0.098), (0.050, 0.082), (0, 0.080)], 32)
    model.add("herbs", "terracotta", pot.at(0.43, TOP, 0.16), pot.at(-0.44, 1.084, -0.02))
    model.add("herbs", "leaf", leafy(8).at(0.43, TOP + 0.08, 0.16), leafy(8, 0.14, 9).at(-0.44, 1.16, -0.02))
    kettle(model)


def kettle(model):
    """On the hob: body, lid with knob, spout and a bail handle."""
    x, z, y = -1.34, 0.42, TOP + 0.0066
    body = spline([(0.095, 0.006), (0.105, 0.03), (0.092, 0.085), (0.055, 0.128), (0.040, 0.135)], 5)
    profile = [
        (0, 0),
        (0.088, 0),
        *body,
        (0.036, 0.142),
        (0.010, 0.147),
        (0.007, 0.152),
        *[(r, h + 0.163) for r, h in arc((0, 0), 0.012, -50, 90, 4)],
    ]
    bail = [(0.085 * c, 0.095 + 0.115 * s, 0) for c, s in arc((0, 0), 1.0, 8, 172, 16)]
    spout = spline([(0.085, 0.06, 0), (0.125, 0.085, 0), (0.140, 0.125, 0)], 5)
    model.add(
        "kettle", "steel", revolve(profile, 32).at(x, y, z), tube(spout, [0.022 - 0.001 * k for k in range(11)], 14).turned("y", -35).at(x, y, z)
    )
    model.add("kettle", "black metal", tube(bail, 0.007, 10).turned("y", -35).at(x, y, z))


def fittings(model):
    """What holds the lamps: trims of the downlights, flex and canopy of the pendant, end caps of the tube."""
    model.add("trim", "frame white", revolve([(0.077, -0.001), (0.079, -0.009), (0.096, -0.004), (0.098, 0.0)], 40, 60))
    for x, z in DOWNLIGHTS:
        model.place("trim", x, CEILING, z)
    x, y, z = PENDANT
    model.add(
        "pendant fitting",
        "brass",
        tube([(x, y + 0.135, z), (x, CEILING - 0.02, z)], 0.004, 8),
        cylinder(0.05, 0.025).at(x, CEILING - 0.025, z),
        revolve([(0.058, -0.007), (0.060, 0.0), (0.022, 0.045), (0.012, 0.055), (0, 0.055)], 32).at(x, y + 0.092, z),
    )
    for x in (1.1395 - 0.158, 1.1395 + 0.158):
        model.add("tube fitting", "frame white", block(x - 0.012, x + 0.012, UPPER_LOW - 0.036, UPPER_LOW, 0.22, 0.26, 0.003))


def rig():
    warm = {"temperature": "4000 K"}
    lights = [
        {
            "name": f"downlight {k + 1}",
            "shape": {"type": "disk", "radius": "75 mm"},
            "emission": {"flux": "730 lm"},
            "colour": warm,
            "translation": [x, CEILING - 0.004, z],
            "rotation": DOWN,
        }
        for k, (x, z) in enumerate(DOWNLIGHTS)
    ]
    lights.append(
        {
            "name": "under-cabinet tube",
            "shape": {"type": "tube", "length": "272 mm", "radius": "8 mm", "caps": "round"},
            "emission": {"flux": "430 lm"},
            "colour": {"temperature": "4000 K"},
            "translation": [1.1395, UPPER_LOW - 0.022, 0.24],
        }
    )
    lights.append(
        {
            "name": "opal pendant",
            "shape": {"type": "sphere", "radius": "100 mm"},
            "emission": {"flux": "900 lm"},
            "colour": {"temperature": "2700 K"},
            "translation": list(PENDANT),
        }
    )
    x0, x1, y0, y1 = WINDOW
    lights.append(
        {
            "name": "window at blue hour",
            "shape": {"type": "rect", "width": "1.5 m", "height": "1.3 m"},
            "emission": {"luminance": "36 nit"},
            "colour": {"daylight": "15000 K"},
            "translation": [(x0 + x1) / 2, (y0 + y1) / 2, -0.32],
            "rotation": TOWARDS_VIEWER,
        }
    )
    camera = {"position": [0.62, 1.52, 4.05], "target": [-0.18, 1.17, 0.6], "vfov": "52 deg", "exposure": {"ev100": 5.0}}
    return rig_file(lights, camera, [{"gltf": "kitchen.glb"}])
