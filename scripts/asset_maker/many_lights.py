"""A hundred small lamps of a thousandfold range of power over blocks on a floor."""
import math

from asset_maker.gltf import Gltf
from asset_maker.shapes import quad, rounded_box

COUNT = 10  # a side


def scene():
    gltf = Gltf("A hundred lamps")
    panel = gltf.shape(quad((-0.08, 0.0, -0.08), (0.08, 0.0, -0.08), (0.08, 0.0, 0.08), (-0.08, 0.0, 0.08)))
    for row in range(COUNT):
        for column in range(COUNT):
            index = row * COUNT + column
            power = 0.3 * 10 ** (3 * (index * 37 % 100) / 99)
            color = [power * (0.4 + 0.6 * (index * step % 10) / 9) for step in (3, 7, 9)]
            lamp = gltf.emitter(f"lamp {index}", color)
            height = 1.2 + 0.8 * (index * 61 % 100) / 99
            gltf.node(gltf.mesh(f"lamp {index}", panel, lamp), (column - 4.5, height, row - 4.5))
    grey = gltf.lambert("grey", (0.6, 0.6, 0.6))
    gltf.node(gltf.mesh("floor", gltf.shape(quad((-8.0, 0.0, 8.0), (8.0, 0.0, 8.0), (8.0, 0.0, -8.0), (-8.0, 0.0, -8.0))), grey))
    glossy = gltf.material("glossy", (0.7, 0.7, 0.75), 0.5, 0.35)
    block = gltf.shape(rounded_box((0.45, 0.45, 0.45), 0.08, 2))
    for index, (x, z) in enumerate(((-2.3, -1.0), (0.4, 0.9), (2.4, -1.6), (-0.9, 2.6))):
        gltf.node(gltf.mesh(f"block {index}", block, glossy), (x, 0.45, z))
    gltf.camera("camera", (0.0, 6.5, 9.0), (0.0, 0.2, 0.3), math.radians(38.0), 1.0)
    return gltf
