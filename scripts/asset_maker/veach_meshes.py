"""Four lights of one power and falling size over four metal plates of falling gloss.

After Veach 1997, "Robust Monte Carlo Methods for Light Transport Simulation", figure 9.2: neither light nor BSDF
sampling alone handles all pairs.
"""
import math

from asset_maker.gltf import Gltf
from asset_maker.shapes import quad, sphere

RADII = (0.9, 0.3, 0.1, 0.0333)
ROUGHNESS = (0.08, 0.18, 0.32, 0.5)
TILT_DEGREES = (53.0, 40.0, 29.0, 20.0)  # each plate mirrors the lights towards the camera


def _plate(index):
    angle = math.radians(TILT_DEGREES[index])
    y, z = 1.55 - 0.75 * index, -1.6 + 1.2 * index
    dy, dz = 0.42 * math.sin(angle), 0.42 * math.cos(angle)
    return quad((-3.5, y - dy, z + dz), (3.5, y - dy, z + dz), (3.5, y + dy, z - dz), (-3.5, y + dy, z - dz))


def scene():
    gltf = Gltf("Lights of four sizes in plates of four roughnesses")
    for index, roughness in enumerate(ROUGHNESS):
        material = gltf.material(f"plate {roughness}", (0.6, 0.6, 0.6), 1.0, roughness)
        gltf.node(gltf.mesh(f"plate {roughness}", gltf.shape(_plate(index)), material))
    for index, radius in enumerate(RADII):
        light = gltf.emitter(f"light {radius}", (0.9 / radius ** 2,) * 3)
        gltf.node(gltf.mesh(f"light {radius}", gltf.shape(sphere(radius, 8, 12)), light), (-3.0 + 2.0 * index, 4.2, -0.5))
    grey = gltf.lambert("grey", (0.4, 0.4, 0.4))
    gltf.node(gltf.mesh("wall", gltf.shape(quad((-12.0, -3.0, -4.0), (12.0, -3.0, -4.0), (12.0, 9.0, -4.0), (-12.0, 9.0, -4.0))), grey))
    gltf.node(gltf.mesh("floor", gltf.shape(quad((-12.0, -2.0, 12.0), (12.0, -2.0, 12.0), (12.0, -2.0, -4.0), (-12.0, -2.0, -4.0))), grey))
    gltf.camera("camera", (0.0, 2.0, 11.0), (0.0, 1.4, 0.0), math.radians(36.0), 1.0)
    return gltf
