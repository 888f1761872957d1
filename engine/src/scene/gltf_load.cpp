// loadGltf: the parts in order. Each part checks what it reads; checkSchema has checked types and indices before.
#include "isophote/gltf.hpp"

#include <new>
#include <stdexcept>

#include <fmt/format.h>

#include "isophote/error.hpp"
#include "scene/gltf_accessors.hpp"
#include "scene/gltf_buffers.hpp"
#include "scene/gltf_cameras_lights.hpp"
#include "scene/gltf_document.hpp"
#include "scene/gltf_extensions.hpp"
#include "scene/gltf_instances.hpp"
#include "scene/gltf_materials.hpp"
#include "scene/gltf_meshes.hpp"
#include "scene/gltf_nodes.hpp"
#include "scene/gltf_textures.hpp"
#include "scene/gltf_variants.hpp"

namespace isophote {
namespace {

void addLightsAndCameras(gltf::Document& document, const std::vector<gltf::PlacedNode>& nodes, Scene& scene) {
  const std::vector<Camera> cameras = gltf::readCameras(document);
  const std::vector<PunctualLight> lights = gltf::readLights(document);
  const gltf::Json& nodeArray = gltf::arrayOrEmpty(document.root, "nodes");
  for (const gltf::PlacedNode& node : nodes) {
    const gltf::Json& json = nodeArray[node.index];
    if (const auto camera = gltf::indexOf(json, "camera")) {
      scene.cameras.push_back(gltf::placed(cameras[*camera], node.worldFromNode));
      if (scene.cameras.back().name.empty()) scene.cameras.back().name = gltf::stringOr(json, "name", "");
    }
    const gltf::Json* reference = gltf::extension(json, "KHR_lights_punctual");
    if (!reference || !node.visible) continue;
    const auto light = gltf::placed(lights[*gltf::indexOf(*reference, "light")], node.worldFromNode);
    if (light) {
      scene.lights.push_back(*light);
    } else {
      document.warnings.add("a light under a singular transform is skipped", gltf::nodePointer(node.index));
    }
  }
}

Scene load(const std::filesystem::path& file, const LoadOptions& options) {
  gltf::Document document = gltf::openDocument(file, options);
  const gltf::Buffers buffers(document);
  gltf::Accessors accessors(document, buffers);
  const gltf::NodeGraph graph(document);
  const std::vector<gltf::PlacedNode> nodes = graph.place(graph.sceneRoots());

  Scene scene;
  scene.name = document.file;
  scene.extensionsUsed = gltf::extensionsUsed(document);
  scene.extensionsIgnored = gltf::extensionsIgnored(document);
  gltf::Textures textures(document, buffers);
  gltf::MaterialTable materials(document, textures);
  const gltf::Variants variants(document);
  gltf::Meshes meshes(document, buffers, accessors, materials, variants);
  gltf::addInstances(document, accessors, graph, nodes, meshes, scene);
  addLightsAndCameras(document, nodes, scene);
  if (!gltf::arrayOrEmpty(document.root, "animations").empty()) {
    document.warnings.add("animations are ignored: the scene is in the static pose of its nodes");
  }
  scene.warnings = document.warnings.lines();
  return scene;
}

} // namespace

std::vector<std::string> gltfVariants(const std::filesystem::path& file) {
  return gltf::Variants(gltf::openDocument(file, {})).names();
}

Scene loadGltf(const std::filesystem::path& file, const LoadOptions& options) {
  try {
    return load(file, options);
  } catch (const std::bad_alloc&) {
    throw LimitError(fmt::format("{}: not enough memory to load it", file.string()));
  } catch (const std::length_error&) {
    throw LimitError(fmt::format("{}: not enough memory to load it", file.string()));
  }
}

} // namespace isophote
