// Scenes for traversal tests, and what a ray hits in them by brute force in double precision.
#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include <glm/glm.hpp>

#include "isophote/gpu_scene.hpp"
#include "isophote/scene.hpp"
#include "support/probe.hpp"
#include "upload/gpu_scene.hpp"

namespace isophote::test {

/// A mesh of one primitive; indices may be empty: every three positions are a triangle.
[[nodiscard]] Mesh meshOf(std::vector<glm::vec3> positions, std::vector<uint32_t> indices = {}, uint32_t material = 0);

/// A scene of these meshes, each placed once by the identity, with one opaque grey material.
[[nodiscard]] Scene sceneOf(std::vector<Mesh> meshes);

/// Closed sphere of 2 * rings * rings * 2 - 4 * rings triangles or fewer: those that rounding makes degenerate are left
/// out.
[[nodiscard]] Mesh sphereMesh(glm::vec3 center, float radius, uint32_t rings);

/// Random triangles with edges of about `size` in [-1, 1]^3.
[[nodiscard]] std::vector<glm::vec3> triangleSoup(uint32_t count, float size, uint32_t seed);

/// Rotation, non-uniform scale in [1/4, 4], mirrored every other call, translation up to `spread`.
[[nodiscard]] glm::dmat4 randomPlacement(std::mt19937& random, double spread);

[[nodiscard]] glm::vec3 randomDirection(std::mt19937& random);

struct ReferenceHit {
  double t = 0;
  uint32_t instance = 0; ///< of the Scene
  uint32_t triangle = 0; ///< number within its mesh
  glm::dvec2 barycentrics{0};
  double margin = 0; ///< how much nearer an edge or another hit would have to be to change the answer, relative
};

/// The closest hit with t > 0 over every triangle of every instance; scenes of one primitive a mesh.
[[nodiscard]] std::optional<ReferenceHit> bruteForceHit(const Scene& scene, const glm::dvec3& origin,
                                                        const glm::dvec3& direction, double tMax);

/// Every feature as specialisation constant, as the scene has it.
[[nodiscard]] std::vector<gpu::SpecConstant> featureConstants(const FeatureSet& features);

/// Runs a probe whose pc.extra is the scene, specialised for the scene's features.
template <class Out, class In>
[[nodiscard]] std::vector<Out> runOnScene(const gpu::KernelSource& source, const GpuScene& scene,
                                          const std::vector<In>& inputs,
                                          std::span<const gpu::SpecConstant> settings = {}) {
  std::vector<gpu::SpecConstant> constants = featureConstants(scene.features());
  constants.insert(constants.end(), settings.begin(), settings.end());
  return runProbe<In, Out>(
      source, inputs,
      {.extra = scene.impl().view.address(), .constants = constants, .textures = &scene.impl().textures});
}

} // namespace isophote::test
