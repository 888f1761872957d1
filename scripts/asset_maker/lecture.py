"""Three spheres under a round lamp on a floor before a red wall: the course that the project grew from, as one scene
whose variants change the material of the spheres, or of everything (docs/lecture)."""
import math

from asset_maker.gltf import Gltf
from asset_maker.shapes import quad, sphere

# The course's roughness is the width alpha of the normals' distribution; glTF's is its root.
METAL, PLASTIC = (0.9, 0.8, 0.6), (0.2, 0.4, 0.8)


def _glass(gltf, name, alpha):
    """Solid: light is refracted on its way in and out."""
    gltf.extensions.update(("KHR_materials_transmission", "KHR_materials_volume"))
    glass = gltf.material(name, (1.0, 1.0, 1.0), 0.0, math.sqrt(alpha))
    gltf.json["materials"][glass]["extensions"] = {"KHR_materials_transmission": {"transmissionFactor": 1.0},
                                                   "KHR_materials_volume": {"thicknessFactor": 1.0}}
    return glass


def _variants(gltf):
    """Name -> (material of the spheres, material of all)."""
    metal = gltf.material("metal 0.2", METAL, 1.0, math.sqrt(0.2))
    return {
        "diffuse": (gltf.lambert("white", (0.8, 0.8, 0.8)), None),
        "metal everywhere": (metal, metal),
        "rough metal": (gltf.material("metal 1.0", METAL, 1.0, 1.0), None),
        "plastic": (gltf.material("plastic 0.2", PLASTIC, 0.0, math.sqrt(0.2)), None),
        "glass 0.2": (_glass(gltf, "glass 0.2", 0.2), None),
        "glass 0.8": (_glass(gltf, "glass 0.8", 0.8), None),
    }


def _mesh(gltf, name, geometry, materials):
    """`materials`: of each variant in turn; the first is the default."""
    mesh = gltf.mesh(name, geometry, materials[0])
    mappings = [{"material": m, "variants": [v for v, other in enumerate(materials) if other == m]}
                for m in dict.fromkeys(materials)]
    gltf.json["meshes"][mesh]["primitives"][0]["extensions"] = {"KHR_materials_variants": {"mappings": mappings}}
    return mesh


def scene():
    gltf = Gltf("Three spheres of a course")
    gltf.extensions.add("KHR_materials_variants")
    variants = _variants(gltf)
    gltf.json["extensions"] = {"KHR_materials_variants": {"variants": [{"name": name} for name in variants]}}
    grey, red = gltf.lambert("grey", (0.6, 0.6, 0.6)), gltf.lambert("red", (0.7, 0.2, 0.2))
    balls = [ball for ball, _ in variants.values()]
    floor = gltf.shape(quad((-3.0, 0.0, 2.0), (3.0, 0.0, 2.0), (3.0, 0.0, -2.0), (-3.0, 0.0, -2.0)))
    wall = gltf.shape(quad((-3.0, 0.0, -2.0), (3.0, 0.0, -2.0), (3.0, 4.0, -2.0), (-3.0, 4.0, -2.0)))
    gltf.node(_mesh(gltf, "floor", floor, [grey if everything is None else everything for _, everything in variants.values()]), name="floor")
    gltf.node(_mesh(gltf, "wall", wall, [red if everything is None else everything for _, everything in variants.values()]), name="wall")
    ball = _mesh(gltf, "ball", gltf.shape(sphere(0.6, 24, 48)), balls)
    for x in (-1.3, 0.0, 1.3):
        gltf.node(ball, (x, 0.6, 0.0), name="ball")
    lamp = gltf.mesh("lamp", gltf.shape(sphere(0.8, 12, 24)), gltf.emitter("lamp", (6.0, 6.0, 6.0)))
    gltf.node(lamp, (0.0, 3.2, 0.8), name="lamp")
    gltf.camera("camera", (0.0, 1.5, 5.0), (0.0, 0.9, 0.0), 0.6, 1.5)
    return gltf
