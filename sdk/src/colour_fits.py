#!/usr/bin/env python3
"""Makes colour_fits.inc: rational functions for the colours of Planckian radiators and for correlated colour temperatures.

Needs numpy:  .venv/bin/python sdk/src/colour_fits.py > sdk/src/colour_fits.inc
Every fit is linear least squares for N - f D over the earlier D (Sanathanan and Koerner 1963), reweighted towards the
largest errors (Lawson 1961); what comes out is held to its bound by tests, not by this program.
"""

import pathlib
import re

import numpy as np
from numpy.polynomial import chebyshev, polynomial

C2_UM_K = 1.438776877e4
ROWS = re.findall(r"^\{(.*), (.*), (.*)\},", (pathlib.Path(__file__).parent / "cie1931.inc").read_text(), re.MULTILINE)
CMF = np.array(ROWS, dtype=float)
UM = np.arange(360, 831) * 1e-3


def locus(reciprocal_K):
    """X, Y, Z of Planckian radiators up to a factor, and their derivatives by 1/T."""
    y = C2_UM_K * reciprocal_K[:, None] / UM
    f = y / np.expm1(y)
    slope = f * (1 - f - y) / y * C2_UM_K / UM
    weight = CMF / UM[:, None] ** 4
    return f @ weight, slope @ weight


def fit(numerators, denominator, targets, scale, steps):
    """Coefficients c with numerators_i c / (1 + denominator c) = target_i, the largest error over `scale` least."""
    count, size = len(targets), numerators[0].shape[1]
    bend, below, best = np.ones(len(scale)), np.ones(len(scale)), (np.inf, None)
    for _ in range(steps):
        weight = np.sqrt(bend) / below / scale
        rows = []
        for i, target in enumerate(targets):
            blocks = [numerators[i] if j == i else np.zeros_like(numerators[i]) for j in range(count)]
            rows.append(np.hstack([*blocks, -target[:, None] * denominator]) * weight[:, None])
        system, wanted = np.vstack(rows), np.concatenate([t * weight for t in targets])
        norms = np.linalg.norm(system, axis=0)
        c = np.linalg.lstsq(system / norms, wanted, rcond=None)[0] / norms
        below = 1 + denominator @ c[count * size :]
        values = [n @ c[i * size : (i + 1) * size] / below for i, n in enumerate(numerators)]
        error = np.sqrt(sum((v - t) ** 2 for v, t in zip(values, targets, strict=True))) / scale
        if below.min() > 0 and error.max() < best[0]:
            best = (error.max(), c)
        bend = bend * (0.2 + error / error.max())
        bend /= bend.mean()
    parts = [best[1][i * size : (i + 1) * size] for i in range(count)]
    return best[0], [*parts, np.concatenate([[1], best[1][count * size :]])]


def planckian(degree, least_K, steps):
    """X = X/S and y = Y/S as polynomials of s = least_K/T, s from 0 to 1."""
    t = np.cos(np.pi * (np.arange(2000) + 0.5) / 2000)
    xyz, _ = locus((t + 1) / 2 / least_K)
    x, y = xyz[:, 0] / xyz.sum(1), xyz[:, 1] / xyz.sum(1)
    basis = chebyshev.chebvander(t, degree)
    # An error in (x, y) is about 6/D of one in (u', v'), D = -2x + 12y + 3.
    error, parts = fit([basis, basis], basis[:, 1:], [x, y], (-2 * x + 12 * y + 3) / 6, steps)

    def in_s(series):  # t = 2s - 1
        total = np.zeros(1)
        for c in chebyshev.cheb2poly(series)[::-1]:
            total = polynomial.polyadd(polynomial.polymul(total, [-1, 2]), [c])
        return total

    polynomials = [in_s(p) for p in parts]
    largest = np.abs(polynomials[2]).max()
    return error, [p / largest for p in polynomials]


def beside_locus(least_K, largest_K, largest_duv):
    """Points (u, v) at distances along the locus' normals, and their temperatures."""
    m = 1 / np.geomspace(least_K, largest_K, 240)
    xyz, slope = locus(m)
    k = np.array([1, 15, 3])
    d, d1 = xyz @ k, slope @ k
    u, v = 4 * xyz[:, 0] / d, 6 * xyz[:, 1] / d
    u1, v1 = (4 * slope[:, 0] - u * d1) / d, (6 * slope[:, 1] - v * d1) / d
    duv, speed = np.linspace(-largest_duv, largest_duv, 31), np.hypot(u1, v1)[:, None]
    return (u[:, None] - v1[:, None] / speed * duv).ravel(), (v[:, None] + u1[:, None] / speed * duv).ravel(), np.repeat(1 / m, 31)


def powers(a, b, degree):
    """a^i b^j with i + j <= degree, the constant first."""
    return np.stack([a**i * b**j for i in range(degree + 1) for j in range(degree + 1 - i)], 1)


def nested(coefficients, degree):
    """The same coefficients in the order in which two nested Horner schemes want them."""
    of, all_ = {}, iter(coefficients)
    for i in range(degree + 1):
        for j in range(degree + 1 - i):
            of[i, j] = next(all_)
    return [of[i, j] for i in range(degree, -1, -1) for j in range(degree - i, -1, -1)]


def write(comment, kind, name, values):
    digits, suffix = (9, "f") if kind == "float" else (17, "")
    print(f"// {comment}")
    print(f"constexpr {kind} {name}[] = {{")
    print("".join(f"    {v:.{digits - 1}e}{suffix},\n" for v in values) + "};")


def main():
    print("// Made by colour_fits.py; what each is, and how far off, is said there and where it is used.")
    error, (x, y, s) = planckian(7, 800, 300)
    write(f"Planckian x = X/S, y = Y/S over s = 800 K/T, constants first; {error:.1e} in (u', v').", "float", "planckian_x", x)
    write("Its y.", "float", "planckian_y", y)
    write("Its denominator.", "float", "planckian_s", s)

    u, v, kelvin = beside_locus(500, 100000, 0.05)
    a, b = u - 0.3, v - 0.32
    mired = 1e6 / kelvin
    error, (n, d) = fit([powers(a, b, 4)], powers(a, b, 3)[:, 1:], [mired], np.ones_like(mired), 200)
    write(f"Mired from (u - .3, v - .32), 500 K to 100000 K, |Duv| <= .05; {error:.1f} mired.", "double", "mired_numerator", nested(n, 4))
    write("Its denominator.", "double", "mired_denominator", nested(d, 3))

    u, v, kelvin = beside_locus(1000, 40000, 0.02)
    x, y = 3 * u / (2 * u - 8 * v + 4), 2 * v / (2 * u - 8 * v + 4)
    a, b = x - 0.33, y - 0.33
    error, (n, d) = fit([powers(a, b, 3)], powers(a, b, 3)[:, 1:], [kelvin / 6500], kelvin / 6500, 200)
    write(
        f"T from (x - .33, y - .33), 1000 K to 40000 K, |Duv| <= .02; {error:.1e} of T.",
        "float",
        "kelvin_numerator",
        [6500 * c for c in nested(n, 3)],
    )
    write("Its denominator.", "float", "kelvin_denominator", nested(d, 3))

    u, v, _ = beside_locus(1000, 40000, 0.05)
    a, b = 3 * u / (2 * u - 8 * v + 4) - 0.33, 2 * v / (2 * u - 8 * v + 4) - 0.33
    duv = np.tile(np.linspace(-0.05, 0.05, 31), len(u) // 31)
    error, (n, _) = fit([powers(a, b, 2)], np.zeros((len(a), 0)), [duv], np.ones_like(duv), 200)
    write(f"Duv from the same, only to tell near from far; {error:.3f} up to .05.", "float", "duv_quadratic", nested(n, 2))


main()
