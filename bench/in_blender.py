"""Renders a glTF scene with Cycles on the CPU; runs inside Blender 3.4 (Debian 12):

blender -b --factory-startup -noaudio -P bench/in_blender.py -- SCENE IMAGE.exr '{"width": 256, ...}'

The last argument is JSON: width, height, spp, vertices (of a path beyond the camera's), seed, threads, and, if wanted,
environment (a file). Prints "SECONDS x": the time of `spp` samples without loading, synchronization and BVH, which a
render of one sample measures. Scenes in which both renderers mean the same: Lambertian or metallic-roughness
materials, with or without base color texture, that do not transmit; emissive triangles; an environment.
"""
import json
import sys
import time

import bmesh
import bpy
import numpy

numpy.bool = bool  # Blender 3.4's importer uses what Debian's NumPy 1.24 has dropped

# Cycles 3.4 underestimates light from triangles seen at a grazing angle; cut small, they are right.
EMITTER_CUTS = 3


def import_scene(file):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    for addon in ("cycles", "io_scene_gltf2"):
        bpy.ops.preferences.addon_enable(module=addon)
    bpy.ops.import_scene.gltf(filepath=file, import_shading="NORMALS", convert_lighting_mode="COMPAT")


def document(file):
    data = open(file, "rb").read()
    if data[:4] != b"glTF":
        return json.loads(data)
    return json.loads(data[20:20 + int.from_bytes(data[12:16], "little")])


def is_lambertian(material):
    surface = material.get("pbrMetallicRoughness", {})
    specular = material.get("extensions", {}).get("KHR_materials_specular", {})
    return (specular.get("specularFactor", 1) == 0 and surface.get("metallicFactor", 1) == 0 and
            "baseColorTexture" not in surface)


def emission(material):
    strength = material.get("extensions", {}).get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1)
    return [strength * c for c in material.get("emissiveFactor", (0, 0, 0))]


def make_lambertian(tree, material):
    """Diffuse reflection, and emission from the front alone: Principled would add a specular lobe."""
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    surface = tree.nodes.new("ShaderNodeBsdfDiffuse")
    surface.inputs["Color"].default_value = material["pbrMetallicRoughness"]["baseColorFactor"]
    tree.links.new(surface.outputs[0], output.inputs["Surface"])
    if any(emission(material)):
        light = tree.nodes.new("ShaderNodeEmission")
        light.inputs["Color"].default_value = [*emission(material), 1]
        tree.links.new(light.outputs[0], output.inputs["Surface"])


def correct_materials(gltf):
    for material in gltf.get("materials", []):
        imported = bpy.data.materials.get(material.get("name", ""))
        if imported and is_lambertian(material):
            make_lambertian(imported.node_tree, material)


def cut_emitters(gltf):
    names = {material.get("name") for material in gltf.get("materials", []) if any(emission(material))}
    for thing in bpy.context.scene.objects:
        if thing.type == "MESH" and any(slot.material and slot.material.name in names for slot in thing.material_slots):
            mesh = bmesh.new()
            mesh.from_mesh(thing.data)
            bmesh.ops.subdivide_edges(mesh, edges=mesh.edges[:], cuts=EMITTER_CUTS, use_grid_fill=True)
            mesh.to_mesh(thing.data)
            mesh.free()


def use_camera(gltf):
    scene = bpy.context.scene
    scene.camera = next(thing for thing in scene.objects if thing.type == "CAMERA")
    scene.camera.data.sensor_fit = "VERTICAL"
    scene.camera.data.angle_y = gltf["cameras"][0]["perspective"]["yfov"]


def use_environment(file):
    world = bpy.data.worlds.new("environment")
    bpy.context.scene.world = world
    world.use_nodes = True
    background = world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (0, 0, 0, 1)
    if file:
        texture = world.node_tree.nodes.new("ShaderNodeTexEnvironment")
        texture.image = bpy.data.images.load(file)
        world.node_tree.links.new(texture.outputs["Color"], background.inputs["Color"])


def use_settings(options, image):
    """The estimator that Isophote's default is nearest to: nothing clamped, blurred, filtered or left out."""
    scene = bpy.context.scene
    render, cycles = scene.render, scene.cycles
    render.engine, cycles.device = "CYCLES", "CPU"
    render.threads_mode, render.threads = "FIXED", options["threads"]
    render.resolution_x, render.resolution_y, render.resolution_percentage = options["width"], options["height"], 100
    render.filepath = image
    render.image_settings.file_format, render.image_settings.color_mode = "OPEN_EXR", "RGB"
    render.image_settings.color_depth = "32"
    scene.view_settings.view_transform = "Raw"
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.seed = options["seed"]
    bounces = options["vertices"] - 1
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = bounces
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.blur_glossy = cycles.light_sampling_threshold = 0
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 1


def seconds_of(spp, **write):
    bpy.context.scene.cycles.samples = spp
    start = time.monotonic()
    bpy.ops.render.render(**write)
    return time.monotonic() - start


def main():
    file, image, options = sys.argv[sys.argv.index("--") + 1:]
    options = json.loads(options)
    import_scene(file)
    gltf = document(file)
    correct_materials(gltf)
    cut_emitters(gltf)
    use_camera(gltf)
    use_environment(options.get("environment"))
    use_settings(options, image)
    one = min(seconds_of(1) for _ in range(2))  # builds the BVH as the longer render does
    all_of_them = seconds_of(options["spp"] + 1, write_still=True)
    print("SECONDS", all_of_them - one)


main()
