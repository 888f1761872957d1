#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "commands/commands.hpp"
#include "exit_codes.hpp"
#include "input/scene_source.hpp"
#include "input/scene_summary.hpp"
#include "isophote/features.hpp"
#include "isophote/gltf.hpp"

namespace isophote::cli {
namespace {

using Json = nlohmann::ordered_json;

struct InfoOptions {
  std::string scene;
  EnvironmentOptions environment;
  std::optional<std::string> variant;
  bool json = false;
};

const char* kindName(CameraKind kind) {
  switch (kind) {
  case CameraKind::Perspective:
    return "perspective";
  case CameraKind::Orthographic:
    return "orthographic";
  case CameraKind::Panorama:
    return "panorama";
  }
  return "";
}

const char* kindName(LightKind kind) {
  switch (kind) {
  case LightKind::Point:
    return "point";
  case LightKind::Spot:
    return "spot";
  case LightKind::Directional:
    return "directional";
  }
  return "";
}

Json boundsJson(const Scene& scene) {
  const Bounds bounds = worldBounds(scene);
  if (bounds.empty()) return nullptr;
  return {{"lower", {bounds.lower.x, bounds.lower.y, bounds.lower.z}},
          {"upper", {bounds.upper.x, bounds.upper.y, bounds.upper.z}}};
}

Json contentJson(const Scene& scene, const SceneSummary& summary) {
  return {{"triangles", summary.triangles},
          {"instanced_triangles", summary.instancedTriangles},
          {"emissive_triangles", summary.emissiveTriangles},
          {"vertices", summary.vertices},
          {"meshes", scene.meshes.size()},
          {"primitives", summary.primitives},
          {"instances", scene.instances.size()},
          {"materials", scene.materials.size()},
          {"textures", scene.textures.size()},
          {"images", scene.images.size()},
          {"punctual_lights", scene.lights.size()},
          {"cameras", scene.cameras.size()},
          {"environment", scene.environment.has_value()}};
}

Json camerasJson(const Scene& scene) {
  Json list = Json::array();
  for (const Camera& camera : scene.cameras) {
    list.push_back({{"name", camera.name}, {"kind", kindName(camera.kind)}});
  }
  return list;
}

Json lightsJson(const Scene& scene) {
  Json list = Json::array();
  for (const PunctualLight& light : scene.lights) {
    list.push_back({{"name", light.name},
                    {"kind", kindName(light.kind)},
                    {"intensity", {light.intensity.r, light.intensity.g, light.intensity.b}}});
  }
  return list;
}

Json infoJson(const InfoOptions& options, const Scene& scene) {
  const SceneSummary summary = summarize(scene);
  const FeatureSet features = sceneFeatures(scene);
  Json leftOut = Json::array();
  for (const FeatureDescription& description : allFeatures()) {
    if (!features.has(description.feature)) {
      leftOut.push_back({{"feature", description.name}, {"omitted", description.omitted}});
    }
  }
  return {{"schema", 1},
          {"scene", options.scene},
          {"content", contentJson(scene, summary)},
          {"bounds", boundsJson(scene)},
          {"cameras", camerasJson(scene)},
          {"lights", lightsJson(scene)},
          {"features", features.names()},
          {"left_out", leftOut},
          {"memory_estimate",
           {{"geometry_bytes", summary.geometryBytes},
            {"bvh_bytes", summary.bvhBytes},
            {"texture_bytes", summary.textureBytes},
            {"environment_bytes", summary.environmentBytes},
            {"total_bytes", summary.totalBytes()}}},
          {"variants", gltfVariants(options.scene)},
          {"extensions_used", scene.extensionsUsed},
          {"extensions_ignored", scene.extensionsIgnored},
          {"warnings", scene.warnings}};
}

double mebibytes(uint64_t bytes) { return static_cast<double>(bytes) / (1u << 20); }

void printFeatures(const FeatureSet& features) {
  fmt::print("\nneeds: {}\nleft out of kernels, buffers and bindings:\n", fmt::join(features.names(), ", "));
  for (const FeatureDescription& description : allFeatures()) {
    if (!features.has(description.feature)) fmt::print("  {:<18} {}\n", description.name, description.omitted);
  }
}

void printText(const InfoOptions& options, const Scene& scene) {
  const SceneSummary summary = summarize(scene);
  fmt::print("{}\n", options.scene);
  fmt::print("  {} triangles ({} with instances, {} emissive), {} vertices\n", summary.triangles,
             summary.instancedTriangles, summary.emissiveTriangles, summary.vertices);
  fmt::print("  {} meshes in {} instances, {} materials, {} textures of {} images\n", scene.meshes.size(),
             scene.instances.size(), scene.materials.size(), scene.textures.size(), scene.images.size());
  for (size_t i = 0; i < scene.cameras.size(); ++i) {
    fmt::print("  camera {} '{}', {}\n", i, scene.cameras[i].name, kindName(scene.cameras[i].kind));
  }
  for (const PunctualLight& light : scene.lights) fmt::print("  {} light '{}'\n", kindName(light.kind), light.name);
  for (const std::string& variant : gltfVariants(options.scene)) fmt::print("  variant '{}'\n", variant);
  if (scene.environment) fmt::print("  environment {} x {}\n", scene.environment->width, scene.environment->height);
  if (!hasLight(scene)) fmt::print("  no light: a render needs --env or --env-color\n");
  const Bounds bounds = worldBounds(scene);
  if (!bounds.empty()) {
    fmt::print("  bounds ({:g}, {:g}, {:g}) to ({:g}, {:g}, {:g})\n", bounds.lower.x, bounds.lower.y, bounds.lower.z,
               bounds.upper.x, bounds.upper.y, bounds.upper.z);
  }
  fmt::print("  about {:.1f} MiB on the device: geometry {:.1f}, BVH {:.1f}, textures {:.1f}, environment {:.1f}\n",
             mebibytes(summary.totalBytes()), mebibytes(summary.geometryBytes), mebibytes(summary.bvhBytes),
             mebibytes(summary.textureBytes), mebibytes(summary.environmentBytes));
  printFeatures(sceneFeatures(scene));
  if (!scene.extensionsUsed.empty()) fmt::print("\nextensions: {}\n", fmt::join(scene.extensionsUsed, ", "));
  if (!scene.extensionsIgnored.empty())
    fmt::print("extensions ignored: {}\n", fmt::join(scene.extensionsIgnored, ", "));
  for (const std::string& warning : scene.warnings) fmt::print("warning: {}\n", warning);
}

int runInfo(const InfoOptions& options) {
  const LoadedScene loaded = loadScene(options.scene, options.environment, options.variant);
  if (options.json) {
    // Names in assets need not be UTF-8; what is not is replaced.
    fmt::print("{}\n", infoJson(options, loaded.scene).dump(2, ' ', false, Json::error_handler_t::replace));
  } else {
    printText(options, loaded.scene);
  }
  return kDone;
}

} // namespace

void addInfoCommand(CLI::App& program, Action& action) {
  CLI::App* command =
      program.add_subcommand("info", "Show what a scene holds, what a render of it needs and what is left out");
  const auto options = std::make_shared<InfoOptions>();
  command->add_option("SCENE", options->scene, "glTF 2.0 file, .gltf or .glb")->required();
  command->add_flag("--json", options->json, "Machine-readable");
  addVariantFlag(*command, options->variant);
  addEnvironmentFlags(*command, options->environment);
  command->footer(
      "Examples:\n  isophote info scene.glb\n  isophote info scene.glb --env sky.hdr --json\n\nNeeds no GPU.");
  command->callback([options, &action] { action = [options] { return runInfo(*options); }; });
}

} // namespace isophote::cli
