"""Scenes with one number that grows: triangles, lights, instances, nodes or textures, all else alike."""
import math
import random
import struct
import sys
from array import array

from product import ROOT

sys.path.insert(0, str(ROOT / "scripts"))
from asset_maker.gltf import ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER, FLOAT, Gltf  # noqa: E402
from asset_maker.png import grey_png  # noqa: E402

UNSIGNED_INT = 5125
SIDE = 10.0  # of the floor, in metres


class LargeGltf(Gltf):
    """Geometry from flat arrays, with 32-bit indices."""

    def vectors(self, values, **extra):
        return self._append("accessors", {"bufferView": self._view(values.tobytes(), ARRAY_BUFFER), **extra,
                                          "componentType": FLOAT, "count": len(values) // 3, "type": "VEC3"})

    def geometry(self, positions, indices):
        columns = [positions[axis::3] for axis in range(3)]
        position = self.vectors(positions, min=[min(c) for c in columns], max=[max(c) for c in columns])
        view = self._view(indices.tobytes(), ELEMENT_ARRAY_BUFFER)
        index = self._append("accessors", {"bufferView": view, "componentType": UNSIGNED_INT, "count": len(indices),
                                           "type": "SCALAR"})
        return {"attributes": {"POSITION": position}, "indices": index}

    def instances(self, mesh, translations):
        """EXT_mesh_gpu_instancing: copies of a mesh at these places."""
        self.extensions.add("EXT_mesh_gpu_instancing")
        self.json["nodes"][self.node(mesh)]["extensions"] = {
            "EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": self.vectors(translations)}}}

    def view_from(self, height):
        self.camera("view", (0.0, height, 0.9 * SIDE), (0.0, 0.0, 0.0), math.radians(45.0), 1.0)


def _height(x, z):
    return 0.3 * math.sin(1.7 * x) * math.cos(1.3 * z) + 0.1 * math.sin(7 * x + 3 * z)


def _ground(gltf, triangles):
    """About so many triangles of a wavy floor."""
    cells = max(1, round(math.sqrt(triangles / 2)))
    step, row = SIDE / cells, cells + 1
    places = [step * i - SIDE / 2 for i in range(row)]
    positions = array("f", (c for z in places for x in places for c in (x, _height(x, z), z)))
    strip = [i for a in range(cells) for i in (a, a + row, a + 1, a + 1, a + row, a + row + 1)]
    indices = array("I")
    for first in range(0, cells * row, row):
        indices.extend([first + i for i in strip])
    geometry = gltf.geometry(positions, indices)
    gltf.node(gltf.mesh("ground", geometry, gltf.lambert("ground", (0.6, 0.6, 0.6))))


def _small_triangles(count, size, rng):
    positions = array("f")
    for _ in range(count):
        x, y, z = rng.uniform(-5, 5), rng.uniform(1, 3), rng.uniform(-5, 5)
        positions.extend((x, y, z, x + size, y, z, x, y, z + size))
    return positions, array("I", range(3 * count))


def triangles(count):
    gltf = LargeGltf(f"{count} triangles")
    _ground(gltf, count)
    gltf.view_from(3.0)
    return gltf


def lights(count):
    """Emissive triangles over a floor; their power sums to the same whatever their number."""
    gltf = LargeGltf(f"{count} lights")
    _ground(gltf, 200)
    size = 0.5 / math.sqrt(count)
    geometry = gltf.geometry(*_small_triangles(count, size, random.Random(count)))
    gltf.node(gltf.mesh("lamps", geometry, gltf.emitter("lamp", (500.0, 400.0, 300.0))))
    gltf.view_from(3.0)
    return gltf


def _stone(gltf):
    geometry = gltf.geometry(array("f", (0, 0.1, 0, 0.1, 0, 0, 0, 0, 0.1, -0.1, 0, 0, 0, 0, -0.1, 0, -0.1, 0)),
                             array("I", (0, 2, 1, 0, 3, 2, 0, 4, 3, 0, 1, 4, 5, 1, 2, 5, 2, 3, 5, 3, 4, 5, 4, 1)))
    return gltf.mesh("stone", geometry, gltf.lambert("stone", (0.7, 0.5, 0.4)))


def _places(count):
    rng = random.Random(count)
    return ((rng.uniform(-5, 5), rng.uniform(0, 2), rng.uniform(-5, 5)) for _ in range(count))


def instances(count):
    gltf = LargeGltf(f"{count} instances")
    _ground(gltf, 200)
    gltf.instances(_stone(gltf), array("f", (c for place in _places(count) for c in place)))
    gltf.view_from(3.0)
    return gltf


def nodes(count):
    """The same stones, each a node of its own."""
    gltf = LargeGltf(f"{count} nodes")
    _ground(gltf, 200)
    stone = _stone(gltf)
    for place in _places(count):
        gltf.node(stone, place)
    gltf.view_from(3.0)
    return gltf


def textures(count):
    """As many squares in a wall, each of its own mesh, material and image of 64 x 64 pixels."""
    gltf = LargeGltf(f"{count} textures")
    side = math.ceil(math.sqrt(count))
    step = 6.0 / side
    positions = array("f", (0, 0, 0, step, 0, 0, 0, step, 0, step, step, 0))
    square = gltf.geometry(positions, array("I", (0, 1, 2, 1, 3, 2)))
    uvs = gltf._view(struct.pack("<8f", 0, 1, 1, 1, 0, 0, 1, 0), ARRAY_BUFFER)
    square["attributes"]["TEXCOORD_0"] = gltf._append("accessors", {
        "bufferView": uvs, "componentType": FLOAT, "count": 4, "type": "VEC2"})
    rng = random.Random(count)
    for i in range(count):
        image = grey_png([[rng.randrange(256)] * 64 for _ in range(64)])
        material = gltf.material(f"square {i}", (1.0, 1.0, 1.0), texture=gltf.texture(f"image {i}", image))
        gltf.node(gltf.mesh(f"square {i}", square, material), (i % side * step - 3, i // side * step - 3, 0.0))
    gltf.view_from(0.0)
    return gltf
