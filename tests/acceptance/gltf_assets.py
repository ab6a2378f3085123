"""glTF's two material models as a reader of our own in numpy sees them: diffuse colour, f0 and roughness of every texel."""
import json
import struct

import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")


def halved(values):
    """The next mip level of rows of texels: means of 2 x 2, a row or column that is left over left out."""
    rows, columns = (max(n // 2 * 2, 1) for n in values.shape[:2])
    if min(rows, columns) < 2:
        return values
    return values[:rows, :columns].reshape(rows // 2, 2, columns // 2, 2, -1).mean((1, 3))


class Asset:
    """A document and its pictures, at a mip level that a reader makes from their linear values."""

    def __init__(self, file, level=0):
        self.level = level
        self.folder, data = file.parent, file.read_bytes()
        self.binary = b""
        if data[:4] == b"glTF":
            length = struct.unpack("<I", data[12:16])[0]
            self.document, self.binary = json.loads(data[20:20 + length]), data[28 + length:]
        else:
            self.document = json.loads(data)

    def pixels(self, info, srgb):
        """Rows of red, green, blue, alpha in 0..1, linear."""
        image = self.document["images"][self.document["textures"][info["index"]]["source"]]
        if "uri" in image:
            bitmap = mi.Bitmap(str(self.folder / image["uri"].replace("%20", " ")))
        else:
            view = self.document["bufferViews"][image["bufferView"]]
            begin = view.get("byteOffset", 0)
            stream = mi.MemoryStream()
            stream.write(self.binary[begin:begin + view["byteLength"]])
            stream.seek(0)
            bitmap = mi.Bitmap(stream)
        codes = np.array(bitmap)
        values = codes.astype(np.float64) / (255 if codes.dtype == np.uint8 else 65535)
        if values.ndim == 2:
            values = values[:, :, None]
        if values.shape[2] < 3:
            values = np.concatenate([np.repeat(values[:, :, :1], 3, 2), values[:, :, 1:2]], 2)
        if values.shape[2] == 3:
            values = np.concatenate([values, np.ones(values.shape[:2] + (1,))], 2)
        colour = values[:, :, :3]
        if srgb:
            values[:, :, :3] = np.where(colour <= 0.04045, colour / 12.92, ((colour + 0.055) / 1.055) ** 2.4)
        for _ in range(self.level):
            values = halved(values)
        return values

    def textured(self, owner, key, srgb, factor):
        """Texture times factor; one texel where there is no texture."""
        if key in owner:
            return self.pixels(owner[key], srgb) * np.array(factor)
        return np.array(factor, dtype=np.float64).reshape(1, 1, 4)


def common(*pictures):
    """One texel for all, or as many as the largest has; those of another size are not looked up here."""
    shape = max((p.shape[:2] for p in pictures), key=lambda s: s[0] * s[1])
    assert all(p.shape[:2] in (shape, (1, 1)) for p in pictures), [p.shape for p in pictures]
    return [np.broadcast_to(p, shape + (4,)).reshape(-1, 4) for p in pictures]


def gloss(asset, material):
    e = material["extensions"]["KHR_materials_pbrSpecularGlossiness"]
    diffuse, specular = common(asset.textured(e, "diffuseTexture", True, e.get("diffuseFactor", [1, 1, 1, 1])),
                               asset.textured(e, "specularGlossinessTexture", True, e.get("specularFactor", [1, 1, 1]) + [e.get("glossinessFactor", 1)]))
    f0 = specular[:, :3]
    return diffuse[:, :3] * (1 - f0.max(1, keepdims=True)), f0, 1 - specular[:, 3]


def metal(asset, material, full):
    core, e = material.get("pbrMetallicRoughness", {}), material.get("extensions", {})
    specular = e.get("KHR_materials_specular", {}) if full else {}
    ior = e.get("KHR_materials_ior", {}).get("ior", 1.5) if full else 1.5
    base, mr, colour, factor = common(
        asset.textured(core, "baseColorTexture", True, core.get("baseColorFactor", [1, 1, 1, 1])),
        asset.textured(core, "metallicRoughnessTexture", False, [1, core.get("roughnessFactor", 1), core.get("metallicFactor", 1), 1]),
        asset.textured(specular, "specularColorTexture", True, specular.get("specularColorFactor", [1, 1, 1]) + [1]),
        asset.textured(specular, "specularTexture", False, [1, 1, 1, specular.get("specularFactor", 1)]))
    m, root = mr[:, 2:3], 1 if ior == 0 else (ior - 1) / (ior + 1)
    k = np.minimum(root * root * colour[:, :3], 1) * factor[:, 3:4]
    return (1 - m) * base[:, :3], (1 - m) * k + m * base[:, :3], mr[:, 1]


def rms(pair, wanted):
    size = max(len(pair[0]), len(wanted[0]))
    return np.sqrt(sum(((np.broadcast_to(a, (size, 3)) - np.broadcast_to(b, (size, 3))) ** 2).sum() for a, b in zip(pair, wanted)) / (6 * size))
