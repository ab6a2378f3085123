"""glTF files with one to three defects each, made from others by a seeded generator: members removed, types changed, numbers extreme, bytes
flipped, added and cut off."""
import json
import pathlib
import random
import shutil
import struct

NUMBERS = [-1, 0, 1, 2, 3, 4, 5, 255, 256, 65535, 65536, 2**31 - 1, 2**31, 2**32 - 1, 2**32, 2**53 - 1, 2**53, 2**63, 2**64, 10**30, -2**31, 0.5, -0.5,
           1e-300, 1e300, -1e300, 3.4e38, 5120, 5121, 5123, 5125, 5126, 34962, 34963]
VALUES = [None, True, False, "", "x", "../up.bin", "%2e%2e/up.bin", "/etc/hostname", "http://example.com/a.bin", "data:,", "data:;base64,A",
          "data:application/octet-stream;base64,AAAA", [], {}, [0], [[]], {"a": 0}, "SCALAR", "VEC3", "MAT4", [1, 2, 3], [0, 0, 0, 1]]


def members(value, path=()):
    """Every place in a document."""
    if path:
        yield path
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, one in items:
        yield from members(one, (*path, key))


def parent_of(document, path):
    for key in path[:-1]:
        document = document[key]
    return document


def damage_document(document, rng):
    places = list(members(document))
    if not places:
        return
    path = rng.choice(places)
    parent, key = parent_of(document, path), path[-1]
    value = parent[key]
    kind = rng.randrange(8)
    if kind == 0:
        del parent[key]
    elif kind == 1:
        parent[key] = rng.choice(VALUES)
    elif kind == 2 and isinstance(value, (int, float)) and not isinstance(value, bool):
        parent[key] = value + rng.choice([-1, 1, -value, value, 4, 0.5, 100])
    elif kind == 3 and isinstance(parent, list):
        parent.append(json.loads(json.dumps(value)))
    elif kind == 4 and isinstance(parent, dict):
        parent[str(key) + rng.choice(["", "_", "0"])] = parent.pop(key)
    elif kind == 5 and isinstance(value, (dict, list)):
        value.clear()
    elif kind == 6:
        other = rng.choice(places)
        try:
            parent[key] = json.loads(json.dumps(parent_of(document, other)[other[-1]]))
        except (KeyError, IndexError):
            pass
    else:
        parent[key] = rng.choice(NUMBERS)


def damage_bytes(data, rng):
    if not data:
        return b"\0"
    at = rng.randrange(len(data))
    kind = rng.randrange(6)
    if kind == 0:
        return data[:at] + bytes([rng.randrange(256)]) + data[at + 1:]
    if kind == 1:
        return data[:at] + bytes([data[at] ^ 1 << rng.randrange(8)]) + data[at + 1:]
    if kind == 2:
        return data[:at] + data[at + rng.randrange(1, 9):]
    if kind == 3:
        return data[:at] + bytes(rng.randrange(256) for _ in range(rng.randrange(1, 9))) + data[at:]
    if kind == 4:
        return data[:at]
    start = rng.randrange(min(len(data), 32))  # a header
    return data[:start] + struct.pack("<I", rng.choice([0, 1, 3, 4, len(data), len(data) + 1, 2**31, 2**32 - 1])) + data[start + 4:]


def chunks_of(data):
    """The JSON of a GLB and what follows it; None where it is no GLB."""
    if len(data) < 20 or data[:4] != b"glTF" or data[16:20] != b"JSON":
        return None
    length = struct.unpack_from("<I", data, 12)[0]
    return (data[20:20 + length], data[20 + length:]) if 20 + length <= len(data) else None


def wrapped(text, rest):
    text += b" " * (-len(text) % 4)
    return b"glTF" + struct.pack("<II", 2, 20 + len(text) + len(rest)) + struct.pack("<I", len(text)) + b"JSON" + text + rest


def mutated(data, rng):
    for _ in range(rng.randrange(1, 4)):
        parts = chunks_of(data)
        text = parts[0] if parts else data
        try:
            document = json.loads(text.decode("utf-8")) if rng.randrange(4) else None
        except (ValueError, RecursionError):
            document = None
        if not isinstance(document, dict):
            data = damage_bytes(data, rng)
            continue
        damage_document(document, rng)
        text = json.dumps(document, indent=rng.choice([None, 1])).encode()
        data = wrapped(text, parts[1]) if parts else text
    return data


def write(sources, folder, count, seed):
    """`count` files below `folder`, each beside copies of what its source may name. Returns their paths."""
    rng = random.Random(seed)
    homes, made = {}, []
    for number in range(count):
        source = rng.choice(sources)
        if source.parent not in homes:
            home = pathlib.Path(folder) / ("%03d" % len(homes))
            home.mkdir(parents=True)
            for neighbour in source.parent.iterdir():
                if neighbour.is_file() and neighbour.suffix not in (".gltf", ".glb", ".json"):
                    shutil.copy(neighbour, home)
            homes[source.parent] = home
        file = homes[source.parent] / ("%05d%s" % (number, source.suffix))
        file.write_bytes(mutated(source.read_bytes(), rng))
        made.append(file)
    return made
