"""A model of named parts and metal-rough materials, written as one binary glTF 2.0 file."""

import dataclasses
import json
import math
import struct

from modelling.mesh import Mesh


@dataclasses.dataclass(frozen=True)
class Material:
    """Colours are linear Rec.709; a texture is an sRGB PNG that multiplies the colour, a normal map a linear one."""

    colour: tuple
    roughness: float
    metallic: float = 0.0
    texture: bytes | None = None
    normal: bytes | None = None


class Model:
    def __init__(self, name, materials):
        self.name = name
        self.materials = materials  # name -> Material
        self.parts = {}  # name -> {material: Mesh}
        self.placements = {}  # name -> [(translation, degrees about y)]

    def add(self, part, material, *meshes):
        if material not in self.materials:
            raise KeyError(f"{self.name}: no material {material}")
        self.parts.setdefault(part, {}).setdefault(material, Mesh()).add(*meshes)

    def place(self, part, x, y, z, degrees=0.0):
        """One more copy of a part, turned about y, then moved. A part that is never placed stands where it was modelled."""
        self.placements.setdefault(part, []).append(((x, y, z), degrees))

    def triangles(self):
        return sum(
            len(mesh.indices) // 3 * max(1, len(self.placements.get(part, []))) for part, meshes in self.parts.items() for mesh in meshes.values()
        )

    def glb(self):
        return _Writer(self).bytes()


def as_float32(x):
    """Rounded to float; what is zero but for the last bits of a sine becomes zero."""
    return struct.unpack("<f", struct.pack("<f", 0.0 if abs(x) < 1e-7 else x))[0]


class _Writer:
    def __init__(self, model):
        self.model = model
        self.blob = bytearray()
        self.document = {
            "asset": {"version": "2.0", "generator": "examples/rigs/generate.py"},
            "scene": 0,
            "scenes": [{"nodes": []}],
            "nodes": [],
            "meshes": [],
            "materials": [],
            "accessors": [],
            "bufferViews": [],
        }
        self.images = {}

    def view(self, data, **more):
        while len(self.blob) % 4:
            self.blob.append(0)
        self.document["bufferViews"].append({"buffer": 0, "byteOffset": len(self.blob), "byteLength": len(data), **more})
        self.blob += data
        return len(self.document["bufferViews"]) - 1

    def accessor(self, data, component, kind, count, target, **more):
        view = self.view(data, target=target)
        self.document["accessors"].append({"bufferView": view, "componentType": component, "count": count, "type": kind, **more})
        return len(self.document["accessors"]) - 1

    def floats(self, rows, kind, bounds=False):
        data = b"".join(struct.pack(f"<{len(row)}f", *row) for row in rows)
        more = {"min": [min(c) for c in zip(*rows)], "max": [max(c) for c in zip(*rows)]} if bounds else {}
        return self.accessor(data, 5126, kind, len(rows), 34962, **more)

    def texture(self, data, name):
        if data not in self.images:
            for key in ("images", "textures", "samplers"):
                self.document.setdefault(key, [])
            view = self.view(data)
            self.document["images"].append({"bufferView": view, "mimeType": "image/png", "name": name})
            self.document["samplers"] = [{"magFilter": 9729, "minFilter": 9987, "wrapS": 10497, "wrapT": 10497}]
            self.document["textures"].append({"sampler": 0, "source": len(self.document["images"]) - 1})
            self.images[data] = len(self.document["textures"]) - 1
        return self.images[data]

    def add_material(self, name, m):
        rough = {"baseColorFactor": [*m.colour, 1.0], "metallicFactor": m.metallic, "roughnessFactor": m.roughness}
        entry = {"name": name, "pbrMetallicRoughness": rough}
        if m.texture:
            rough["baseColorTexture"] = {"index": self.texture(m.texture, name + " colour")}
        if m.normal:
            entry["normalTexture"] = {"index": self.texture(m.normal, name + " normal"), "scale": 1.0}
        self.document["materials"].append(entry)
        return len(self.document["materials"]) - 1

    def add_mesh(self, part, meshes, material_index):
        primitives = []
        for name, mesh in meshes.items():
            material = self.model.materials[name]
            rows, indices = _welded(mesh, bool(material.texture or material.normal))
            attributes = {
                "POSITION": self.floats([row[0:3] for row in rows], "VEC3", True),
                "NORMAL": self.floats([row[3:6] for row in rows], "VEC3"),
            }
            if len(rows[0]) > 6:
                attributes["TEXCOORD_0"] = self.floats([row[6:8] for row in rows], "VEC2")
            wide = len(rows) > 65535
            data = struct.pack(f"<{len(indices)}{'I' if wide else 'H'}", *indices)
            indices = self.accessor(data, 5125 if wide else 5123, "SCALAR", len(indices), 34963)
            primitives.append({"attributes": attributes, "indices": indices, "material": material_index[name]})
        self.document["meshes"].append({"name": part, "primitives": primitives})
        return len(self.document["meshes"]) - 1

    def bytes(self):
        used = {name for meshes in self.model.parts.values() for name in meshes}
        material_index = {name: self.add_material(name, m) for name, m in self.model.materials.items() if name in used}
        for part, meshes in self.model.parts.items():
            mesh = self.add_mesh(part, meshes, material_index)
            for k, (where, degrees) in enumerate(self.model.placements.get(part, [((0, 0, 0), 0.0)])):
                node = {"name": part if k == 0 else f"{part} {k + 1}", "mesh": mesh}
                if any(where):
                    node["translation"] = list(where)
                if degrees:
                    half = math.radians(degrees) / 2
                    node["rotation"] = [0.0, round(math.sin(half), 7), 0.0, round(math.cos(half), 7)]
                self.document["scenes"][0]["nodes"].append(len(self.document["nodes"]))
                self.document["nodes"].append(node)
        while len(self.blob) % 4:
            self.blob.append(0)
        self.document["buffers"] = [{"byteLength": len(self.blob)}]
        text = json.dumps(self.document, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(self.blob), 0x004E4942) + bytes(self.blob)
        return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks


def _welded(mesh, textured):
    """Rows of position, normal (and texture coordinates) as floats, equal ones once, and the triangles' indices into them."""
    rows, place, indices = [], {}, []
    row_of = {}
    for i in mesh.indices:
        if i not in row_of:
            values = (*mesh.positions[i], *_direction(mesh.normals[i]), *(mesh.uvs[i] if textured else ()))
            row = tuple(as_float32(x) for x in values)
            if row not in place:
                place[row] = len(rows)
                rows.append(row)
            row_of[i] = place[row]
        indices.append(row_of[i])
    return rows, indices


def _direction(n):
    size = math.sqrt(sum(x * x for x in n))
    if size == 0:
        raise ValueError("a normal without direction")
    return [x / size for x in n]
