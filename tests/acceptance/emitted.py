"""What the projectors and textured spots of an exported scene send, from their parameters and texels as Mitsuba's documentation and source define
them (facts that `check` compares with Mitsuba's own evaluation): candelas towards directions, and lumens without noise."""
import math
import xml.etree.ElementTree as ET

import numpy as np

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def numbers(element, name):
    return np.array([float(word) for word in element.find("*[@name='%s']" % name).get("value").replace(",", " ").split()])


def along_texels(coordinate, count):
    """Index of the lower texel and the share of the next one, where `coordinate` counts texel centres; clamped to the outermost ones."""
    held = np.clip(coordinate, 0, count - 1)
    lower = np.minimum(held.astype(int), count - 2)
    return lower, held - lower


class Emitter:
    """A pattern on the plane one metre ahead of the emitter, square within +-extent in its own x and y."""

    def __init__(self, mi, xml, element):
        self.spot = element.get("type") == "spot"
        bitmap = element.find("texture")
        file = xml.parent / bitmap.find("*[@name='filename']").get("value")
        picture = mi.Bitmap(str(file)).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False)
        self.texels = np.array(picture).astype(np.float64) @ LUMINANCE
        placed = bitmap.find("transform[@name='to_uv']")
        self.scale, self.shift = (1.0, 0.0) if placed is None else (float(placed.find(step).get("x")) for step in ("scale", "translate"))
        self.to_world = np.array([float(v) for v in element.find("transform[@name='to_world']/matrix").get("value").split()]).reshape(4, 4)
        if self.spot:
            self.cutoff = math.radians(numbers(element, "cutoff_angle")[0])
            self.beam = math.radians(numbers(element, "beam_width")[0])
            self.factor = float(numbers(element, "intensity") @ LUMINANCE)
            self.extent = math.tan(self.cutoff)
        else:
            scale = element.find("float[@name='scale']")
            self.factor = math.pi * (float(scale.get("value")) if scale is not None else 1)
            self.extent = math.tan(math.radians(numbers(element, "fov")[0]) / 2)

    def centre_coordinates(self, x, y):
        """Of columns and rows, counted from the first texels' centres."""
        sign = 1 if self.spot else -1
        u, v = 0.5 + sign * x / (2 * self.extent), 0.5 + sign * y / (2 * self.extent)
        rows, columns = self.texels.shape
        return (self.scale * u + self.shift) * columns - 0.5, (self.scale * v + self.shift) * rows - 0.5

    def pattern(self, x, y):
        column, row = self.centre_coordinates(x, y)
        (i, s), (j, t) = along_texels(column, self.texels.shape[1]), along_texels(row, self.texels.shape[0])
        at = self.texels
        return (1 - t) * ((1 - s) * at[j, i] + s * at[j, i + 1]) + t * ((1 - s) * at[j + 1, i] + s * at[j + 1, i + 1])

    def candelas(self, directions):
        """Towards unit vectors of the world, an array of three columns."""
        local = directions @ self.to_world[:3, :3]
        ahead = local[:, 2] > 1e-9
        z = np.where(ahead, local[:, 2], 1)
        x, y = local[:, 0] / z, local[:, 1] / z
        if self.spot:
            angle = np.arctan(np.hypot(x, y))
            share = np.clip((self.cutoff - angle) / (self.cutoff - self.beam), 0, 1)
            return np.where(ahead, self.factor * share * self.pattern(x, y), 0)
        inside = ahead & (np.abs(x) <= self.extent) & (np.abs(y) <= self.extent)
        return np.where(inside, self.factor * self.pattern(x, y) / z**3, 0)

    def flux(self):
        return self.flux_of_spot() if self.spot else self.flux_of_projector()

    def flux_of_projector(self):
        """I dw = factor t / cos^3 x cos^3 dx dy: the integral of the bilinear interpolant, exact by Gauss's two points between texel centres."""
        def weights(count, first, last):
            borders = np.unique(np.concatenate([[first, last], np.arange(math.ceil(first), math.floor(last) + 1)]))
            middle, half, weight = (borders[1:] + borders[:-1]) / 2, (borders[1:] - borders[:-1]) / 2, np.zeros(count)
            for sign in (-1, 1):
                lower, share = along_texels(middle + sign * half / math.sqrt(3), count)
                np.add.at(weight, lower, half * (1 - share))
                np.add.at(weight, lower + 1, half * share)
            return weight / (last - first)

        columns, rows = self.centre_coordinates(np.array([self.extent, -self.extent]), np.array([self.extent, -self.extent]))
        mean = weights(self.texels.shape[0], *rows) @ self.texels @ weights(self.texels.shape[1], *columns)
        return self.factor * mean * (2 * self.extent)**2

    def flux_of_spot(self):
        """By the middles of rings and sectors, four of them a texel at the edge of the cone; what lies between beam and cutoff, a millionth of the
        cone, as if it were full."""
        rings, sectors = 2 * self.texels.shape[0], 8 * self.texels.shape[0]
        step, turn = self.cutoff / rings, 2 * math.pi / sectors
        phi = (np.arange(sectors) + 0.5) * turn
        total = 0
        for ring in range(rings):
            tangent = math.tan((ring + 0.5) * step)
            total += (math.cos(ring * step) - math.cos((ring + 1) * step)) * self.pattern(tangent * np.cos(phi), tangent * np.sin(phi)).sum()
        return self.factor * turn * total


def emitters_of(mi, xml):
    return [Emitter(mi, xml, element) for element in ET.parse(xml).getroot().findall("emitter") if element.get("type") in ("spot", "projector")]
