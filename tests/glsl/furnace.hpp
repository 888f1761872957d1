// The white furnace for single surfaces: what a lossless material's samples weigh on the average.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "glsl/bsdf_material_cases.hpp"
#include "support/statistics.hpp"

namespace isophote::test {

/// Weights times eta^2 by channel, whose mean is the directional albedo, at points of a rank-3 lattice (Roberts 2018).
inline std::vector<std::array<Moments, 3>> sampledWeights(const std::vector<gpu::BsdfCase>& materials,
                                                          std::span<const gpu::SpecConstant> constants, int count) {
  const glm::dvec3 step(0.8191725133961645, 0.6710436067037893, 0.5497004779019703);
  std::vector<std::array<Moments, 3>> result(materials.size());
  const size_t atOnce = std::max<size_t>(2'000'000 / size_t(count), 1);
  for (size_t first = 0; first < materials.size(); first += atOnce) {
    std::vector<gpu::BsdfCase> cases;
    for (size_t m = first; m < std::min(first + atOnce, materials.size()); ++m) {
      for (int i = 1; i <= count; ++i) {
        const glm::vec3 u(glm::fract(step * double(i)) * (1 - 1e-7));
        cases.push_back(materials[m]);
        cases.back().uLobe = u.x;
        cases.back().u = {u.y, u.z};
      }
    }
    const auto results = probeBsdf(std::move(cases), constants);
    for (size_t i = 0; i < results.size(); ++i) {
      const double eta = results[i].eta;
      const bool isValid = (results[i].flags & gpu::kBsdfValid) != 0;
      for (int k = 0; k < 3; ++k)
        result[first + i / size_t(count)][size_t(k)].add(isValid ? double(results[i].weight[k]) * eta * eta : 0);
    }
  }
  return result;
}

/// Each case sends back all light, to 1% and the standard error, which is below 0.8%.
///
/// What facets with few steep slopes lose leaves near the horizon, where a cosine seldom goes:
/// such weights vary much, and get 40 times the points. The lattice's error is below the standard error of random
/// points.
inline void expectAllLight(const std::vector<gpu::BsdfCase>& cases, const std::vector<std::string>& labels,
                           std::span<const gpu::SpecConstant> constants, const std::string& name) {
  std::vector<Moments> albedo;
  for (const auto& weights : sampledWeights(cases, constants, 8000)) albedo.push_back(weights[1]);
  std::vector<size_t> noisy;
  std::vector<gpu::BsdfCase> again;
  for (size_t i = 0; i < cases.size(); ++i) {
    if (albedo[i].standardError() < 0.006) continue;
    noisy.push_back(i);
    again.push_back(cases[i]);
  }
  const auto better = sampledWeights(again, constants, 320000);
  for (size_t i = 0; i < noisy.size(); ++i) albedo[noisy[i]] = better[i][1];
  double worst = 0;
  for (size_t i = 0; i < cases.size(); ++i) {
    const double error = albedo[i].standardError();
    EXPECT_LT(error, 0.008) << labels[i];
    EXPECT_NEAR(albedo[i].mean(), 1, 0.01 + error) << labels[i];
    worst = std::max(worst, std::abs(albedo[i].mean() - 1));
  }
  testing::Test::RecordProperty("worst, " + name, std::to_string(worst));
}

} // namespace isophote::test
