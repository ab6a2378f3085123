"""Walls: plain pieces around openings, stones or tiles in bond around openings, and the look of bricks."""

from modelling.pixels import clouds, hashed, mix, normal_png, png, smooth


def spans(x0, x1, y0, y1, openings):
    """What the openings (x0, x1, y0, y1) leave of the interval x0..x1 at heights y0..y1."""
    free = [(x0, x1)]
    for a, b, low, high in openings:
        if low < y1 and high > y0:
            free = [piece for p, q in free for piece in ((p, min(q, a)), (max(p, b), q)) if piece[1] - piece[0] > 1e-9]
    return free


def around(x0, x1, y0, y1, openings):
    """The rectangle without its openings, as rectangles (x0, x1, y0, y1): cut at the heights where an opening begins or ends."""
    heights = sorted({y0, y1, *(min(max(y, y0), y1) for o in openings for y in o[2:4])})
    return [(a, b, low, high) for low, high in zip(heights, heights[1:]) for a, b in spans(x0, x1, low, high, openings)]


def bonded(x0, x1, y0, y1, width, height, joint, openings=(), start=None):
    """Stones of width x height (joint included) in half bond around the openings, as rectangles without their joints."""
    stones = []
    start = x0 if start is None else start
    row, y = 0, y0
    while y < y1 - 0.13 * height:
        top = min(y + height, y1)
        for a, b in spans(x0, x1, y + joint, top - joint, openings):
            x = start - (0.5 * width if row % 2 else 0.0)
            while x < b:
                left, right = max(x, a), min(x + width, b)
                if right - left > 0.13 * width:
                    stones.append((left + joint / 2, right - joint / 2, y + joint / 2, top - joint / 2))
                x += width
        y += height
        row += 1
    return stones


BRICK_U, BRICK_V = 4, 8  # bricks in one tile of the texture
BRICK_SIZE = (4 * 0.225, 8 * 0.075)


def _brick(u, v):
    """Which brick, and how far the place is inside it (0 in the joint, 1 on the face)."""
    row = int(v * BRICK_V) % BRICK_V
    x = (u * BRICK_U + 0.5 * (row % 2)) % BRICK_U
    column = int(x)
    edge_u, edge_v = min(x - column, 1 - (x - column)) * 225, min(v * BRICK_V % 1.0, 1 - v * BRICK_V % 1.0) * 75
    return row, column, smooth(3.5, 8.5, min(edge_u, edge_v))


def brick_colour(size=128):
    def pixel(u, v):
        row, column, face = _brick(u, v)
        brick = mix((0.42, 0.20, 0.14), (0.66, 0.38, 0.27), hashed(column, row, 77))
        brick = mix(brick, (0.30, 0.17, 0.14), 0.5 * clouds(u, v, 16, 12, 3, 5))
        return mix((0.58, 0.55, 0.50), brick, face)

    return png(size, size, pixel)


def brick_normal(size=128):
    """Joints 8 mm deep, rough faces, each brick a little tilted."""

    def depth(u, v):
        row, column, face = _brick(u % 1.0, v % 1.0)
        tilt = 0.002 * (hashed(column, row, 78) - 0.5)
        return 0.008 * face + tilt * face + 0.0035 * clouds(u, v, 24, 16, 2, 9)

    return normal_png(size, size, depth, *BRICK_SIZE)
