"""What no metallic-roughness file can go below: optima and bounds over all base colours, metal masks and dielectric f0, in numpy.

A pair is (d, f), diffuse colour and f0; a file says b and m to all readers, and the dielectric's k to those that know
KHR_materials_specular: ((1 - m) b, k (1 - m) + m b), with k = .04 in a core-only reader. E_core and E_full are the sums of the six squares.
"""
import numpy as np

CORE = 0.04


def weighted(pairs):
    """Distinct pairs, and the share of the texels that each has."""
    distinct, counts = np.unique(np.concatenate(pairs, 1), axis=0, return_counts=True)
    return distinct[:, :3], distinct[:, 3:], counts / counts.sum()


def rms_of(squares, share):
    return float(np.sqrt((squares * share).sum() / 6))


def best_base(m, d, f, weight):
    """The b of least E_core + weight E_full for masks m, each channel by itself: a parabola where k is free, another where it is at an end."""
    m = m[:, None]
    left = 1 - m
    towards, across = (1 + weight) * left * d + m * (f - CORE * left), (1 + weight) * left * left + m * m
    with np.errstate(all="ignore"):
        k = np.where(left > 0, (f - m * towards / across) / np.maximum(left, 1e-300), f - m * towards / across)
    bound = np.where((k < 0) | (k > 1) | (left == 0), weight, 0)
    return np.clip((towards + bound * m * (f - left * (k > 0))) / (across + bound * m * m), 0, 1)


def errors(b, m, d, f):
    """E_core and E_full of base colours b in each channel, with the best k."""
    m = m[:, None]
    left = 1 - m
    diffuse = (left * b - d) ** 2
    k = np.clip((f - m * b) / np.maximum(left, 1e-300), 0, 1)
    return diffuse + (CORE * left + m * b - f) ** 2, diffuse + (k * left + m * b - f) ** 2


def kinks(d, f):
    """Masks where a bound of the full reader's exact solution begins to hold, and the middles between them: with s = 1 - m it is b = d / s and
    k = (f - m b) / s, within its bounds while s >= d, m <= f / (f + d) and s^2 - (f + d) s + d >= 0. The valleys of large weights lie there."""
    half = (f + d) / 2
    square = half * half - d
    root = np.sqrt(np.maximum(square, 0))
    both = np.where(square > 0, 1 - half - root, 0), np.where(square > 0, 1 - half + root, 0)
    found = np.sort(np.clip(np.concatenate([1 - d, f / np.maximum(f + d, 1e-300), *both], 1), 0, 1), 1)
    return np.concatenate([found, (found[:, 1:] + found[:, :-1]) / 2, found[:, :1] / 2], 1)


def search(d, f, weight):
    """E_core and E_full where E_core + weight E_full is least: from the best of 129 masks and from the best kink, in steps that halve."""

    def least(masks, width):
        best, found = np.full(len(d), np.inf), np.zeros((3, len(d)))

        def consider(m):
            nonlocal best, found
            core, full = (e.sum(1) for e in errors(best_base(m, d, f, weight), m, d, f))
            better = core + weight * full < best
            best = np.where(better, core + weight * full, best)
            found = np.where(better, np.stack([core, full, m]), found)

        for m in masks:
            consider(m)
        for _ in range(14):
            middle = found[2].copy()
            consider(np.clip(middle - width, 0, 1))
            consider(np.clip(middle + width, 0, 1))
            width /= 2
        return best, found

    grid, of_grid = least([np.full(len(d), m) for m in np.linspace(0, 1, 129)], 1 / 256)
    places, of_places = least(list(kinks(d, f).T), 1 / 256)
    return tuple(np.where(places < grid, of_places, of_grid)[:2])


def of_codes(d, f, weight, top):
    """The same over what textures of that many codes can hold without factors (k is left free, which can only lower it). E_full's least over
    k is convex in b, and so is the sum: of the codes the best is one beside the best b."""
    table = linear(np.arange(top + 1) / top)
    best, found = np.full(len(d), np.inf), np.zeros((2, len(d)))
    for code in range(top + 1):
        m = np.full(len(d), code / top)
        above = np.clip(np.searchsorted(table, best_base(m, d, f, weight)), 1, top)
        low, high = errors(table[above - 1], m, d, f), errors(table[above], m, d, f)
        better = high[0] + weight * high[1] < low[0] + weight * low[1]
        core, full = (np.where(better, h, w).sum(1) for h, w in zip(high, low))
        less = core + weight * full < best
        best = np.where(less, core + weight * full, best)
        found = np.where(less, np.stack([core, full]), found)
    return found[0], found[1]


def in_parts(function, d, f, *rest):
    parts = [function(d[i:i + 20000], f[i:i + 20000], *rest) for i in range(0, len(d), 20000)]
    return tuple(np.concatenate(columns) for columns in zip(*parts))


def core_optimum(d, f, share):
    """The least rms of a core-only reader: a full one counts for nothing."""
    return rms_of(in_parts(search, d, f, 0.0)[0], share)


def bounds(d, f, share, limit, bits):
    """The least rms of a core-only reader that any file can have whose full reader's rms is within the limit, and the least of files with
    textures of so many bits. By duality: whatever the weight, the mean of least E_core + weight (E_full - 6 limit^2) is below the mean of
    E_core of every such file."""
    any_file, w = highest_bound(search, (), d, f, share, limit, 10.0 ** np.arange(0, 7.1, 0.25))
    if bits > 8:
        return any_file, any_file
    return any_file, highest_bound(of_codes, (255,), d, f, share, limit, w * 10.0 ** np.array([-0.75, -0.5, -0.25, 0, 0.25]))[0]


def highest_bound(function, rest, d, f, share, limit, weights):
    """The highest of a few bounds, and its weight. Each bounds by itself; they are concave in the weight, with the slope mean E_full - 6 limit^2,
    so that the best one has a full rms of just the limit. Some of the pairs say how that goes with the weight, all of them by what factor it
    is another one: a few texels can have most of the error."""
    few = np.random.default_rng(1).choice(len(d), 1000, p=share)
    equal = np.full(len(few), 1 / len(few))
    of_few = np.array([rms_of(function(d[few], f[few], w, *rest)[1], equal) for w in weights])
    best, best_weight, factor, tried = 0.0, weights[0], 1.0, set()
    for _ in range(4):
        i = int(np.argmin(np.abs(np.log(np.maximum(of_few * factor, 1e-12) / limit))))
        if i in tried:
            break
        tried.add(i)
        core, full = in_parts(function, d, f, weights[i], *rest)
        value = float(np.sqrt(max(((core + weights[i] * (full - 6 * limit * limit)) * share).sum() / 6, 0)))
        if value > best:
            best, best_weight = value, weights[i]
        factor = rms_of(full, share) / max(of_few[i], 1e-12)
    return best, best_weight


def closed_form(d, f, bits):
    """Khronos' reference converter (glTF repository, extensions/2.0/Archived/KHR_materials_pbrSpecularGlossiness/examples), by its published
    formula: the metal mask from the brightness of both colours as a root of a quadratic equation, the base colour between what diffuse and
    specular say, by the mask's square. Its dielectrics lose .04 of the diffuse colour, which today's glTF no longer says: with and without
    that factor, to be measured by the better one. Pairs of (diffuse, f0) as a reader sees them in textures of so many bits."""
    top = 2 ** bits - 1
    strength = 1 - f.max(1)
    diffuse = d / np.maximum(strength, 1e-300)[:, None]  # the extension's own diffuse colour
    weights = np.array([0.299, 0.587, 0.114])
    bright_d, bright_f = np.sqrt((diffuse ** 2 * weights).sum(1)), np.sqrt((f ** 2 * weights).sum(1))
    b, c = bright_d * strength / (1 - CORE) + bright_f - 2 * CORE, CORE - bright_f
    root = np.sqrt(np.maximum(b * b - 4 * CORE * c, 0))
    m = np.where(bright_f < CORE, 0, np.clip((-b + root) / (2 * CORE), 0, 1))[:, None]
    stored = np.rint(m * top) / top
    for factor in (1 - CORE, 1.0):
        of_diffuse = diffuse * strength[:, None] / factor / np.maximum(1 - m, 1e-6)
        of_specular = (f - CORE * (1 - m)) / np.maximum(m, 1e-6)
        base = np.clip(of_diffuse + (of_specular - of_diffuse) * m * m, 0, 1)
        base = linear(np.rint(encoded(base) * top) / top)
        yield (1 - stored) * base, CORE * (1 - stored) + stored * base


def encoded(x):
    """sRGB's transfer function."""
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * np.maximum(x, 1e-9) ** (1 / 2.4) - 0.055)


def linear(code):
    return np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4)
