#!/usr/bin/env python3
"""A conversion that is killed leaves the file that was there before whole: its bytes, and those of the files beside it.

    tests/cli/killed.py [--etendue PATH] [--side 1024] [--times 12]

An asset with a pair of large textures of noise, so that there is time to kill in, is converted over the result of another conversion, and
killed (SIGKILL) after a growing share of the time that it takes. Then it is let run to its end, which has to succeed in spite of the leftovers.
"""
import argparse
import json
import pathlib
import random
import struct
import subprocess
import sys
import tempfile
import time
import zlib

ROOT = pathlib.Path(__file__).resolve().parents[2]


def png(side, seed):
    """8 bits, RGBA, noise within what a dielectric can be."""
    noise = random.Random(seed)
    rows = b"".join(b"\0" + bytes(c & 0x7F for c in noise.randbytes(4 * side)) for _ in range(side))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", side, side, 8, 6, 0, 0, 0)) + chunk(b"IDAT", zlib.compress(rows, 1)) + chunk(b"IEND", b"")


def make_asset(folder, side):
    """A triangle with a specular-glossiness material of two pictures, as a .glb."""
    parts = [struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0), struct.pack("<6f", 0, 0, 1, 0, 0, 1), png(side, 1), png(side, 2)]
    binary, views = b"", []
    for part in parts:
        views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(part)})
        binary += part + b"\0" * (-len(part) % 4)
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 0}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
                      {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"}],
        "images": [{"bufferView": 2, "mimeType": "image/png"}, {"bufferView": 3, "mimeType": "image/png"}],
        "textures": [{"source": 0}, {"source": 1}], "bufferViews": views, "buffers": [{"byteLength": len(binary)}],
        "extensionsUsed": ["KHR_materials_pbrSpecularGlossiness"],
        "materials": [{"extensions": {"KHR_materials_pbrSpecularGlossiness": {"diffuseTexture": {"index": 0}, "specularGlossinessTexture": {"index": 1}}}}],
    }
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    file = folder / "in.glb"
    file.write_bytes(b"glTF" + struct.pack("<III", 2, 28 + len(text) + len(binary), len(text)) + b"JSON" + text + struct.pack("<I", len(binary)) + b"BIN\0" + binary)
    return file


def contents(folder):
    """Of the files that are no leftovers: those have names that begin with a dot."""
    return {str(f.relative_to(folder)): f.read_bytes() for f in sorted(folder.rglob("*"))
            if f.is_file() and not any(part.startswith(".") for part in f.relative_to(folder).parts)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--etendue", default=str(ROOT / "build/release/etendue"))
    parser.add_argument("--side", type=int, default=512)
    parser.add_argument("--times", type=int, default=8)
    options = parser.parse_args()
    failures = killed = 0
    with tempfile.TemporaryDirectory() as name:
        asset = make_asset(pathlib.Path(name), options.side)
        for extension in ("glb", "gltf"):
            folder = pathlib.Path(name) / extension
            folder.mkdir()
            command = [options.etendue, "convert", str(asset), str(folder / ("out." + extension)), "--force", "--materials", "metal-rough", "--bits"]
            subprocess.run([*command, "8"], check=True, capture_output=True)
            before, began = contents(folder), time.monotonic()
            subprocess.run([*command, "8"], check=True, capture_output=True)
            took = time.monotonic() - began
            failures += contents(folder) != before  # the same again
            for i in range(options.times):
                run = subprocess.Popen([*command, "16"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                try:
                    run.wait(timeout=took * (i + 0.5) / options.times)
                except subprocess.TimeoutExpired:
                    run.kill()
                if run.wait() != -9:
                    break  # it was done before
                killed += 1
                if contents(folder) != before:
                    failures += 1
                    print("%s: killed after %.3f s of %.3f s, and what was there has changed" % (extension, took * (i + 0.5) / options.times, took))
                    subprocess.run([*command, "8"], check=True, capture_output=True)
            after = subprocess.run([*command, "16"], capture_output=True, text=True)
            if after.returncode != 0 or contents(folder) == before or subprocess.run([options.etendue, "info", folder / ("out." + extension)], capture_output=True).returncode != 0:
                failures += 1
                print("%s: no good file after the leftovers of killed runs: %s" % (extension, after.stderr))
            left = [f.name for f in folder.rglob(".*")]
            if left:
                failures += 1
                print("%s: leftovers stay: %s" % (extension, ", ".join(left)))
    print("%d runs killed, %d failures" % (killed, failures))
    return 1 if failures or killed == 0 else 0


sys.exit(main())
