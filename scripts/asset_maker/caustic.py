"""A polished ring on a floor under a small lamp: the cusp of light inside it, which only BSDF sampling finds."""
import math

from asset_maker.gltf import Gltf
from asset_maker.shapes import lathe, quad

OUTER, INNER, HEIGHT = 1.0, 0.92, 0.45


def scene():
    gltf = Gltf("Caustic of a ring")
    edges = [(INNER, 0.0), (INNER, HEIGHT), (INNER, HEIGHT), (OUTER, HEIGHT), (OUTER, HEIGHT), (OUTER, 0.0)]
    gold = gltf.material("gold", (1.0, 0.77, 0.34), 1.0, 0.05)
    gltf.node(gltf.mesh("ring", gltf.shape(lathe(edges, 64)), gold), (0.0, 0.001, 0.0))
    white = gltf.lambert("white", (0.7, 0.7, 0.7))
    gltf.node(gltf.mesh("floor", gltf.shape(quad((-4.0, 0.0, 4.0), (4.0, 0.0, 4.0), (4.0, 0.0, -4.0), (-4.0, 0.0, -4.0))), white))
    lamp = gltf.emitter("lamp", (60.0, 60.0, 60.0))
    gltf.node(gltf.mesh("lamp", gltf.shape(quad((2.0, 2.2, -0.3), (2.5, 2.5, -0.3), (2.5, 2.5, 0.3), (2.0, 2.2, 0.3))), lamp))
    gltf.camera("camera", (0.0, 4.2, 2.6), (0.0, 0.1, 0.0), math.radians(34.0), 1.0)
    return gltf
