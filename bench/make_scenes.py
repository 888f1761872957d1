#!/usr/bin/env python3
"""Writes the procedural scenes of the benchmarks: one room of rough ground and walls, stones and leaves, at three sizes.

The shapes are the same at every size, only finer and more: cost per ray then shows how traversal grows with the
triangle count. Equal arguments give equal files.
"""
import argparse
import array
import json
import math
import pathlib
import random
import struct

HALF, HEIGHT = 5.0, 5.0  # of the room, in metres


class Triangles:
    def __init__(self):
        self.positions = array.array("f")
        self.indices = array.array("I")

    def grid(self, rows, columns, point, wrap=False):
        """(rows + 1) x (columns + 1) points of a surface; with `wrap` the last column is the first."""
        first = len(self.positions) // 3
        stride = columns if wrap else columns + 1
        for r in range(rows + 1):
            for c in range(stride):
                self.positions.extend(point(r / rows, c / columns))
        for r in range(rows):
            for c in range(columns):
                a = first + r * stride + c
                b = first + r * stride + (c + 1) % stride
                self.indices.extend((a, b, a + stride, b, b + stride, a + stride))

    def triangle(self, *corners):
        first = len(self.positions) // 3
        for corner in corners:
            self.positions.extend(corner)
        self.indices.extend((first, first + 1, first + 2))


def waves(u, v):
    return 0.25 * math.sin(5 * u + 1) * math.cos(4 * v) + 0.06 * math.sin(23 * u + 2 * v) * math.sin(19 * v)


def ground(x, z):
    return 0.8 * waves(x / 2, z / 2)


def add_room(triangles, count):
    side = max(2, round(math.sqrt(count / 12)))  # six surfaces of 2 side^2 triangles
    span = lambda t: HALF * (2 * t - 1)
    triangles.grid(side, side, lambda r, c: (span(c), ground(span(c), span(r)), span(r)))
    triangles.grid(side, side, lambda r, c: (span(r), HEIGHT + 0.3 * waves(span(c), span(r)), span(c)))
    for sign in (-1, 1):
        triangles.grid(side, side, lambda r, c: (sign * (HALF - 0.3 * waves(span(c), 7 * r)), HEIGHT * (1.2 * r - 0.1), span(c)))
        triangles.grid(side, side, lambda r, c: (span(c), HEIGHT * (1.2 * r - 0.1), sign * (HALF - 0.3 * waves(9 * r, span(c)))))


def add_stones(triangles, count, rng):
    rows = max(6, round((count / 160) ** 0.5 / 2))
    for _ in range(max(1, count // (4 * rows * rows))):
        x, z, radius = rng.uniform(-4.5, 4.5), rng.uniform(-4.5, 4.5), rng.uniform(0.1, 0.4)
        y, phase, bumps = ground(x, z) + 0.6 * radius, rng.uniform(0, 6), rng.randint(3, 9)

        def point(r, c):
            theta, phi = math.pi * r, 2 * math.pi * c
            size = radius * (1 + 0.15 * math.sin(bumps * theta + phase) * math.sin(bumps * phi))
            sine = max(math.sin(theta), 1e-3)
            return x + size * sine * math.cos(phi), y + size * math.cos(theta), z + size * sine * math.sin(phi)

        triangles.grid(rows, 2 * rows, point, wrap=True)


def add_leaves(triangles, count, rng):
    """Small triangles at random around points in the air: much overlap, no order."""
    size = 1.5 * count ** (-1 / 3)
    centers = [(rng.uniform(-4, 4), rng.uniform(1.5, 4), rng.uniform(-4, 4)) for _ in range(24)]
    for i in range(count):
        center = centers[i % len(centers)]
        start = [x + rng.gauss(0, 0.6) for x in center]
        triangles.triangle(start, *([x + rng.uniform(-size, size) for x in start] for _ in range(2)))


def scene(count):
    rng = random.Random(count)
    surfaces = Triangles()
    add_room(surfaces, round(0.4 * count))
    add_stones(surfaces, round(0.4 * count), rng)
    leaves = Triangles()
    add_leaves(leaves, count - len(surfaces.indices) // 3, rng)
    lamp = Triangles()
    y = HEIGHT - 0.6
    lamp.triangle((-1, y, -1), (1, y, -1), (1, y, 1))
    lamp.triangle((-1, y, -1), (1, y, 1), (-1, y, 1))
    return [surfaces, leaves, lamp]


def write_glb(path, parts):
    data, views, accessors, primitives = bytearray(), [], [], []

    def accessor(values, kind, component, count, **extra):
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(values) * values.itemsize})
        data.extend(values.tobytes())
        accessors.append({"bufferView": len(views) - 1, "componentType": component, "count": count, "type": kind, **extra})
        return len(accessors) - 1

    for material, part in enumerate(parts):
        columns = [part.positions[axis::3] for axis in range(3)]
        position = accessor(part.positions, "VEC3", 5126, len(part.positions) // 3,
                            min=[min(c) for c in columns], max=[max(c) for c in columns])
        index = accessor(part.indices, "SCALAR", 5125, len(part.indices))
        primitives.append({"attributes": {"POSITION": position}, "indices": index, "material": material})

    def diffuse(color, **extra):
        return {"pbrMetallicRoughness": {"baseColorFactor": [*color, 1], "metallicFactor": 0, "roughnessFactor": 0.6},
                "doubleSided": True, **extra}

    document = {
        "asset": {"version": "2.0", "generator": "Isophote bench/make_scenes.py"},
        "extensionsUsed": ["KHR_materials_emissive_strength"],
        "scene": 0, "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0.3, 2.2, 4.2], "rotation": [-0.1, 0, 0, 0.995]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 1.1, "znear": 0.01}}],
        "meshes": [{"primitives": primitives}],
        "materials": [diffuse((0.7, 0.65, 0.6)), diffuse((0.3, 0.6, 0.2)),
                      diffuse((0, 0, 0), emissiveFactor=[1, 0.95, 0.9],
                              extensions={"KHR_materials_emissive_strength": {"emissiveStrength": 15}})],
        "bufferViews": views, "accessors": accessors, "buffers": [{"byteLength": len(data)}],
    }
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    data.extend(bytes(-len(data) % 4))
    with open(path, "wb") as file:
        file.write(struct.pack("<III", 0x46546C67, 2, 28 + len(text) + len(data)))
        file.write(struct.pack("<II", len(text), 0x4E4F534A) + text)
        file.write(struct.pack("<II", len(data), 0x004E4942) + data)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("triangles", type=int, nargs="*", default=[70_000, 700_000, 3_000_000])
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    for count in arguments.triangles:
        path = arguments.folder / f"room-{count}.glb"
        if path.exists():
            continue
        write_glb(path, scene(count))
        print(path)


if __name__ == "__main__":
    main()
