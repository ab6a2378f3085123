"""Small textures: 8-bit RGB PNG files whose bytes depend on nothing but this file, and the noise that fills them."""

import math
import struct
import zlib


def png(width, height, pixel):
    """pixel(u, v) -> (r, g, b) in 0..1, encoded as they are. The deflate blocks are stored, not compressed, so that the
    bytes don't change with the version of the compressor."""
    rows = bytearray()
    for y in range(height):
        rows.append(0)
        for x in range(width):
            rows += bytes(min(255, max(0, math.floor(c * 255 + 0.5))) for c in pixel((x + 0.5) / width, (y + 0.5) / height))
    stream = bytearray(b"\x78\x01")
    for start in range(0, len(rows), 65535):
        part = rows[start : start + 65535]
        stream += struct.pack("<BHH", start + 65535 >= len(rows), len(part), 65535 - len(part)) + part
    stream += struct.pack(">I", zlib.adler32(rows))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", bytes(stream)) + chunk(b"IEND", b"")


def normal_png(width, height, depth, size_u, size_v):
    """The normal map of a height field depth(u, v) in metres over size_u x size_v metres that repeats; +Y is up the image,
    as glTF has it."""
    du, dv = 1.0 / width, 1.0 / height

    def pixel(u, v):
        slope_u = (depth(u + du, v) - depth(u - du, v)) / (2 * du * size_u)
        slope_up = (depth(u, v - dv) - depth(u, v + dv)) / (2 * dv * size_v)
        size = math.sqrt(slope_u**2 + slope_up**2 + 1)
        return (0.5 - 0.5 * slope_u / size, 0.5 - 0.5 * slope_up / size, 0.5 + 0.5 / size)

    return png(width, height, pixel)


def hashed(x, y, seed=0):
    """A fixed pseudo-random number in 0..1 for a lattice point (integer mixing after Wang and Jenkins)."""
    n = (x * 374761393 + y * 668265263 + seed * 2147483647) & 0xFFFFFFFF
    n = ((n ^ (n >> 13)) * 1274126177) & 0xFFFFFFFF
    return ((n ^ (n >> 16)) & 0xFFFF) / 65535.0


def noise(u, v, cells_u, cells_v, seed=0):
    """Smooth value noise in 0..1 with the given cells in one tile; it repeats."""
    x, y = u * cells_u, v * cells_v
    i, j = math.floor(x), math.floor(y)
    fx, fy = ((t * t * (3 - 2 * t)) for t in (x - i, y - j))
    a, b, c, d = (hashed((i + p) % cells_u, (j + q) % cells_v, seed) for p, q in ((0, 0), (1, 0), (0, 1), (1, 1)))
    return (a + (b - a) * fx) * (1 - fy) + (c + (d - c) * fx) * fy


def clouds(u, v, cells_u, cells_v, octaves=4, seed=0):
    """Octaves of noise, each of half the amplitude and twice the cells; 0..1."""
    total, weight = 0.0, 0.0
    for k in range(octaves):
        total += noise(u, v, cells_u << k, cells_v << k, seed + k) / (1 << k)
        weight += 1.0 / (1 << k)
    return total / weight


def mix(a, b, t):
    return tuple(x + (y - x) * t for x, y in zip(a, b))


def smooth(low, high, x):
    t = min(1.0, max(0.0, (x - low) / (high - low)))
    return t * t * (3 - 2 * t)
