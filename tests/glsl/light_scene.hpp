// A scene's lights on the device, put together by hand.
#pragma once

#include <cmath>
#include <vector>

#include "accel/light_tree.hpp"
#include "gpu/buffer.hpp"
#include "isophote/scene.hpp"
#include "shared/scene_view.h"
#include "support/gpu_device.hpp"
#include "upload/alias_table.hpp"
#include "upload/environment_density.hpp"

#include "shared/geometry_types.h"
#include "shared/material_types.h"

namespace isophote::test {

/// Fill the arrays, then take address().
struct LightScene {
  std::vector<gpu::BvhTriangle> triangles;
  std::vector<gpu::InstanceRecord> instances;
  std::vector<gpu::Geometry> geometries;
  std::vector<gpu::MaterialRecord> materials;
  std::vector<gpu::TextureSlot> textureSlots;
  std::vector<uint32_t> indices;
  std::vector<glm::vec2> uvs;
  std::vector<gpu::EmissiveTriangle> emissiveTriangles;
  std::vector<gpu::PunctualLightRecord> punctualLights;
  std::vector<double> powers;     ///< of every light in the order of light indices
  std::vector<LightBound> bounds; ///< for the light tree; none: the scene has no tree
  Environment environment;        ///< no pixels: none

  /// Uploads everything; the scene lives as long as this object.
  [[nodiscard]] uint64_t address() {
    buffers_.clear();
    gpu::SceneView view{};
    view.triangles = add(triangles);
    view.instances = add(instances);
    view.geometries = add(geometries);
    view.materials = add(materials);
    view.textureSlots = add(textureSlots);
    view.indices = add(indices);
    view.uvs = add(uvs);
    view.emissiveTriangles = add(emissiveTriangles);
    view.punctualLights = add(punctualLights);
    const auto alias = buildAliasTable(powers);
    view.lightAlias = add(alias);
    view.lightCount = static_cast<uint32_t>(alias.size());
    const LightTree tree = buildLightTree(bounds);
    if (!tree.nodes.empty()) view.lightTree = add(tree.nodes);
    view.lightTrails = add(tree.trails);
    view.lightTreeScale = tree.scale;
    view.emissiveTriangleCount = static_cast<uint32_t>(emissiveTriangles.size());
    view.punctualLightCount = static_cast<uint32_t>(punctualLights.size());
    view.instanceCount = static_cast<uint32_t>(instances.size());
    if (!environment.pixels.empty()) addEnvironment(view.environment);
    return add(std::vector<gpu::SceneView>{view});
  }

private:
  template <class T> uint64_t add(const std::vector<T>& values) {
    buffers_.push_back(gpu::uploadBuffer(gpuDevice(), values, "light scene"));
    return buffers_.back().address();
  }

  void addEnvironment(gpu::EnvironmentRecord& record) {
    const EnvironmentDensity density = environmentDensity(environment);
    std::vector<glm::vec3> pixels = environment.pixels;
    for (glm::vec3& pixel : pixels) pixel *= environment.intensity;
    record.pixels = add(pixels);
    record.marginal = add(density.marginal);
    record.conditional = add(density.conditional);
    record.width = environment.width;
    record.height = environment.height;
    record.cosRotation = static_cast<float>(std::cos(environment.rotation));
    record.sinRotation = static_cast<float>(std::sin(environment.rotation));
  }

  std::vector<gpu::Buffer> buffers_;
};

} // namespace isophote::test
