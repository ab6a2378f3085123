"""A lever espresso machine, half a metre tall, after the Italian ones of the fifties. It faces +z and stands on y = 0."""

import math

from modelling.mesh import merged
from modelling.shapes import arc, ball, block, cylinder, extrude, revolve, spline, tube

BOILER = -0.035  # z of the boiler's axis
GROUP = 0.088  # z of the group's axis, above the cup


def machine(put, dress):
    """put(metal, *meshes) takes what is copper, brass or chrome; dress(material, *meshes) the rest."""
    boiler(put)
    group(put, dress)
    portafilter(put, dress)
    steam_wand(put, dress)
    gauge(put, dress)
    sight_glass(put)


def boiler(put):
    """A bell-shaped base on four feet with its drip grate, the copper boiler between brass collars, its dome and finial."""
    base = (
        [(0, 0.012), (0.128, 0.012), (0.134, 0.016), (0.134, 0.024), (0.128, 0.030)]
        + spline([(0.126, 0.032), (0.120, 0.050), (0.108, 0.062), (0.104, 0.066)], 4)
        + [(0.098, 0.070), (0.0, 0.070)]
    )
    put("chrome", revolve(base, 64))
    for k in range(4):
        put(
            "brass",
            ball(0.013, 16, 8).stretched(1, 0.9, 1).at(0.105 * math.sin(0.8 + math.pi / 2 * k), 0.0118, 0.105 * math.cos(0.8 + math.pi / 2 * k)),
        )
    grate = [
        block(-half, half, 0.0700, 0.0740, 0.020 + 0.0095 * k, 0.0245 + 0.0095 * k, 0.0012)
        for k, half in ((k, math.sqrt(0.092**2 - (0.022 + 0.0095 * k) ** 2)) for k in range(7))
    ]
    put("chrome", *grate)

    wall = [(0.064, 0.118), (0.0665, 0.122), (0.0665, 0.352), (0.064, 0.356)]
    put("copper", revolve(wall, 64).at(0, 0, BOILER))
    collar = [(0.058, 0.0), (0.070, 0.0), (0.0745, 0.004), (0.0745, 0.012), (0.0705, 0.016), (0.0705, 0.021), (0.058, 0.021)]
    foot = spline([(0.094, 0.070), (0.088, 0.080), (0.074, 0.090), (0.069, 0.099)], 4)
    put(
        "brass",
        revolve([*foot, (0.058, 0.100)], 64).at(0, 0, BOILER),
        revolve(collar, 64).at(0, 0.099, BOILER),
        revolve(collar, 64).at(0, 0.350, BOILER),
    )
    dome = [(0.0690, 0.371)] + [(0.069 * x, 0.371 + 0.058 * y) for x, y in arc((0, 0), 1.0, 4, 80, 12)]
    put("copper", revolve([*dome, (0, 0.429)], 64).at(0, 0, BOILER))
    finial = [(0.020, 0.425), (0.022, 0.430), (0.012, 0.436), (0.009, 0.442), (0.016, 0.447), (0.016, 0.451), (0.008, 0.456)]
    finial += [(0.017 * x, 0.473 + 0.019 * y) for x, y in arc((0, 0), 1.0, -62, 66, 10)] + [(0.004, 0.493), (0.0035, 0.503), (0, 0.506)]
    put("brass", revolve(finial, 40).at(0, 0, BOILER))


def group(put, dress):
    """The neck, the spring's barrel, and the lever in its fork."""
    put("chrome", tube([(0, 0.262, 0.028), (0, 0.262, 0.070)], 0.022, 28), cylinder(0.040, 0.012, 36).turned("x", 90).at(0, 0.262, 0.022))
    barrel = [
        (0.0, 0.208),
        (0.034, 0.208),
        (0.036, 0.211),
        (0.036, 0.232),
        (0.033, 0.236),
        (0.0285, 0.240),
        (0.0285, 0.322),
        (0.031, 0.325),
        (0.031, 0.338),
        (0.027, 0.343),
        (0.012, 0.345),
        (0.009, 0.349),
        (0.009, 0.372),
        (0, 0.372),
    ]
    put("chrome", revolve(barrel, 48).at(0, 0, GROUP))
    put("brass", revolve([(0.0285, 0.268), (0.0315, 0.271), (0.0315, 0.281), (0.0285, 0.284)], 48).at(0, 0, GROUP))
    fork = extrude([(-0.012, 0.0), (0.012, 0.0), (0.010, 0.034), (0.004, 0.040), (-0.004, 0.040), (-0.010, 0.034)], 0.006, 0.001).turned("y", 90)
    put("chrome", *(fork.at(s * 0.0125, 0.340, GROUP) for s in (-1, 1)), tube([(-0.018, 0.368, GROUP), (0.018, 0.368, GROUP)], 0.0045, 14))
    lever = [(0, 0.352, GROUP - 0.030), (0, 0.368, GROUP), (0, 0.424, GROUP + 0.075)]
    put("chrome", tube(lever, 0.0062, 14))
    grip = [
        (0, -0.004),
        (0.007, -0.004),
        (0.0085, 0.0),
        (0.0095, 0.02),
        (0.0135, 0.060),
        (0.0150, 0.082),
        (0.0125, 0.100),
        (0.006, 0.108),
        (0, 0.109),
    ]
    lean = 53.0  # from the vertical, as the lever
    dress("walnut", revolve(rounded_profile(grip), 24).turned("x", lean).at(0, 0.424, GROUP + 0.075))


def portafilter(put, dress):
    """The filter holder under the group, its two spouts and its handle."""
    put(
        "chrome",
        revolve([(0.022, 0.178), (0.030, 0.184), (0.034, 0.190), (0.034, 0.206), (0.030, 0.208)], 40, 50).at(0, 0, GROUP),
        revolve([(0, 0.170), (0.007, 0.170), (0.008, 0.178), (0.022, 0.178)], 24).at(0, 0, GROUP),
    )
    for s in (-1, 1):
        put("chrome", tube(spline([(0, 0.174, GROUP), (s * 0.012, 0.170, GROUP), (s * 0.015, 0.156, GROUP)], 4), 0.0052, 12))
    put("chrome", tube([(0, 0.197, GROUP + 0.030), (0, 0.193, GROUP + 0.062)], [0.0075, 0.0065], 14))
    dress(
        "walnut",
        revolve(
            rounded_profile(
                [(0, -0.002), (0.008, -0.002), (0.0095, 0.004), (0.0105, 0.02), (0.0145, 0.062), (0.0155, 0.084), (0.012, 0.102), (0, 0.108)]
            ),
            24,
        )
        .turned("x", 97)
        .at(0, 0.193, GROUP + 0.060),
    )


def steam_wand(put, dress):
    wand = spline([(0.060, 0.300, BOILER + 0.02), (0.105, 0.304, 0.0), (0.122, 0.285, 0.010), (0.126, 0.20, 0.022), (0.136, 0.125, 0.040)], 6)
    put(
        "chrome",
        tube(wand, 0.0052, 14),
        cylinder(0.012, 0.030, 24).turned("z", -90).at(0.058, 0.300, BOILER + 0.02),
        ball(0.0075, 14, 8).at(0.1365, 0.121, 0.041),
    )
    knob = [(0, 0), (0.010, 0), (0.018, 0.006), (0.020, 0.016), (0.016, 0.025), (0, 0.028)]
    put("chrome", tube([(0.082, 0.300, BOILER + 0.018), (0.104, 0.322, BOILER + 0.018)], 0.005, 12))
    dress("walnut", revolve(rounded_profile(knob), 28).turned("z", -45).at(0.100, 0.318, BOILER + 0.018))


def rounded_profile(points):
    """Rounded between its points, the first and the last segments kept straight."""
    return [points[0]] + spline(points[1:-1], 4) + [points[-1]]


def around(mesh, height):
    """From in front of the boiler's axis to its left side."""
    return mesh.turned("y", -62).at(0, height, BOILER)


def gauge(put, dress):
    """A pressure gauge on a stub at the left of the boiler."""

    case = revolve([(0, 0), (0.024, 0), (0.028, 0.004), (0.028, 0.016), (0.025, 0.018), (0.0235, 0.0165), (0.0235, 0.013)], 40, 50)
    put("brass", around(case.turned("x", 90).at(0, 0, 0.078), 0.315), around(tube([(0, 0, 0.06), (0, 0, 0.080)], 0.007, 14), 0.315))
    dress("dial white", around(revolve([(0.0236, 0.0135), (0, 0.0135)], 40).turned("x", 90).at(0, 0, 0.078), 0.315))
    for k in range(9):
        mark = block(-0.0006, 0.0006, 0.0165, 0.021, 0.0136, 0.0140, 0).turned("z", 120 - 30 * k)
        dress("red" if k > 6 else "ink", around(mark.at(0, 0, 0.078), 0.315))
    dress("ink", around(block(-0.0008, 0.0008, -0.005, 0.017, 0.0140, 0.0150, 0.0003).turned("z", 25).at(0, 0, 0.078), 0.315))


def sight_glass(put):
    """Two fittings and the rod between them."""
    for height in (0.145, 0.255):
        put("brass", around(merged(tube([(0, 0, 0.06), (0, 0, 0.088)], 0.006, 14), cylinder(0.009, 0.026, 20).at(0, -0.013, 0.088)), height))
    put("chrome", around(tube([(0, 0.145, 0.088), (0, 0.255, 0.088)], 0.0052, 16), 0.0))
