#!/usr/bin/env python3
"""What is not converted stays: every valid glTF asset of ../shared/corpus/gltf through `etendue convert` into the other container and back, and
with its materials converted, keeps its JSON but for where bytes lie, and every byte that an accessor, a picture or an extension refers to.

    tests/cli/round_trip.py [--etendue PATH] [--corpus ../shared/corpus/gltf] [--only TEXT]

Every fourth goes back as well; every eighth has its materials converted, and so have those of specular-glossiness whose pictures are small (the
others are converted by tests/acceptance/materials).
"""
import argparse
import base64
import copy
import json
import pathlib
import struct
import subprocess
import sys
import tempfile
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parents[2]


def load(file):
    """A document, and its buffers' bytes."""
    data, chunk = file.read_bytes(), None
    if data[:4] == b"glTF":
        size = struct.unpack("<I", data[12:16])[0]
        text, rest = data[20:20 + size], data[20 + size:]
        if rest:
            chunk = rest[8:8 + struct.unpack("<I", rest[:4])[0]]
    else:
        text = data.removeprefix(b"\xef\xbb\xbf")
    document = json.loads(text)
    buffers = []
    for i, buffer in enumerate(document.get("buffers", [])):
        uri = buffer.get("uri")
        bytes_ = named(file, uri) if uri is not None else chunk if i == 0 else None
        buffers.append(None if bytes_ is None else bytes_[:buffer["byteLength"]])
    return document, buffers


def named(file, uri):
    if uri.startswith("data:"):
        return base64.b64decode(uri.split(",", 1)[1])
    try:
        return (file.parent / urllib.parse.unquote(uri)).read_bytes()
    except OSError:
        return None


def plain(file):
    """The document with every reference to bytes as the bytes: bufferViews in place of their indices, pictures and buffers in place of URIs.
    What is referred to by nobody has no say."""
    document, buffers = load(file)
    document = copy.deepcopy(document)

    def bytes_of(view):
        buffer = buffers[view["buffer"]]
        begin = view.get("byteOffset", 0)
        return None if buffer is None else buffer[begin:begin + view["byteLength"]]

    for view in document.get("bufferViews", []):
        for part in [view, *view.get("extensions", {}).values()]:
            if isinstance(part, dict) and "buffer" in part:
                part["bytes"] = bytes_of(part)
                for key in ("buffer", "byteOffset"):
                    part.pop(key, None)
    views = document.pop("bufferViews", [])

    def resolve(value):
        if isinstance(value, dict):
            if isinstance(value.get("bufferView"), int):
                value["bufferView"] = views[value["bufferView"]]
            for child in value.values():
                resolve(child)
        elif isinstance(value, list):
            for child in value:
                resolve(child)

    resolve(document)
    for image in document.get("images", []):
        view, uri = image.pop("bufferView", None), image.pop("uri", None)
        image["bytes"] = view["bytes"] if view else named(file, uri) if uri else None
        image.pop("mimeType", None)
    document.pop("buffers", None)
    return document


# What a conversion of materials may change.
MATERIAL_PARTS = ("materials", "textures", "images", "samplers", "extensionsUsed", "extensionsRequired")


def without_materials(document):
    kept = {k: v for k, v in document.items() if k not in MATERIAL_PARTS}
    kept["materials"] = [{k: v for k, v in m.items() if k not in ("pbrMetallicRoughness", "extensions")} for m in document.get("materials", [])]
    return kept


def has_gone(before, now, where=""):
    """Where the first difference is; None if there is none."""
    if isinstance(before, dict) and isinstance(now, dict):
        for key in {**before, **now}:
            if key not in before or key not in now:
                return where + "/" + key
            found = has_gone(before[key], now[key], where + "/" + key)
            if found:
                return found
        return None
    if isinstance(before, list) and isinstance(now, list) and len(before) == len(now):
        return next((f for f in (has_gone(b, n, where + "/%d" % i) for i, (b, n) in enumerate(zip(before, now))) if f), None)
    return None if before == now and type(before) is type(now) else where or "/"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--etendue", default=str(ROOT / "build/release/etendue"))
    parser.add_argument("--corpus", type=pathlib.Path, default=ROOT.parent / "shared/corpus/gltf")
    parser.add_argument("--only", default="")
    options = parser.parse_args()
    files = sorted(f for f in options.corpus.rglob("*.gl*") if f.suffix in (".gltf", ".glb") and options.only in str(f))
    if not files:
        print("no corpus under %s: skipped" % options.corpus)
        return 77
    checked = refused = failures = 0

    def convert(file, out, *words):
        return subprocess.run([options.etendue, "convert", file, out, *words], capture_output=True, text=True)

    for number, file in enumerate(files):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            there = folder / "there" / ("out.gltf" if file.suffix == ".glb" else "out.glb")
            back, same = folder / "back" / ("out" + file.suffix), folder / "same" / file.name
            if convert(file, there).returncode != 0:
                refused += 1  # an invalid file, or one whose pictures are not there
                continue
            checked += 1
            before = plain(file)
            runs = [(there, convert(there, back), back)] if number % 4 == 0 else []
            runs.append((file, convert(file, same), same))
            text = file.read_bytes()
            pictures = sum(f.stat().st_size for f in file.parent.glob("*.*g"))
            if pictures < 2e6 and (b"pbrSpecularGlossiness" in text or (b'"materials"' in text and number % 8 == 0)):
                model = "metal-rough" if b"pbrSpecularGlossiness" in text else "spec-gloss"
                out = folder / model / ("out" + file.suffix)
                run = convert(file, out, "--materials", model)
                if run.returncode == 0:
                    gone = has_gone(without_materials(before), without_materials(plain(out)))
                    failures += gone is not None
                    if gone:
                        print("%s: --materials %s changes %s" % (file, model, gone))
            for source, run, out in [(file, None, there), *runs]:
                if run is not None and run.returncode != 0:
                    failures += 1
                    print("%s: %s" % (source, run.stderr))
                    continue
                gone = has_gone(before, plain(out))
                failures += gone is not None
                if gone:
                    print("%s: %s differs at %s" % (file, out.relative_to(folder), gone))
            if file.suffix == ".gltf" and same.read_bytes() != file.read_bytes().removeprefix(b"\xef\xbb\xbf"):
                failures += 1
                print("%s: the text of a .gltf does not keep its bytes" % file)
    print("%d assets kept all that they say, %d were refused, %d failures" % (checked, refused, failures))
    return 1 if failures or checked == 0 else 0


sys.exit(main())
