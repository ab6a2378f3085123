"""Things that more than one scene has: crockery, bottles, fruit, stools, handles, window frames, herbs."""

import math

from modelling.mesh import merged
from modelling.pixels import hashed
from modelling.shapes import arc, block, revolve, spline, surface, tube


def cup(radius=0.040, height=0.068):
    """A cup with a foot, a thin lip, an inside and an ear; its ear points along +x."""
    outside = spline([(0.55 * radius, 0.004), (0.62 * radius, 0.012), (0.90 * radius, 0.45 * height), (radius, height)], 4)
    inside = [(r - 0.003, y + 0.002) for r, y in reversed(outside[3:-1])]
    profile = [
        (0, 0.002),
        (0.50 * radius, 0.002),
        (0.52 * radius, 0.0),
        *outside,
        (radius - 0.0015, height + 0.001),
        *inside,
        (0.3 * radius, 0.012),
        (0, 0.011),
    ]
    ear = spline(
        [
            (0.86 * radius, 0.32 * height, 0),
            (1.25 * radius, 0.30 * height, 0),
            (1.62 * radius, 0.55 * height, 0),
            (1.45 * radius, 0.84 * height, 0),
            (0.97 * radius, 0.82 * height, 0),
        ],
        4,
    )
    return merged(revolve(profile, 32), tube(ear, 0.0038, 8))


def coffee(radius=0.040, height=0.068):
    """The drink in a cup of that size."""
    return revolve([(0.88 * radius, 0.80 * height), (0, 0.80 * height)], 32)


def saucer(radius=0.075):
    profile = [
        (0, 0),
        (0.42 * radius, 0),
        (0.45 * radius, 0.003),
        (0.80 * radius, 0.010),
        (radius, 0.017),
        (0.985 * radius, 0.0192),
        (0.78 * radius, 0.0125),
        (0.44 * radius, 0.0062),
        (0, 0.0055),
    ]
    return revolve(profile, 36, crease=50)


def plate(radius=0.13):
    profile = [
        (0, 0),
        (0.58 * radius, 0),
        (0.62 * radius, 0.004),
        (radius, 0.018),
        (0.988 * radius, 0.0205),
        (0.66 * radius, 0.0085),
        (0.58 * radius, 0.005),
        (0, 0.005),
    ]
    return revolve(profile, 36, crease=50)


def bottle(height=0.30, radius=0.037, neck=0.0145):
    """A shouldered bottle, closed, with a lip; a surface of revolution."""
    shoulder = spline(
        [
            (radius, 0.62 * height),
            (0.93 * radius, 0.68 * height),
            (0.60 * radius, 0.74 * height),
            (1.05 * neck, 0.80 * height),
            (neck, 0.86 * height),
        ],
        4,
    )
    profile = [
        (0, 0.008),
        (0.6 * radius, 0.004),
        (0.82 * radius, 0),
        (radius, 0.006),
        *shoulder,
        (neck, 0.955 * height),
        (neck + 0.0022, 0.957 * height),
        (neck + 0.0022, 0.982 * height),
        (neck, 0.986 * height),
        (neck, height),
        (0, height),
    ]
    return revolve(profile, 28)


def jar(radius=0.045, height=0.14):
    """A storage jar's body; its lid is jar_lid()."""
    profile = [(0, 0), (0.9 * radius, 0), (radius, 0.008), (radius, 0.86 * height), (0.92 * radius, 0.90 * height), (0, 0.90 * height)]
    return revolve(profile, 28, crease=50)


def jar_lid(radius=0.045, height=0.14):
    low = 0.90 * height
    profile = [
        (0.88 * radius, low - 0.004),
        (1.0 * radius, low - 0.002),
        (1.0 * radius, low + 0.012),
        (0.9 * radius, low + 0.017),
        (0.16 * radius, low + 0.020),
        *[(r, y + low + 0.030) for r, y in arc((0, 0), 0.011, -60, 90, 4)],
    ]
    return revolve(profile, 24, crease=50)


def bowl(radius=0.14, height=0.075):
    outside = spline([(0.38 * radius, 0.006), (0.72 * radius, 0.30 * height), (0.93 * radius, 0.68 * height), (radius, height)], 4)
    inside = [(r - 0.006, y + 0.004) for r, y in reversed(outside[:-1])]
    profile = [(0, 0), (0.36 * radius, 0), *outside, (radius - 0.003, height + 0.002), *inside, (0, 0.010)]
    return revolve(profile, 36, crease=50)


def orange(radius=0.038):
    """A little flattened, with the dimple of its stalk."""
    profile = [(r * radius, y * radius * 0.95) for r, y in arc((0, 0), 1.0, -90, 78, 10)] + [(0.10 * radius, 0.90 * radius), (0, 0.87 * radius)]
    return revolve(profile, 24, crease=60).at(0, 0.95 * radius, 0)


def handle(span, radius=0.006, reach=0.032):
    """A bar handle along x in front of z = 0: a rod on two posts."""
    posts = [tube([(s * (span / 2 - 0.03), 0, 0), (s * (span / 2 - 0.03), 0, reach)], 0.8 * radius, 8) for s in (-1, 1)]
    return merged(tube([(-span / 2, 0, reach), (span / 2, 0, reach)], radius, 12), *posts)


def stool(seat=0.66):
    """A bar stool: (wooden seat, metal frame) with four raked legs and a foot ring."""
    wood = revolve(
        [
            (0, seat - 0.035),
            (0.15, seat - 0.035),
            (0.168, seat - 0.028),
            (0.175, seat - 0.015),
            (0.170, seat - 0.004),
            (0.155, seat),
            (0.08, seat - 0.006),
            (0, seat - 0.010),
        ],
        40,
        crease=60,
    )
    legs = []
    for k in range(4):
        a = math.radians(45 + 90 * k)
        x, z = math.sin(a), math.cos(a)
        legs.append(tube([(0.215 * x, 0, 0.215 * z), (0.12 * x, seat - 0.03, 0.12 * z)], 0.011, 10))
    height = 0.22
    reach = 0.215 + (0.12 - 0.215) * height / (seat - 0.03)
    ring = tube([(reach * math.sin(t), height, reach * math.cos(t)) for t in (2 * math.pi * k / 32 for k in range(32))], 0.008, 8, closed=True)
    return wood, merged(ring, *legs)


def window_frame(width, height, columns, rows, profile=0.055, bar=0.026, depth=0.05):
    """An outer frame with glazing bars, centred on x, standing on y = 0, around z = 0."""
    w, half = width / 2, depth / 2
    parts = [
        block(-w, w, 0, profile, -half, half, 0.004),
        block(-w, w, height - profile, height, -half, half, 0.004),
        block(-w, -w + profile, profile, height - profile, -half, half, 0.004),
        block(w - profile, w, profile, height - profile, -half, half, 0.004),
    ]
    for k in range(1, columns):
        x = -w + width * k / columns
        wide = profile if columns == 2 else bar
        parts.append(block(x - wide / 2, x + wide / 2, profile, height - profile, -0.8 * half, 0.8 * half, 0.004))
    for k in range(1, rows):
        y = height * k / rows
        parts.append(block(-w + profile, w - profile, y - bar / 2, y + bar / 2, -0.7 * half, 0.7 * half, 0.004))
    return merged(*parts)


def leafy(stalks=14, height=0.16, seed=3):
    """A pot herb: bent stalks with pairs of leaves; (stalks and leaves)."""
    parts = []
    for k in range(stalks):
        turn, lean = 2 * math.pi * hashed(k, 0, seed), 0.015 + 0.055 * hashed(k, 1, seed)
        tall = height * (0.6 + 0.4 * hashed(k, 2, seed))
        path = spline(
            [
                (0.012 * math.sin(turn), 0, 0.012 * math.cos(turn)),
                (0.6 * lean * math.sin(turn), 0.55 * tall, 0.6 * lean * math.cos(turn)),
                (1.5 * lean * math.sin(turn), tall, 1.5 * lean * math.cos(turn)),
            ],
            2,
        )
        parts.append(tube(path, 0.0012, 4))
        for index, place in enumerate(path[1::1]):
            for side in (0, 180):
                size = 0.026 + 0.014 * hashed(k, 5 + index, seed)

                def leaf(u, v, size=size):
                    wide = 0.42 * size * math.sin(math.pi * min(1.0, 0.04 + 0.94 * v)) ** 0.8
                    x = (2 * u - 1) * wide
                    return (x, 0.55 * size * v - 0.5 * size * v * v + 3.0 * x * x, size * v)

                parts.append(surface(leaf, 2, 4).turned("y", side + 95 * index + 360 * hashed(k, 9, seed)).at(*place))
    return merged(*parts)
