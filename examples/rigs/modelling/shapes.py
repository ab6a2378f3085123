"""Solids: bevelled boxes, surfaces of revolution, swept tubes, extrusions, and surfaces given by a function."""

import math

from modelling.mesh import Mesh, cross, dot, plus, sub, unit


def block(x0, x1, y0, y1, z0, z1, bevel=0.002, back=True):
    """A box between two corners. Its edges are cut at 45 degrees and shaded as round: each face keeps its own normal up to
    the cut, and the cut interpolates between the two faces, which is where a real edge catches the light. back=False leaves out what lies in the plane z0."""
    mesh = Mesh()
    low, high = (x0, y0, z0), (x1, y1, z1)
    bevel = min(bevel, *(0.49 * (b - a) for a, b in zip(low, high)))
    corner = {}
    for signs in [(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)]:
        for axis in range(3):
            point = [high[a] if s else low[a] for a, s in enumerate(signs)]
            for other in range(3):
                if other != axis:
                    point[other] += -bevel if signs[other] else bevel
            normal = tuple((1.0 if signs[a] else -1.0) if a == axis else 0.0 for a in range(3))
            u, v = {0: (2, 1), 1: (0, 2), 2: (0, 1)}[axis]
            corner[signs, axis] = mesh.vertex(tuple(point), normal, (point[u], -point[v]))

    def face(vertices, outward):
        if not back and outward[2] < 0:
            return
        p = [mesh.positions[i] for i in vertices[:3]]
        if dot(cross(sub(p[1], p[0]), sub(p[2], p[0])), outward) < 0:
            vertices = vertices[::-1]
        (mesh.quad if len(vertices) == 4 else mesh.triangle)(*vertices)

    def signs_of(fixed):
        return tuple(fixed[a] for a in range(3))

    for axis in range(3):
        a, b = (axis + 1) % 3, (axis + 2) % 3
        for s in (0, 1):
            ring = [corner[signs_of({axis: s, a: i, b: j}), axis] for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))]
            face(ring, mesh.normals[ring[0]])
            for t in (0, 1) if bevel > 0 else ():
                ends = [signs_of({a: s, b: t, axis: i}) for i in (0, 1)]
                strip = [corner[ends[0], a], corner[ends[1], a], corner[ends[1], b], corner[ends[0], b]]
                face(strip, plus(mesh.normals[strip[0]], mesh.normals[strip[2]]))
    if bevel > 0:
        for signs in [(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)]:
            face([corner[signs, axis] for axis in range(3)], tuple(2.0 * s - 1.0 for s in signs))
    return mesh


def box(width, height, depth, bevel=0.002):
    """Centred in x and z, standing on y = 0."""
    return block(-width / 2, width / 2, 0.0, height, -depth / 2, depth / 2, bevel)


def spline(points, steps=6):
    """A Catmull-Rom curve through the points (2D or 3D), `steps` segments between neighbours."""
    out = []
    for i in range(len(points) - 1):
        p0, p1, p2, p3 = points[max(i - 1, 0)], points[i], points[i + 1], points[min(i + 2, len(points) - 1)]
        for k in range(steps):
            t = k / steps
            out.append(
                tuple(
                    0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t * t + (3 * b - a - 3 * c + d) * t**3)
                    for a, b, c, d in zip(p0, p1, p2, p3)
                )
            )
    return out + [tuple(points[-1])]


def arc(centre, radius, start, end, steps=6):
    """Points of a circle in the plane, angles in degrees, counter-clockwise if end > start."""
    angles = [math.radians(start + (end - start) * k / steps) for k in range(steps + 1)]
    return [(centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a)) for a in angles]


def _polyline_normals(points, closed, crease_deg):
    """For each segment of a plane polyline its right-hand normals at both ends, averaged across bends below the crease."""
    count = len(points) - (0 if closed else 1)
    segment = []
    for i in range(count):
        (x0, y0), (x1, y1) = points[i], points[(i + 1) % len(points)]
        size = math.hypot(x1 - x0, y1 - y0) or 1.0
        segment.append(((y1 - y0) / size, (x0 - x1) / size))
    limit = math.cos(math.radians(crease_deg))

    def joined(i, j):
        if not closed and not 0 <= j < count:
            return segment[i]
        a, b = segment[i], segment[j % count]
        if a[0] * b[0] + a[1] * b[1] < limit:
            return a
        size = math.hypot(a[0] + b[0], a[1] + b[1])
        return ((a[0] + b[0]) / size, (a[1] + b[1]) / size)

    return [(joined(i, i - 1), joined(i, i + 1)) for i in range(count)]


def revolve(profile, segments=32, crease=38.0, sides=None):
    """The profile (radius, height), its outside on the right as it is walked, turned about the y axis. `sides` leaves flat
    facets instead of a circle (an octagonal pot). Texture: u once around, v along the profile from its end."""
    mesh = Mesh()
    normals = _polyline_normals(profile, False, crease)
    steps = [math.dist(profile[i], profile[i + 1]) for i in range(len(profile) - 1)]
    total, walked = sum(steps), 0.0
    count = sides or segments
    for (start, end), (n0, n1), step in zip(zip(profile, profile[1:]), normals, steps):
        rings = []
        for (radius, height), (nr, ny), along in ((start, n0, walked), (end, n1, walked + step)):
            ring = []
            for k in range(count + 1):
                turns = [(k, k)] if not sides else [(k, k - 0.5), (k, k + 0.5)]
                for place, facing in turns:
                    a, f = 2 * math.pi * place / count, 2 * math.pi * facing / count
                    ring.append(
                        mesh.vertex(
                            (radius * math.sin(a), height, radius * math.cos(a)),
                            (nr * math.sin(f), ny, nr * math.cos(f)),
                            (k / count, 1.0 - along / total),
                        )
                    )
            rings.append(ring)
        pairs = range(count) if not sides else range(1, 2 * count, 2)
        for k in pairs:
            mesh.quad(rings[0][k], rings[0][k + 1], rings[1][k + 1], rings[1][k])
        walked += step
    return mesh


def cylinder(radius, height, segments=24, bevel=0.001):
    """Standing on y = 0, with bevelled rims."""
    bevel = min(bevel, 0.45 * height, 0.45 * radius)
    return revolve(
        [(0, 0), (radius - bevel, 0), (radius, bevel), (radius, height - bevel), (radius - bevel, height), (0, height)], segments, crease=50.0
    )


def ball(radius, segments=24, rings=12):
    return revolve(arc((0, 0), radius, -90, 90, rings), segments)


def tube(path, radius, segments=10, closed=False):
    """A round tube along a path of points; the radius may be a list. The frame is carried along without twist."""
    mesh = Mesh()
    count = len(path)
    radii = radius if isinstance(radius, list) else [radius] * count
    tangents = []
    for i in range(count):
        before, after = (path[i - 1], path[(i + 1) % count]) if closed else (path[max(i - 1, 0)], path[min(i + 1, count - 1)])
        tangents.append(unit(sub(after, before)))
    side = unit(cross(tangents[0], (0.0, 1.0, 0.0) if abs(tangents[0][1]) < 0.9 else (1.0, 0.0, 0.0)))
    rings = []
    for point, tangent, r in zip(path, tangents, radii):
        side = unit(plus(side, tangent, -dot(side, tangent)))
        up = cross(side, tangent)
        ring = []
        for k in range(segments + 1):
            a = 2 * math.pi * k / segments
            normal = plus(tuple(math.cos(a) * s for s in side), up, math.sin(a))
            ring.append(mesh.vertex(plus(point, normal, r), normal, (k / segments, 0.0)))
        rings.append(ring)
    for first, second in zip(rings, rings[1:] + (rings[:1] if closed else [])):
        for k in range(segments):
            mesh.quad(first[k + 1], first[k], second[k], second[k + 1])
    if not closed:
        for ring, point, tangent, sign in ((rings[0], path[0], tangents[0], -1.0), (rings[-1], path[-1], tangents[-1], 1.0)):
            normal = tuple(sign * t for t in tangent)
            centre = mesh.vertex(point, normal)
            rim = [mesh.vertex(mesh.positions[i], normal) for i in ring]
            for k in range(segments):
                mesh.triangle(centre, rim[k], rim[k + 1]) if sign < 0 else mesh.triangle(centre, rim[k + 1], rim[k])
    return mesh


def rounded(width, height, radius, steps=4):
    """The outline of a rounded rectangle, counter-clockwise, centred."""
    x, y = width / 2 - radius, height / 2 - radius
    out = []
    for centre, start in (((x, -y), -90), ((x, y), 0), ((-x, y), 90), ((-x, -y), 180)):
        out += arc(centre, radius, start, start + 90, steps)
    return out


def _ears(outline):
    """Triangles of a simple counter-clockwise polygon, by cutting ears."""

    def area(a, b, c):
        return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])

    left, out = list(range(len(outline))), []
    while len(left) > 3:
        for k, i in enumerate(left):
            h, j = left[k - 1], left[(k + 1) % len(left)]
            a, b, c = outline[h], outline[i], outline[j]
            if area(a, b, c) <= 1e-14:
                continue
            if any(
                area(a, b, p) >= 0 and area(b, c, p) >= 0 and area(c, a, p) >= 0
                for p in (outline[m] for m in left if m not in (h, i, j))
                if p not in (a, b, c)
            ):
                continue
            out.append((h, i, j))
            left.pop(k)
            break
        else:
            left.pop(0)  # only slivers remain
    return out + [tuple(left)]


def extrude(outline, depth, bevel=0.0, crease=35.0):
    """A counter-clockwise outline in XY as a slab centred on z = 0, its two rims bevelled."""
    mesh = Mesh()
    normals = _polyline_normals(outline, True, crease)
    count, half = len(outline), depth / 2
    inner = []
    for i in range(count):  # offset of a corner so that both its edges move in by `bevel`
        (ax, ay), (bx, by) = _edge_normal(outline, i - 1), _edge_normal(outline, i)
        scale = bevel / max(1.0 + ax * bx + ay * by, 0.2)
        inner.append((outline[i][0] - scale * (ax + bx), outline[i][1] - scale * (ay + by)))
    for sign in (1.0, -1.0):
        cap = [mesh.vertex((x, y, sign * half), (0.0, 0.0, sign), (x, -y)) for x, y in inner]
        for a, b, c in _ears(inner):
            mesh.triangle(cap[a], cap[b], cap[c]) if sign > 0 else mesh.triangle(cap[c], cap[b], cap[a])
    for i in range(count):
        j = (i + 1) % count
        wall = []
        for z in (-half + bevel, half - bevel):
            for k, n in ((i, normals[i][0]), (j, normals[i][1])):
                wall.append(mesh.vertex((*outline[k], z), (*n, 0.0), (outline[k][0], -outline[k][1])))
        mesh.quad(wall[0], wall[1], wall[3], wall[2])
        if bevel > 0:
            for sign, (a, b) in ((1.0, (wall[2], wall[3])), (-1.0, (wall[1], wall[0]))):
                ends = (j, i) if sign > 0 else (i, j)
                c, d = (mesh.vertex((*inner[k], sign * half), (0.0, 0.0, sign)) for k in ends)
                mesh.quad(a, b, c, d)
    return mesh


def _edge_normal(outline, i):
    (x0, y0), (x1, y1) = outline[i], outline[(i + 1) % len(outline)]
    size = math.hypot(x1 - x0, y1 - y0)
    return ((y1 - y0) / size, (x0 - x1) / size)


def surface(point, across, along):
    """A patch point(u, v), u and v in 0..1, front where d/du x d/dv points; normals by central differences."""
    mesh = Mesh()
    step = 1e-4
    grid = []
    for j in range(along + 1):
        row = []
        for i in range(across + 1):
            u, v = i / across, j / along
            du = sub(point(min(u + step, 1.0), v), point(max(u - step, 0.0), v))
            dv = sub(point(u, min(v + step, 1.0)), point(u, max(v - step, 0.0)))
            row.append(mesh.vertex(point(u, v), unit(cross(du, dv)), (u, 1.0 - v)))
        grid.append(row)
    for j in range(along):
        for i in range(across):
            mesh.quad(grid[j][i], grid[j][i + 1], grid[j + 1][i + 1], grid[j + 1][i])
    return mesh
