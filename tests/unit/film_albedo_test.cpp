#include "upload/film_albedo.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "oracle/bsdf_metallic_roughness.hpp"
#include "shared/bsdf_constants.h"

using namespace isophote;

namespace {

// The device's lookup, shaders/bsdf/film_albedo.glsl, in double.
glm::dvec3 lookup(const std::vector<glm::vec3>& table, double thickness, double roughness, double mu) {
  const auto axis = [](const glm::vec3& range, double x) {
    return (x - double(range.x)) / double(range.y - range.x) * (double(range.z) - 1);
  };
  const double t = axis(table[0], thickness), r = axis(table[1], roughness);
  const auto count = uint32_t(table[0].z);
  const auto plane = [&](uint32_t i, uint32_t j) {
    const double position = std::sqrt(mu) * (gpu::kFilmMuCount - 1);
    const uint32_t c = std::min(uint32_t(position), gpu::kFilmMuCount - 2);
    const uint32_t first = gpu::kFilmHeader + (j * count + i) * gpu::kFilmPlane + c;
    return glm::mix(glm::dvec3(table[first]), glm::dvec3(table[first + 1]), position - c);
  };
  const auto i = uint32_t(t), j = uint32_t(r);
  return glm::mix(glm::mix(plane(i, j), plane(i + 1, j), t - i), glm::mix(plane(i, j + 1), plane(i + 1, j + 1), t - i),
                  r - j);
}

} // namespace

TEST(FilmAlbedo, InterpolationMatchesQuadrature) {
  double worst = 0;
  for (const float ior : {1.3f, 2.2f}) {
    const FilmSurface surface{.ior = ior, .thickness = {100, 700}, .roughness = {0, 1}};
    const std::vector<glm::vec3>& table = filmAlbedoTable(surface);
    ASSERT_EQ(table.size(), filmAlbedoSize(surface));
    for (const double thickness : {133.0, 341.0, 678.0}) {
      for (const double roughness : {0.11, 0.35, 0.83}) {
        oracle::MetallicRoughness m = oracle::metallicRoughness(glm::dvec3(1), 0, roughness, 1.5, 1, glm::dvec3(1));
        m = oracle::withFilm(m, {1, double(ior), thickness});
        for (const double mu : {0.05, 0.31, 0.97}) {
          const glm::dvec3 expected = oracle::coatReflected(m, mu);
          const glm::dvec3 actual = lookup(table, thickness, roughness, mu);
          for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(actual[k], expected[k], 5e-3) << ior << " " << thickness << " " << roughness << " " << mu;
            worst = std::max(worst, std::abs(actual[k] - expected[k]));
          }
        }
      }
    }
  }
  RecordProperty("worst", std::to_string(worst));
}
