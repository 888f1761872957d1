#!/usr/bin/env python3
"""Writes a night landscape lit by 100,000 small emissive triangles, always the same bytes: docs/lights.md measures it.

usage: scripts/make_many_lights.py FILE.glb [TRIANGLES]
"""
import math
import pathlib
import random
import sys

from asset_maker.gltf import Gltf
from asset_maker.shapes import Shape
from asset_maker.vectors import cross, normalize

SIDE = 100.0  # metres
COLORS = [(1.0, 0.55, 0.2), (1.0, 0.8, 0.5), (0.5, 0.7, 1.0), (0.2, 1.0, 0.4), (1.0, 0.15, 0.3), (0.6, 0.3, 1.0),
          (1.0, 1.0, 1.0), (0.1, 0.8, 1.0)]
CELLS = 150


def height(x, z):
    return 2.5 * math.sin(0.11 * x + 0.5) * math.cos(0.09 * z) + 0.8 * math.sin(0.31 * x + 0.17 * z)


def ground():
    positions = []
    for j in range(CELLS + 1):
        for i in range(CELLS + 1):
            x, z = SIDE * (i / CELLS - 0.5), SIDE * (j / CELLS - 0.5)
            positions.append((x, height(x, z), z))
    indices = []
    for j in range(CELLS):
        for i in range(CELLS):
            a = j * (CELLS + 1) + i
            b = a + CELLS + 1
            indices += [a, b, a + 1, a + 1, b, b + 1]
    return Shape(positions, indices)


def lamp(rng, center):
    """A triangle of a few millimetres whose front looks down: a camera above sees its dark back."""
    tilt, turn, size = rng.uniform(0, 0.02), rng.uniform(0, 2 * math.pi), rng.uniform(0.002, 0.008)
    down = (math.sin(tilt) * math.cos(turn), -math.cos(tilt), math.sin(tilt) * math.sin(turn))
    right = normalize(cross(down, (1.0, 0.0, 0.0)))
    up = cross(down, right)
    angles = [rng.uniform(0, 2 * math.pi / 3) + k * 2 * math.pi / 3 for k in range(3)]
    return [tuple(c + size * (math.cos(a) * r + math.sin(a) * u) for c, r, u in zip(center, right, up)) for a in angles]


def lamps(rng, count, clumps):
    positions = []
    for _ in range(count):
        x, z, spread = rng.choice(clumps)
        x = min(max(rng.gauss(x, spread), -0.49 * SIDE), 0.49 * SIDE)
        z = min(max(rng.gauss(z, spread), -0.49 * SIDE), 0.49 * SIDE)
        center = (x, height(x, z) + min(2 + rng.expovariate(1 / 0.6), 5), z)
        positions += lamp(rng, center)
    return Shape(positions, list(range(3 * count)))


def scene(triangles):
    rng = random.Random(54)
    gltf = Gltf("A landscape of many lamps")
    gltf.node(gltf.mesh("ground", gltf.shape(ground()), gltf.lambert("ground", (0.5, 0.5, 0.5))), name="ground")
    block = gltf.lambert("block", (0.7, 0.65, 0.6))
    for i in range(40):
        x, z = rng.uniform(-45, 45), rng.uniform(-45, 45)
        y, w, h = height(x, z) - 1, rng.uniform(0.3, 1.2), rng.uniform(1.3, 2)
        corners = [(x + w * a, y + h * b, z + w * c) for b in (0, 1) for a, c in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        faces = [(0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0), (4, 7, 6, 5)]
        positions = [corners[k] for face in faces for k in face]
        indices = [4 * f + k for f in range(5) for k in (0, 1, 2, 0, 2, 3)]
        gltf.node(gltf.mesh(f"block {i}", gltf.shape(Shape(positions, indices)), block))
    clumps = [(rng.uniform(-45, 45), rng.uniform(-45, 45), rng.uniform(0.5, 12)) for _ in range(120)]
    groups = 4 * len(COLORS)
    primitives = []  # of one mesh, so that one BVH holds all lamps
    for i in range(groups):
        strength = 1000.0 * 10.0 ** rng.uniform(-1.5, 1.0)
        radiance = tuple(strength * c for c in COLORS[i % len(COLORS)])
        count = triangles * (i + 1) // groups - triangles * i // groups
        if count == 0:
            continue
        shape = gltf.shape(lamps(rng, count, clumps))
        primitives.append({**shape, "material": gltf.emitter(f"lamp {i}", radiance)})
    mesh = gltf.mesh("lamps", {}, 0)
    gltf.json["meshes"][mesh]["primitives"] = primitives
    gltf.node(mesh, name="lamps")
    gltf.camera("view", (0.0, 9.0, 40.0), (0.0, 0.0, 0.0), math.radians(50.0), 16 / 9)
    return gltf


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    scene(int(sys.argv[2]) if len(sys.argv) > 2 else 100000).write_glb(pathlib.Path(sys.argv[1]))


if __name__ == "__main__":
    main()
