#!/usr/bin/env python3
"""Makes normal_filter_table.inc: the GGX lobe nearest to the average of GGX lobes whose normals are spread.

Needs numpy:  .venv/bin/python sdk/src/normal_filter_table.py > sdk/src/normal_filter_table.inc
The average is  D(h) = int p(n) D_GGX(h.n) dn  with von Mises and Fisher's density p of concentration kappa about the mean normal;
nearest is the lobe with the least  1/2 int |D(h) / norm - D_GGX'(h)| cos(h) dh, the share of facets that are out of place.
What comes out is held to its bound by tests/unit/normal_filter_test.cpp, which integrates anew.
"""

import numpy as np

STEPS = 16  # of each side of the grid


def rule(count):
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return (nodes + 1) / 2, weights / 2


U, WEIGHT = rule(240)
PLACE, SHARE = rule(600)
AZIMUTH_COS = np.cos(np.pi * (np.arange(160) + 0.5) / 160)


def ggx(cosine, alpha):
    return np.where(cosine > 0, alpha**2 / np.pi / (cosine**2 * (alpha**2 - 1) + 1) ** 2, 0)


def spread(cosine, kappa):
    return kappa / (-2 * np.pi * np.expm1(-2 * kappa)) * np.exp(kappa * (cosine - 1))


def average_lobe(theta, alpha, kappa):
    """D at the angles theta: quadrature by the narrower of the two factors' own distribution."""
    cosine, sine = np.cos(theta)[:, None, None], np.sin(theta)[:, None, None]
    if alpha * alpha < 2 / kappa:
        tangent = alpha * np.sqrt(U / (1 - U))
        c = 1 / np.sqrt(1 + tangent**2)
        s = tangent * c
        between = cosine * c[:, None] + sine * s[:, None] * AZIMUTH_COS
        return (spread(between, kappa).mean(2) * (WEIGHT / c)).sum(1)
    c = 1 + np.log(U + (1 - U) * np.exp(-2 * kappa)) / kappa
    s = np.sqrt(np.maximum(0, 1 - c * c))
    between = cosine * c[:, None] + sine * s[:, None] * AZIMUTH_COS
    return (ggx(between, alpha).mean(2) * WEIGHT).sum(1)


def nearest(alpha, squared_spread):
    """Alpha' over its closed-form estimate, and the share of facets out of place; squared_spread = 2 / kappa."""
    estimate = np.sqrt((alpha**2 + squared_spread) / (1 + squared_spread))
    theta = np.arctan(estimate * np.sqrt(PLACE / (1 - PLACE)))
    by_estimate = ggx(np.cos(theta), estimate)
    share = average_lobe(theta, alpha, 2 / squared_spread) / by_estimate
    share /= (share * SHARE).sum()

    def misplaced(factor):
        return 0.5 * (np.abs(share - ggx(np.cos(theta), estimate * factor) / by_estimate) * SHARE).sum()

    low, high = np.log(0.5), np.log(1.5)
    golden = (np.sqrt(5) - 1) / 2
    for _ in range(40):
        a, b = high - golden * (high - low), low + golden * (high - low)
        if misplaced(np.exp(a)) < misplaced(np.exp(b)):
            high = b
        else:
            low = a
    factor = np.exp((low + high) / 2)
    return factor, misplaced(factor)


def place(turn, size):
    """Alpha and 2 / kappa of a place of the grid (normal_filter.cpp has the way back)."""
    alpha, bent = (1, 2 * turn) if turn <= 0.5 else (2 * (1 - turn), 1)
    alpha, bent = max(alpha * size, 1e-4 * size), bent * size
    return alpha, bent**2 / max(1 - bent**2, 1e-9)


def main():
    print("// Made by normal_filter_table.py: {alpha' over its estimate, share of facets out of place}; rows by size, columns by turn.")
    for j in range(STEPS + 1):
        cells = []
        for i in range(STEPS + 1):
            turn, size = i / STEPS, max(j / STEPS, 1e-3)
            factor, misplaced = (1.0, 0.0) if i == 0 else nearest(*place(turn, size))
            cells.append(f"{{{factor:.4f}f, {misplaced:.4f}f}},")
        print("\n".join(" ".join(cells[k : k + 6]) for k in range(0, len(cells), 6)))


if __name__ == "__main__":
    main()
