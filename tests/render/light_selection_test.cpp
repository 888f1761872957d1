// Every way to choose among many lights gives the same image.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "support/render.hpp"
#include "support/scenes.hpp"

namespace isophote {
namespace {

using namespace isophote::test;

constexpr double kPi = 3.14159265358979323846;

/// Irradiance at the origin with normal +y from a triangle of radiance 1 above the horizon (Lambert 1760).
double triangleIrradiance(const std::array<glm::dvec3, 3>& v) {
  double sum = 0;
  for (size_t i = 0; i < 3; ++i) {
    const glm::dvec3 across = glm::cross(glm::normalize(v[i]), glm::normalize(v[(i + 1) % 3]));
    const double cosine = glm::dot(glm::normalize(v[i]), glm::normalize(v[(i + 1) % 3]));
    sum += std::atan2(glm::length(across), cosine) * glm::normalize(across).y;
  }
  return std::abs(sum) / 2;
}

struct ManyLights {
  Scene scene = lambertFloor(glm::vec3(1), 2);
  double irradiance = 0; ///< at the origin

  /// Triangles side by side on a sphere about the origin, so that none hides another; every third turned away, half of
  /// those double sided; a point, a spot and a directional light.
  ManyLights() {
    std::mt19937 generator(11);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int i = 0; i < 60; ++i) {
      const double phi = 2 * kPi * (i + 0.1) / 60;
      const double height = 0.15 + 0.8 * unit(generator);
      const glm::dvec3 along(std::sqrt(1 - height * height) * std::cos(phi), height,
                             std::sqrt(1 - height * height) * std::sin(phi));
      const double distance = 1 + 9 * unit(generator);
      const glm::dvec3 right = glm::normalize(glm::cross(along, glm::dvec3(0, 1, 0)));
      const double size = 0.03 * distance * std::sqrt(1 - height * height);
      std::array<glm::dvec3, 3> v = {distance * along - size * right, distance * along + size * right,
                                     (distance + 0.5) * along + size * glm::cross(right, along)};
      const bool front = glm::dot(glm::cross(v[1] - v[0], v[2] - v[0]), v[0]) < 0;
      if (front == (i % 3 == 0)) std::swap(v[1], v[2]);
      Material material = emitter(glm::vec3(static_cast<float>(std::pow(10.0, 2 * unit(generator)))));
      material.doubleSided = i % 6 == 0;
      Primitive light;
      for (const auto& corner : v) light.positions.emplace_back(corner);
      light.indices = {0, 1, 2};
      light.material = addMaterial(scene, material);
      addPrimitive(scene, light);
      if (i % 3 != 0 || material.doubleSided)
        irradiance += static_cast<double>(material.emissive.r) * triangleIrradiance(v);
    }
    scene.lights.push_back({.kind = LightKind::Point, .intensity = glm::vec3(20), .position = {0, 11, 0}});
    irradiance += 20.0 / 121;
    scene.lights.push_back({.kind = LightKind::Spot,
                            .intensity = glm::vec3(30),
                            .innerConeAngle = 0.5f,
                            .outerConeAngle = 0.7f,
                            .position = {0.1, 10, 0},
                            .direction = {0, -1, 0}});
    irradiance += 30.0 * 10 / std::pow(100.01, 1.5);
    scene.lights.push_back({.kind = LightKind::Directional, .intensity = glm::vec3(0.4f), .direction = {0, -1, 0}});
    irradiance += 0.4;
  }
};

TEST(RenderLightSelection, ManyLightsGiveTheirSumHoweverTheyAreChosen) {
  const ManyLights many;
  struct Case {
    LightSelection selection;
    LightSampling sampling;
    uint32_t samples;
  };
  for (const Case& c :
       {Case{LightSelection::Bvh, LightSampling::Mis, 1024}, Case{LightSelection::Bvh, LightSampling::LightsOnly, 1024},
        Case{LightSelection::Power, LightSampling::Mis, 6144},
        Case{LightSelection::Uniform, LightSampling::Mis, 6144}}) {
    SCOPED_TRACE(static_cast<int>(c.selection));
    EstimatorSettings estimator{.filter = PixelFilter::Box, .lightSampling = c.sampling, .seed = 54};
    estimator.lightSelection = c.selection;
    const Image image = renderImage(many.scene, sensorAt({0, 0, 0}), 8, 8, c.samples, {.estimator = estimator});
    EXPECT_TRUE(pixelMeanIs(image, "R", many.irradiance / kPi, 0.01));
  }
}

// The setting for scenes of many lights costs a scene of few nothing and changes no bit.
TEST(RenderLightSelection, FewLightsAreChosenByPower) {
  const Scene scene = squareLightOverFloor(1);
  const auto render = [&](LightSelection selection) {
    EstimatorSettings estimator{.seed = 3};
    estimator.lightSelection = selection;
    return renderImage(scene, sensorAt({0.3, 0, 0}), 8, 8, 16, {.estimator = estimator});
  };
  EXPECT_TRUE(bitIdentical(render(LightSelection::Bvh), render(LightSelection::Power)));
}

TEST(RenderLightSelection, AllFeatureKernelsChooseTheSameLights) {
  const ManyLights many;
  const auto render = [&](bool specialize) {
    RenderOptions options;
    options.execution.specialize = specialize;
    return renderImage(many.scene, sensorAt({0.3, 0, 0}), 8, 8, 16, options);
  };
  EXPECT_TRUE(bitIdentical(render(true), render(false)));
}

} // namespace
} // namespace isophote
