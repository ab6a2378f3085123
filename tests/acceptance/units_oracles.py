"""What the accuracy of units, colour temperature and pixel formats is measured against: closed forms and integrals in 50 digits (mpmath),
sums over the colour-matching functions at 1 nm, every code of a format. Nothing here comes from the library. Figures are yielded as
(label, figure, limit), in the order of the goals.
"""

import math
import pathlib
import random
from fractions import Fraction

import mpmath as mp
import numpy as np

import etendue
from etendue import Disk, Environment, Frustum, Line, Mesh, Point, Rect, Sphere, Spot, Tube, colour, convert, pixel

mp.mp.dps = 50
ROOT = pathlib.Path(__file__).resolve().parents[2]
OBSERVER = ROOT.parent / "shared" / "data" / "cie1931_2deg_1nm.csv"


def ulps(found, exact, bits=53):
    """How far a float of so many bits is from a number, in units of its last place."""
    exact = mp.mpf(exact)
    exponent = mp.floor(mp.log(abs(exact), 2))
    return float(abs(mp.mpf(float(found)) - exact) / mp.power(2, exponent - bits + 1))


# ---- Light units ----


def linear_cases(rng):
    """Conversions of random sizes, each with its closed form."""
    x, r, w = (math.exp(rng.uniform(-12, 12)), math.exp(rng.uniform(-4, 2)), math.exp(rng.uniform(-4, 2)))
    d = r * (1 + math.exp(rng.uniform(-6, 6)))
    X, R, W, D, pi = mp.mpf(x), mp.mpf(r), mp.mpf(w), mp.mpf(d), mp.pi
    tube = 2 * pi * R * W + 4 * pi * R**2
    return [
        ("lm", "cd", Point(), X / (4 * pi)),
        ("cd", "lm", Point(), X * 4 * pi),
        ("lm", "lx", Point(), X / (4 * pi * D**2)),
        ("lx", "cd", Point(), X * D**2),
        ("lm", "nit", Sphere(r), X / (4 * pi**2 * R**2)),
        ("nit", "lm", Sphere(r), X * 4 * pi**2 * R**2),
        ("nit", "lx", Sphere(r), X * pi * (R / D) ** 2),
        ("cd", "nit", Sphere(r), X / (pi * R**2)),
        ("lm", "nit", Disk(r), X / (pi**2 * R**2)),
        ("lm", "lx", Disk(r), X / pi / (R**2 + D**2)),
        ("lm", "nit", Rect(w, r), X / (pi * W * R)),
        ("lm", "nit", Tube(w, r), X / (pi * tube)),
        ("cd", "nit", Tube(w, r), X / (2 * R * W + pi * R**2)),
        ("lm", "nit", Tube(w, r, caps="none"), X / (pi * 2 * pi * R * W)),
        ("lm", "nit", Mesh(w), X / (pi * W)),
        ("lm", "cd", Line(w), X / pi**2),
        ("nit", "lm/m2", Sphere(r), X * pi),
        ("lx", "nit", Environment(), X / pi),
    ], x, d


def linear():
    rng = random.Random(1)
    most = most_back = most_single = 0.0
    for _ in range(400):
        cases, x, d = linear_cases(rng)
        for given, wanted, shape, exact in cases:
            found = convert(x, wanted, unit=given, shape=shape, distance=d)
            most = max(most, ulps(found, exact))
            most_back = max(most_back, ulps(convert(found, given, unit=wanted, shape=shape, distance=d), x))
            single = np.float32(x)
            one = convert(np.array([single]), wanted, unit=given, shape=shape, distance=d)[0]
            most_single = max(most_single, ulps(one, exact / mp.mpf(x) * mp.mpf(float(single)), 24))
    yield "linear conversions, double: worst of 18 x 400, ulp", most, 2
    yield "linear conversions, float32: worst, ulp", most_single, 1
    yield "linear conversions, there and back: worst, ulp", most_back, 4


def near_a_rectangle():
    """2 L [p/s atan(q/s) + q/t atan(p/t)], s = hypot(p, d), t = hypot(q, d): two inverse tangents."""
    rng = random.Random(2)
    most = 0.0
    for _ in range(400):
        w, h, d = (math.exp(rng.uniform(-4, 4)) for _ in range(3))
        p, q = mp.mpf(w) / 2, mp.mpf(h) / 2
        s, t = mp.hypot(p, d), mp.hypot(q, d)
        exact = 2 * (p / s * mp.atan(q / s) + q / t * mp.atan(p / t))
        most = max(most, float(abs(convert("1 nit", "lx", shape=Rect(w, h), distance=d) / exact - 1)))
    yield "illuminance near a rectangle: worst relative", most, 1e-15


def solid_angles():
    cone = frustum = 0.0
    for full in [1e-6, 1e-4, 0.01, 0.02, 0.5, 1, 10, 30, 60, 90, 120, 179.9, 180, 200, 270, 350, 359.99, 360]:
        half = etendue.quantity(full / 2, "deg")
        exact = 4 * mp.pi * mp.sin(mp.mpf(half.si) / 2) ** 2
        found = convert("1 cd", "lm", shape=Spot(half, half), spot_flux="cone")
        cone = max(cone, float(abs(found / exact - 1)))
    for a in [1e-6, 1e-3, 0.5, 10, 60, 120, 150, 170, 179, 179.9, 179.9999]:
        for b in [1e-6, 0.5, 45, 100, 179.9999]:
            qa, qb = etendue.quantity(a, "deg"), etendue.quantity(b, "deg")
            exact = 4 * mp.asin(mp.sin(mp.mpf(qa.si) / 2) * mp.sin(mp.mpf(qb.si) / 2))
            frustum = max(frustum, float(abs(convert("1 cd", "lm", shape=Frustum(qa, qb)) / exact - 1)))
    yield "solid angle of cones, 1e-6 to 360 deg: worst relative", cone, 1e-15
    yield "solid angle of frusta, to 180 deg: worst relative", frustum, 1e-15


def shaped_spots():
    """The flux of a cone whose intensity falls between its half angles, by Gauss-Legendre quadrature over the cosine."""
    worst = 0.0
    falls = {"hard": lambda s: mp.mpf(1), "squared": lambda s: s * s, "smoothstep": lambda s: s * s * (3 - 2 * s)}
    for inner, outer in [(0, 30), (20, 35), (5, 5.01), (0, 90), (40, 60), (0.1, 0.25)]:
        qi, qo = etendue.quantity(inner, "deg"), etendue.quantity(outer, "deg")
        ci, co = mp.cos(mp.mpf(qi.si)), mp.cos(mp.mpf(qo.si))
        for name, fall in falls.items():
            integral = mp.quad(lambda c, fall=fall: fall((c - co) / (ci - co)), [co, ci])
            exact = 2 * mp.pi * ((1 - ci) + integral)
            found = convert("1 cd", "lm", shape=Spot(qi, qo), spot_falloff=name)
            worst = max(worst, float(abs(found / exact - 1)))
    yield "flux of shaped spots against quadrature: worst relative", worst, 1e-12


# ---- Colour temperature ----


def observer():
    table = np.loadtxt(OBSERVER, delimiter=",")
    return table[:, 0] * 1e-9, table[:, 1:]


def locus(kelvin):
    """(u, v) of CIE 1960 of Planck's law summed at 1 nm, and its derivatives in 1/T, by longdouble sums. c2 of SI 2019."""
    wavelength, cmf = observer()
    c2 = np.longdouble("1.438776877e-2")
    inverse = 1 / np.asarray(kelvin, np.longdouble)[..., None]
    a = c2 / wavelength.astype(np.longdouble)
    grown = np.expm1(a * inverse)
    weight = wavelength.astype(np.longdouble) ** -5
    xyz = (weight / grown) @ cmf.astype(np.longdouble)
    slope = (-weight * a * (grown + 1) / grown**2) @ cmf.astype(np.longdouble)

    def uv(v):
        below = v[..., 0] + 15 * v[..., 1] + 3 * v[..., 2]
        return 4 * v[..., 0], 6 * v[..., 1], below

    (nu, nv, below), (su, sv, sbelow) = uv(xyz), uv(slope)
    return nu / below, nv / below, (su * below - nu * sbelow) / below**2, (sv * below - nv * sbelow) / below**2


def to_xy(u, v):
    below = 2 * u - 8 * v + 4
    return np.stack([3 * u / below, 2 * v / below], axis=-1).astype(np.float64)


def beside(kelvin, duv):
    u, v, du, dv = locus(kelvin)
    length = np.hypot(du, dv)
    return to_xy(u - duv * dv / length, v + duv * du / length)


def blackbody():
    kelvin = np.geomspace(100, 100000, 2000)
    u, v, _, _ = locus(kelvin)
    found = colour.to_uv1960(colour.planckian(kelvin))
    reference = np.hypot(found[:, 0] - u, 1.5 * (found[:, 1] - v)).astype(np.float64)
    yield "blackbody chromaticity against own 1 nm sums, 100-100000 K: worst du'v'", float(reference.max()), 1e-12
    far_u, far_v, _, _ = locus(np.array([1e12]))
    limit = colour.to_uv1960(colour.planckian(math.inf))
    yield "blackbody at infinity against the sum at 1e12 K: du'v'", float(np.hypot(limit.u - far_u[0], 1.5 * (limit.v - far_v[0]))), 1e-9


def correlated():
    for label, low, high, most, kelvin_limit, relative in [
        ("1000-40000 K, |Duv| <= .02: worst |dT|, K", 1000, 40000, 0.02, 1e-3, False),
        ("800-100000 K, |Duv| <= .05: worst |dT|/T", 800, 100000, 0.05, 1e-6, True),
    ]:
        kelvin, duv = np.meshgrid(np.geomspace(low, high, 700)[1:-1], np.linspace(-most, most, 21)[1:-1])
        found = colour.to_colour_temperature(beside(kelvin, duv))
        apart = np.abs(found[..., 0] - kelvin)
        yield f"CCT, {label}", float((apart / kelvin if relative else apart).max()), kelvin_limit
        yield f"Duv, {label.split(':')[0]}: worst", float(np.abs(found[..., 1] - duv).max()), 1e-9


def daylight():
    below, above = (np.array(colour.daylight_or_planckian(t)) for t in (np.nextafter(4000, 0), 4000.0))
    yield "daylight joins at 4000 K: jump in u'v'", colour_distance(below, above), 1e-6
    rgb = np.array(colour.to_rgb(colour.daylight(6504.0)))
    yield "CIE D 6504 K to linear Rec.709, Y = 1: worst distance from (1, 1, 1)", float(np.abs(rgb - 1).max()), 1e-3
    rgb = np.array(colour.to_rgb((0.3127, 0.3290)))
    yield "D65 (.3127, .3290) to linear Rec.709: worst distance from (1, 1, 1)", float(np.abs(rgb - 1).max()), 1e-3


def colour_distance(a, b):
    ua, ub = colour.to_uv1960(a), colour.to_uv1960(b)
    return float(np.hypot(ua.u - ub.u, 1.5 * (ua.v - ub.v)))


# ---- Pixel formats ----


def small_floats(mantissa_bits):
    """Every finite number of an unsigned float with 5 bits of exponent, in order: its place is its code."""
    codes = np.arange(31 << mantissa_bits)
    exponent, mantissa = codes >> mantissa_bits, codes & ((1 << mantissa_bits) - 1)
    step = 2.0**-mantissa_bits
    return np.where(exponent == 0, mantissa * step * 2.0**-14, (1 + mantissa * step) * 2.0 ** (exponent - 15.0))


def nearest_even(values):
    """Around each number and each midpoint between neighbours: the doubles there, and the codes that nearest-even demands."""
    middle = (values[:-1] + values[1:]) / 2  # exact in double
    codes = np.arange(len(values))
    even = np.where(codes[:-1] % 2 == 0, codes[:-1], codes[1:])
    tests = [values, middle, np.nextafter(middle, 0), np.nextafter(middle, math.inf)]
    return np.concatenate(tests), np.concatenate([codes, even, codes[:-1], codes[1:]])


def small_float_mismatches():
    half = small_floats(10)
    given, codes = nearest_even(half)
    wrong = int(np.sum(pixel.pack_half(given)[0] != codes)) + int(np.sum(pixel.pack_half(-given[1:])[0] != codes[1:] + 0x8000))
    every = np.arange(65536, dtype=np.uint16)
    number = every[np.isfinite(every.view(np.float16))]
    wrong += int(np.sum(pixel.unpack_half(number) != number.view(np.float16).astype(np.float32)))
    yield f"half: wrong codes of {2 * len(given) + len(number)} at every number and midpoint", wrong, 0

    wrong, count = 0, 0
    for channel, bits, shift in [(0, 6, 0), (1, 6, 11), (2, 5, 22)]:
        given, codes = nearest_even(small_floats(bits))
        rgb = np.zeros((len(given), 3))
        rgb[:, channel] = given
        packed = pixel.pack_r11g11b10f(rgb)[0]
        wrong += int(np.sum(packed != codes.astype(np.uint32) << shift))
        wrong += int(np.sum(pixel.unpack_r11g11b10f(packed)[: 31 << bits, channel] != small_floats(bits)))
        count += len(given)
    yield f"R11G11B10F: wrong codes of {count}, each channel at every number and midpoint", wrong, 0


def shared_exponent(rgb):
    """EXT_texture_shared_exponent's rule in exact rationals."""
    rgb = [min(max(Fraction(x), Fraction(0)), Fraction(65408)) for x in rgb]
    brightest = max(rgb)
    floor_log2 = -16 if brightest == 0 else max(-16, math.floor(math.log2(brightest)))
    if brightest > 0:  # exactly, whatever log2 rounded
        while Fraction(2) ** (floor_log2 + 1) <= brightest:
            floor_log2 += 1
        while floor_log2 > -16 and Fraction(2) ** floor_log2 > brightest:
            floor_log2 -= 1
    exponent = floor_log2 + 1 + 15
    if math.floor(brightest / Fraction(2) ** (exponent - 24) + Fraction(1, 2)) == 512:
        exponent += 1
    r, g, b = (math.floor(x / Fraction(2) ** (exponent - 24) + Fraction(1, 2)) for x in rgb)
    return r | g << 9 | b << 18 | exponent << 27


def shared_exponent_mismatches():
    # Around every step of every exponent, with the other channels anywhere below.
    rng = np.random.default_rng(5)
    steps = np.concatenate([np.arange(0, 513) / 512, (np.arange(0, 512) + 0.5) / 512])
    brightest = np.concatenate([steps * 2.0**e for e in range(-15, 17)])
    brightest = np.concatenate([brightest, np.nextafter(brightest, 0), np.nextafter(brightest, math.inf)])
    brightest = np.minimum(brightest[brightest >= 0], 65408)
    rgb = brightest[:, None] * rng.uniform(0, 1, (len(brightest), 3))
    rgb[np.arange(len(rgb)), rng.integers(0, 3, len(rgb))] = brightest
    expected = np.array([shared_exponent(p) for p in rgb], np.uint32)
    wrong = int(np.sum(pixel.pack_rgb9e5(rgb)[0] != expected))
    yield f"RGB9E5: wrong codes of {len(rgb)} around every step of every exponent", wrong, 0


def figures():
    for section in [linear, near_a_rectangle, solid_angles, shaped_spots, blackbody, correlated, daylight, small_float_mismatches, shared_exponent_mismatches]:
        yield from section()
