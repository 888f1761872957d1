"""Triangle meshes with smooth normals. Counter-clockwise seen from outside, at most 65536 vertices."""
import math
from dataclasses import dataclass, field

from asset_maker.vectors import add, cross, dot, normalize, scale, subtract


@dataclass
class Shape:
    positions: list
    indices: list
    normals: list = field(default_factory=list)
    uvs: list = field(default_factory=list)


def quad(a, b, c, d, uvs=None):
    """A parallelogram's corners in counter-clockwise order, flat."""
    return Shape([a, b, c, d], [0, 1, 2, 0, 2, 3], uvs=list(uvs or []))


def merge(shapes):
    """Several flat shapes as one."""
    merged = Shape([], [])
    for shape in shapes:
        first = len(merged.positions)
        merged.positions += shape.positions
        merged.indices += [first + i for i in shape.indices]
    return merged


def _grid_indices(rows, columns):
    """Two triangles a cell of a grid of (rows + 1) x (columns + 1) vertices, row by row."""
    indices = []
    for row in range(rows):
        for column in range(columns):
            a = row * (columns + 1) + column
            b, c, d = a + 1, a + columns + 1, a + columns + 2
            indices += [a, c, b, b, c, d]
    return indices


def lathe(profile, columns):
    """Turns (radius, height) points, given from top to bottom with the outside on the right, about the y axis.

    Normals are those of the profile; a point given twice in a row makes a sharp edge. The pole triangles of zero area
    (radius 0) are left out.
    """
    rows = len(profile) - 1

    def profile_normal(i):
        before = profile[i - 1] if i > 0 and profile[i - 1] != profile[i] else profile[i]
        after = profile[i + 1] if i < rows and profile[i + 1] != profile[i] else profile[i]
        dr, dh = after[0] - before[0], after[1] - before[1]
        length = math.hypot(dr, dh)
        return -dh / length, dr / length

    positions, normals = [], []
    for i, (radius, height) in enumerate(profile):
        nr, nh = profile_normal(i)
        for column in range(columns + 1):
            angle = 2 * math.pi * (column % columns) / columns
            s, c = math.sin(angle), math.cos(angle)
            positions.append((radius * s, height, radius * c))
            normals.append((nr * s, nh, nr * c))
    indices = _grid_indices(rows, columns)
    triangles = [indices[i:i + 3] for i in range(0, len(indices), 3)]
    kept = [t for t in triangles if len({positions[i] for i in t}) == 3]
    return Shape(positions, [i for t in kept for i in t], normals)


def sphere(radius, rows, columns):
    points = [(radius * math.sin(math.pi * i / rows), radius * math.cos(math.pi * i / rows)) for i in range(rows + 1)]
    points[0], points[-1] = (0.0, radius), (0.0, -radius)
    shape = lathe(points, columns)
    shape.normals = [scale(p, 1 / radius) for p in shape.positions]
    return shape


def tube(curve, radius, rows, columns):
    """A closed tube about `curve`, a function of [0, 1) with period 1."""
    positions, normals = [], []
    for i in range(rows + 1):
        t = (i % rows) / rows
        step = 0.25 / rows
        tangent = normalize(subtract(curve(t + step), curve(t - step)))
        # Towards the y axis, made perpendicular to the tangent: smooth and periodic where the curve does not meet the axis.
        x, _, z = curve(t)
        inward = (-x, 0.0, -z)
        u = normalize(subtract(inward, scale(tangent, dot(tangent, inward))))
        v = cross(tangent, u)
        for column in range(columns + 1):
            angle = 2 * math.pi * (column % columns) / columns
            normal = add(scale(u, math.cos(angle)), scale(v, math.sin(angle)))
            normals.append(normal)
            positions.append(add(curve(t), scale(normal, radius)))
    indices = _grid_indices(rows, columns)
    return Shape(positions, [indices[i + j] for i in range(0, len(indices), 3) for j in (0, 2, 1)], normals)


def rounded_box(half, radius, steps):
    """A box of half extents `half` with edges of `radius`, each rounded in `steps` segments."""
    sphere_directions, indices = _cube_sphere(steps)
    core = tuple(h - radius for h in half)
    positions = [tuple(math.copysign(c, corner) + n * radius for c, corner, n in zip(core, side, direction))
                 for direction, side in sphere_directions]
    return Shape(positions, indices, [direction for direction, _ in sphere_directions])


def _cube_sphere(steps):
    """Directions over six faces, each of 2 x 2 quarters that belong to one corner of the box, and their triangles."""
    samples = [(math.tan(math.pi / 4 * (i / steps - 1)), -1.0) for i in range(steps + 1)]
    samples += [(math.tan(math.pi / 4 * i / steps), 1.0) for i in range(steps + 1)]
    directions, indices = [], []
    size = len(samples) - 1
    for axis in range(3):
        for sign in (1.0, -1.0):
            first = len(directions)
            for s, s_side in samples:
                for t, t_side in samples:
                    point, side = [0.0] * 3, [0.0] * 3
                    point[axis], side[axis] = sign, sign
                    point[(axis + 1) % 3], side[(axis + 1) % 3] = s, s_side
                    point[(axis + 2) % 3], side[(axis + 2) % 3] = t, t_side
                    directions.append((normalize(point), side))
            face = _grid_indices(size, size)
            if sign < 0:
                face = [face[i + j] for i in range(0, len(face), 3) for j in (0, 2, 1)]
            # Row is s (axis + 1), column is t (axis + 2): (row, column, +axis) is right-handed.
            indices += [first + i for i in face]
    return directions, indices
