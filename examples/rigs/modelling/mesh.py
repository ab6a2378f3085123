"""Indexed triangles with normals and texture coordinates, and the rigid motions that place them. Metres, +Y up."""

import math


class Mesh:
    def __init__(self):
        self.positions, self.normals, self.uvs, self.indices = [], [], [], []

    def vertex(self, position, normal, uv=(0.0, 0.0)):
        self.positions.append(position)
        self.normals.append(normal)
        self.uvs.append(uv)
        return len(self.positions) - 1

    def triangle(self, a, b, c):
        """Counter-clockwise seen from the front; triangles without area are left out."""
        p, q, r = (self.positions[i] for i in (a, b, c))
        if length(cross(sub(q, p), sub(r, p))) > 1e-12:
            self.indices += [a, b, c]

    def quad(self, a, b, c, d):
        self.triangle(a, b, c)
        self.triangle(a, c, d)

    def add(self, *others):
        for other in others:
            base = len(self.positions)
            self.positions += other.positions
            self.normals += other.normals
            self.uvs += other.uvs
            self.indices += [base + i for i in other.indices]
        return self

    def mapped(self, point, direction):
        result = Mesh()
        result.positions = [point(p) for p in self.positions]
        result.normals = [direction(n) for n in self.normals]
        result.uvs, result.indices = list(self.uvs), list(self.indices)
        return result

    def at(self, x, y, z):
        return self.mapped(lambda p: (p[0] + x, p[1] + y, p[2] + z), lambda n: n)

    def turned(self, axis, degrees):
        """Rotated counter-clockwise about an axis ("x", "y", "z") through the origin."""
        c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        turn = {
            "x": lambda p: (p[0], c * p[1] - s * p[2], s * p[1] + c * p[2]),
            "y": lambda p: (c * p[0] + s * p[2], p[1], c * p[2] - s * p[0]),
            "z": lambda p: (c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]),
        }[axis]
        return self.mapped(turn, turn)

    def stretched(self, x, y, z):
        """Scaled along the axes; normals by the inverse scale."""
        return self.mapped(lambda p: (p[0] * x, p[1] * y, p[2] * z), lambda n: unit((n[0] / x, n[1] / y, n[2] / z)))

    def textured_from(self, axis, metres_u, metres_v):
        """Texture coordinates by projection along an axis; one tile of the texture covers metres_u x metres_v."""
        u, v = {"x": (2, 1), "y": (0, 2), "z": (0, 1)}[axis]
        flip = {"x": -1.0, "y": 1.0, "z": -1.0}[axis]  # v grows downwards in an image
        self.uvs = [(p[u] / metres_u, flip * p[v] / metres_v) for p in self.positions]
        return self


def merged(*meshes):
    return Mesh().add(*meshes)


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def plus(a, b, t=1.0):
    return (a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2])


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def length(a):
    return math.sqrt(dot(a, a))


def unit(a):
    size = length(a)
    return tuple(x / size for x in a) if size > 0 else tuple(0.0 for _ in a)


def frame(position, target):
    """Right, up and back of something at `position` whose -Z points to the target, with X level."""
    back = unit(sub(position, target))
    right = unit(cross((0.0, 1.0, 0.0), back))
    return right, cross(back, right), back


def aimed_mesh(mesh, position, target):
    """A mesh modelled around the origin, facing -Z, placed like a light that is aimed at the target."""
    right, up, back = frame(position, target)

    def turn(p):
        return tuple(right[i] * p[0] + up[i] * p[1] + back[i] * p[2] for i in range(3))

    return mesh.mapped(lambda p: plus(position, turn(p)), turn)
