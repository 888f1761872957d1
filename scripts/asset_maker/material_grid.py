"""Spheres of the metallic-roughness model: roughness 0 to 1 from left to right, metallic 0 to 1 from front to back."""
import math

from asset_maker.gltf import Gltf
from asset_maker.shapes import quad, sphere

ROUGHNESS = (0.0, 0.2, 0.4, 0.6, 0.8, 1.0)
METALLIC = (0.0, 0.5, 1.0)
SPACING, RADIUS = 1.1, 0.48


def scene():
    gltf = Gltf("Material grid: roughness and metallic")
    ball = gltf.shape(sphere(RADIUS, 32, 48))
    for row, metallic in enumerate(METALLIC):
        for column, roughness in enumerate(ROUGHNESS):
            name = f"metallic {metallic} roughness {roughness}"
            material = gltf.material(name, (0.9, 0.55, 0.25), metallic, roughness)
            x = (column - (len(ROUGHNESS) - 1) / 2) * SPACING
            gltf.node(gltf.mesh(name, ball, material), (x, RADIUS, -row * SPACING * 1.1), name=name)

    floor = gltf.lambert("floor", (0.4, 0.4, 0.4))
    gltf.node(gltf.mesh("floor", gltf.shape(quad((-30.0, 0.0, 10.0), (30.0, 0.0, 10.0), (30.0, 0.0, -20.0), (-30.0, 0.0, -20.0))),
                        floor))
    key = gltf.emitter("key light", (12.0, 12.0, 12.0))
    panel = gltf.shape(quad((-2.5, 5.0, -2.5), (2.5, 5.0, -2.5), (2.5, 5.0, 0.5), (-2.5, 5.0, 0.5)))
    gltf.node(gltf.mesh("key light", panel, key))
    fill = gltf.emitter("fill light", (2.0, 2.5, 3.5))
    side = gltf.shape(quad((-6.0, 0.5, -4.0), (-6.0, 0.5, 2.0), (-6.0, 3.5, 2.0), (-6.0, 3.5, -4.0)))
    gltf.node(gltf.mesh("fill light", side, fill))
    gltf.point_light("lamp", (4.0, 4.0, 4.0), 10.0)
    gltf.camera("camera", (0.0, 3.6, 8.0), (0.0, 0.25, -1.0), math.radians(21.0), 2.0)
    return gltf
