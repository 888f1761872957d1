"""One triangle and one point light: the smallest scene with direct light."""
import math

from asset_maker.gltf import Gltf
from asset_maker.shapes import Shape


def scene():
    gltf = Gltf("One triangle lit by one point light")
    grey = gltf.lambert("grey", (0.5, 0.5, 0.5))
    shape = gltf.shape(Shape([(-1.0, -1.0, 0.0), (1.0, -1.0, 0.0), (0.0, 1.0, 0.0)], [0, 1, 2]))
    gltf.node(gltf.mesh("triangle", shape, grey), name="triangle")
    gltf.point_light("lamp", (0.0, 0.0, 2.0), 4.0 * math.pi)
    gltf.camera("front", (0.0, 0.0, 3.0), (0.0, 0.0, 0.0), math.radians(50.0), 1.0)
    return gltf
