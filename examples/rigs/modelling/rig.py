"""The text of a rig file: one line for what fits on one, vectors never broken."""

import json
import math

from modelling.mesh import dot, frame

WIDTH = 150


def text_of(value, indent=0):
    flat = json.dumps(value)
    if len(flat) + indent <= WIDTH and indent > 2 or not isinstance(value, (dict, list)) or not value:
        return flat
    pad = " " * (indent + 2)
    if isinstance(value, dict):
        rows = [f"{pad}{json.dumps(key)}: {text_of(item, indent + 2)}" for key, item in value.items()]
        opening, closing = "{}"
    else:
        rows = [pad + text_of(item, indent + 2) for item in value]
        opening, closing = "[]"
    return opening + "\n" + ",\n".join(rows) + "\n" + " " * indent + closing


def rig_file(lights, camera, objects, materials=()):
    rig = {"etendue": 1, "lights": lights, "camera": camera}
    if materials:
        rig["materials"] = list(materials)
    rig["objects"] = objects
    return (text_of(rig) + "\n").encode()


DOWN = [-0.7071068, 0, 0, 0.7071068]  # quaternions that turn -Z to -Y and to +Z
TOWARDS_VIEWER = [0, 1, 0, 0]


def aimed(position, target):
    """The quaternion (x, y, z, w) that turns -Z towards the target and keeps X level."""
    right, up, back = frame(position, target)
    # Columns right, up, back of a rotation matrix to a quaternion: the largest component first (Shepperd 1978).
    m = [[right[i], up[i], back[i]] for i in range(3)]
    trace = m[0][0] + m[1][1] + m[2][2]
    squares = [1 + 2 * m[i][i] - trace for i in range(3)] + [1 + trace]
    k = max(range(4), key=lambda i: squares[i])
    q = [0.0] * 4
    q[k] = math.sqrt(squares[k]) / 2
    for i in range(3):
        j, l = (i + 1) % 3, (i + 2) % 3
        if k == 3:
            q[i] = (m[l][j] - m[j][l]) / (4 * q[3])
        elif k == i:
            q[3] = (m[l][j] - m[j][l]) / (4 * q[i])
            q[j] = (m[j][i] + m[i][j]) / (4 * q[i])
            q[l] = (m[l][i] + m[i][l]) / (4 * q[i])
    assert abs(dot(q, q) - 1) < 1e-9
    return [round(x, 7) + 0.0 for x in q]
