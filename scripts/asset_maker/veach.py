"""Four glossy plates under four spheres of one power: the scene on which multiple importance sampling was shown.

After Veach 1997, "Robust Monte Carlo Methods for Light Transport Simulation", figure 9.2; the numbers here are our own. The
smoother a plate and the larger a light, the better BSDF sampling does; the rougher and the smaller, light sampling.
"""
import math

from asset_maker.gltf import Gltf
from asset_maker.shapes import quad
from asset_maker.vectors import add, dot, normalize, scale, subtract

EYE, TARGET = (0.0, 2.0, 15.0), (0.0, -2.0, 2.5)
YFOV = math.radians(28)
RADII = (0.1, 0.2, 0.45, 0.9)
LIGHT_X = (-3.75, -1.25, 1.25, 3.75)
INTENSITY = 10.0  # of each light: radiance falls with the square of the radius
ROUGHNESS = (0.14, 0.22, 0.32, 0.5)
DROP_DEGREES = (14.0, 18.5, 23.0, 27.5)  # of each plate's middle below the horizon, seen from the eye
PLATE_Z = (1.2, 2.9, 4.9, 7.2)  # so that no plate hides the lights from the next
HALF_HEIGHT_DEGREES = 1.3
HALF_WIDTH = 4.2


def _plate(drop, z):
    """Turned so that its middle mirrors the eye to the row of lights."""
    distance = EYE[2] - z
    middle = (0.0, EYE[1] - distance * math.tan(math.radians(drop)), z)
    to_eye = normalize(subtract(EYE, middle))
    normal = normalize(add(to_eye, normalize(subtract((0.0, 0.0, 0.0), middle))))
    along = (0.0, normal[2], -normal[1])  # up the plate, away from the eye
    cosine = dot(normal, to_eye)
    height = math.hypot(*subtract(EYE, middle)) * math.tan(math.radians(HALF_HEIGHT_DEGREES)) / cosine
    side, edge = (HALF_WIDTH, 0.0, 0.0), scale(along, height)
    corners = (subtract(subtract(middle, side), edge), add(subtract(middle, edge), side), add(add(middle, side), edge),
               add(subtract(middle, side), edge))
    return quad(*corners)


def scene():
    gltf = Gltf("Veach's plates")
    wall = gltf.lambert("wall", (0.4, 0.4, 0.4))
    floor = quad((-12.0, -4.5, 12.0), (12.0, -4.5, 12.0), (12.0, -4.5, -3.0), (-12.0, -4.5, -3.0))
    back = quad((-12.0, -4.5, -3.0), (12.0, -4.5, -3.0), (12.0, 6.0, -3.0), (-12.0, 6.0, -3.0))
    gltf.node(gltf.mesh("floor", gltf.shape(floor), wall), name="floor")
    gltf.node(gltf.mesh("back", gltf.shape(back), wall), name="back")
    for i, (drop, z, roughness) in enumerate(zip(DROP_DEGREES, PLATE_Z, ROUGHNESS)):
        material = gltf.material(f"roughness {roughness}", (0.8, 0.8, 0.8), metallic=1.0, roughness=roughness)
        gltf.node(gltf.mesh(f"plate {i}", gltf.shape(_plate(drop, z)), material), name=f"plate {i}")
    for x, radius in zip(LIGHT_X, RADII):
        gltf.point_light(f"radius {radius}", (x, 0.0, 0.0), INTENSITY, radius)
    gltf.camera("camera", EYE, TARGET, YFOV, 1.5)
    return gltf
