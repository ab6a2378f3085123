"""Lamps by their colour temperature: chromaticity and linear Rec.709, and back from what a meter shows; a filter in front of them."""

import numpy as np

from etendue import Error, colour

kelvin = np.array([2000.0, 2700, 3200, 4000, 5600, 6500, 10000])
xy = colour.planckian(kelvin)
rgb = colour.to_rgb(xy)
print(f"{'K':>8} {'x':>8} {'y':>8} {'R':>8} {'G':>8} {'B':>8}")
for t, (x, y), (r, g, b) in zip(kelvin, xy, rgb, strict=True):
    print(f"{t:8.0f} {x:8.5f} {y:8.5f} {r:8.4f} {g:8.4f} {b:8.4f}")

# D65 is no black body: it lies above the locus, at a correlated temperature of its own.
d65 = colour.to_colour_temperature((0.3127, 0.3290))
print(f"D65: {d65.kelvin:.2f} K, Duv {d65.duv:.5f}")

# A full CTO brings daylight to tungsten: +159 mired.
print(f"5600 K behind +159 mired: {colour.shifted_by_mired(5600.0, 159.0):.0f} K")

try:
    colour.to_colour_temperature((0.3, 0.6))
except Error as error:
    print(f"x .3, y .6: {error.code}")
