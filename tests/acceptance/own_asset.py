"""A small textured glTF asset, made here: what a converter of materials can get wrong is in it. An arch with smooth normals carries a base
colour (sRGB, with a factor), a metallic-roughness texture and a scaled normal map, each with its own transform of the texture coordinates,
which are mirrored on one half; a box without normals is shaded flat; a panel shines with a picture; a light of KHR_lights_punctual."""
import json
import math
import pathlib
import struct
import zlib

import scenes

PI = math.pi


def png(width, height, pixel):
    """Eight bits a channel; pixel(u, v) gives red, green, blue in 0..1."""
    rows = bytearray()
    for y in range(height):
        rows.append(0)
        for x in range(width):
            rows += bytes(min(255, max(0, round(255 * c))) for c in pixel((x + 0.5) / width, (y + 0.5) / height))
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(bytes(rows))) + chunk(b"IEND", b"")


def colours(u, v):
    stripes = 0.5 + 0.4 * math.sin(6 * PI * u)
    return 0.2 + 0.7 * stripes, 0.3 + 0.5 * v, 0.9 - 0.6 * stripes


def metal_rough(u, v):
    """Roughness in green, metallic in blue; red, which is occlusion elsewhere, must not matter."""
    return 0.1, 0.45 + 0.3 * math.sin(4 * PI * v), 0.5 - 0.5 * math.cos(2 * PI * u)


def bumps(u, v):
    """The normal of z = a sin(2 pi 4 u) cos(2 pi 3 v): unequal along u and v, so that neither can stand for the other."""
    x, y = -0.35 * math.cos(8 * PI * u) * math.cos(6 * PI * v), 0.2 * math.sin(8 * PI * u) * math.sin(6 * PI * v)
    length = math.sqrt(x * x + y * y + 1)
    return tuple(0.5 + 0.5 * c / length for c in (x, y, 1.0))


def panes(u, v):
    return (1.0, 0.8, 0.4) if (u < 0.5) == (v < 0.5) else (0.1, 0.3, 0.6)


def arch(columns=32, rows=6, radius=0.5, width=0.9):
    positions, normals, uvs, indices = [], [], [], []
    for half in (0, 1):  # two strips of triangles, so that the seam's coordinates can jump
        first = len(positions)
        for i in range(columns // 2 + 1):
            angle = PI * (i + half * columns // 2) / columns
            for j in range(rows + 1):
                n = (-math.cos(angle), math.sin(angle), 0.0)
                positions.append((radius * n[0], radius * n[1], width * (j / rows - 0.5)))
                normals.append(n)
                uvs.append((2 * i / columns if half == 0 else 1.5 - 2 * i / columns, 1 - j / rows))
        for i in range(columns // 2):
            for j in range(rows):
                a = first + i * (rows + 1) + j
                b = a + rows + 1
                indices += [a, a + 1, b, b, a + 1, b + 1]
    return positions, normals, uvs, indices


def box(x, y, z, size):
    corners = [(x + size * (i & 1), y + size * (i >> 1 & 1), z + size * (i >> 2)) for i in range(8)]
    faces = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3))
    positions, uvs, indices = [], [], []
    for face in faces:
        indices += [len(positions) + k for k in (0, 1, 2, 0, 2, 3)]
        positions += [corners[k] for k in face]
        uvs += [(0, 1), (1, 1), (1, 0), (0, 0)]
    return positions, None, uvs, indices


def panel(x, y, z, width, height):
    """Faces +Z."""
    positions = [(x, y, z), (x + width, y, z), (x + width, y + height, z), (x, y + height, z)]
    return positions, None, [(0, 1), (1, 1), (1, 0), (0, 0)], [0, 1, 2, 0, 2, 3]


class Builder:
    def __init__(self):
        self.data = bytearray()
        self.views, self.accessors, self.meshes = [], [], []

    def accessor(self, values, kind, code, component):
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": 4 * len(values)})
        self.data += struct.pack("<%d%s" % (len(values), code), *values)
        parts = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}[kind]
        entry = {"bufferView": len(self.views) - 1, "componentType": component, "count": len(values) // parts, "type": kind}
        if kind == "VEC3":
            floats = struct.unpack("<%df" % len(values), bytes(self.data[-4 * len(values):]))
            entry.update(min=[min(floats[c::3]) for c in range(3)], max=[max(floats[c::3]) for c in range(3)])
        self.accessors.append(entry)
        return len(self.accessors) - 1

    def mesh(self, name, geometry, material):
        positions, normals, uvs, indices = geometry
        flat = lambda rows: [c for row in rows for c in row]
        attributes = {"POSITION": self.accessor(flat(positions), "VEC3", "f", 5126), "TEXCOORD_0": self.accessor(flat(uvs), "VEC2", "f", 5126)}
        if normals:
            attributes["NORMAL"] = self.accessor(flat(normals), "VEC3", "f", 5126)
        primitive = {"attributes": attributes, "indices": self.accessor(indices, "SCALAR", "I", 5125), "material": material}
        self.meshes.append({"name": name, "primitives": [primitive]})


def transformed(index, offset, scale, rotation):
    return {"index": index, "extensions": {"KHR_texture_transform": {"offset": offset, "scale": scale, "rotation": rotation}}}


def write(folder):
    for name, pixel in (("colours", colours), ("metal_rough", metal_rough), ("bumps", bumps), ("panes", panes)):
        (folder / (name + ".png")).write_bytes(png(64, 64, pixel))
    builder = Builder()
    builder.mesh("arch", arch(), 0)
    builder.mesh("box", box(0.1, 0.001, 0.5, 0.2), 1)
    builder.mesh("panel", panel(-0.9, 0.1, -0.7, 0.7, 0.5), 2)
    (folder / "asset.bin").write_bytes(builder.data)
    pieces = {"baseColorFactor": [0.9, 0.8, 1, 1], "baseColorTexture": transformed(0, [0.1, 0.2], [1.5, 0.75], 0.4),
              "metallicRoughnessTexture": transformed(1, [0.3, -0.1], [0.8, 1.2], -0.3), "roughnessFactor": 0.9}
    materials = [
        {"name": "arch", "doubleSided": True, "pbrMetallicRoughness": pieces,
         "normalTexture": dict(transformed(2, [0.05, 0.4], [1, 1.25], 0.25), scale=0.7)},
        {"name": "box", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0, "roughnessFactor": 0.4}},
        {"name": "panel", "emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 3},
         "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.1, 0.1, 1], "metallicFactor": 0},
         "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 800}}}]
    lamp = {"type": "point", "name": "lamp", "intensity": 600, "color": [1, 0.9, 0.7]}
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2, 3]}],
        "extensionsUsed": ["KHR_texture_transform", "KHR_lights_punctual", "KHR_materials_emissive_strength"],
        "extensions": {"KHR_lights_punctual": {"lights": [lamp]}},
        "nodes": [{"name": "arch", "mesh": 0}, {"name": "box", "mesh": 1}, {"name": "panel", "mesh": 2},
                  {"name": "lamp", "translation": [0.9, 1.1, 0.8], "extensions": {"KHR_lights_punctual": {"light": 0}}}],
        "meshes": builder.meshes, "materials": materials, "textures": [{"source": i, "sampler": i % 2} for i in range(4)],
        "samplers": [{}, {"wrapS": 33648, "wrapT": 33648}],
        "images": [{"uri": name + ".png"} for name in ("colours", "metal_rough", "bumps", "panes")],
        "accessors": builder.accessors, "bufferViews": builder.views,
        "buffers": [{"uri": "asset.bin", "byteLength": len(builder.data)}]}
    (folder / "asset.gltf").write_text(json.dumps(document))


def rig(folder):
    """A rig file around the asset, in a folder of its own."""
    folder = pathlib.Path(folder) / "own_asset"
    folder.mkdir(exist_ok=True)
    write(folder)
    return scenes.rig_around(folder / "scene.rig.json", "asset.gltf", (0, 0.25, 0), 0.6, True)
