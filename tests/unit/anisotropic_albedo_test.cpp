#include "upload/anisotropic_albedo.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "oracle/bsdf_facets.hpp"
#include "shared/bsdf_constants.h"

using namespace isophote;

namespace {

// The device's lookup, shaders/bsdf/anisotropic_albedo.glsl, in double.
class Lookup {
public:
  explicit Lookup(const AnisotropicSurface& surface) : surface_(surface), table_(anisotropicAlbedoTable(surface)) {}

  [[nodiscard]] glm::dvec2 at(double roughness, double strength, const glm::dvec3& w) const {
    const glm::dvec2 root = glm::sqrt(anisotropicWidth(roughness, strength));
    const glm::dvec2 flat = glm::normalize(glm::dvec2(w));
    const double seen = std::sqrt(glm::length(root * root * flat));
    const glm::dvec2 position(std::sqrt(w.z) * (gpu::kAnisotropyMuCount - 1),
                              root.x > root.y ? (seen - root.y) / (root.x - root.y) * (gpu::kAnisotropyAzimuthCount - 1)
                                              : 0);
    return between(roughness, strength, [&](uint32_t plane) {
      const uint32_t c = std::min(uint32_t(position.x), gpu::kAnisotropyMuCount - 2);
      const uint32_t a = std::min(uint32_t(position.y), gpu::kAnisotropyAzimuthCount - 2);
      const auto item = [&](uint32_t row, uint32_t column) {
        return glm::dvec2(table_[plane + row * gpu::kAnisotropyMuCount + column]);
      };
      return glm::mix(glm::mix(item(a, c), item(a, c + 1), position.x - c),
                      glm::mix(item(a + 1, c), item(a + 1, c + 1), position.x - c), position.y - a);
    });
  }

  [[nodiscard]] glm::dvec2 mean(double roughness, double strength) const {
    return between(roughness, strength,
                   [&](uint32_t plane) { return glm::dvec2(table_[plane + gpu::kAnisotropyMean]); });
  }

private:
  template <class Read> [[nodiscard]] glm::dvec2 between(double roughness, double strength, const Read& read) const {
    const auto place = [](const glm::vec2& range, double x, uint32_t most) {
      if (range.x == range.y) return std::pair(0.0, 1u);
      return std::pair((x - double(range.x)) / double(range.y - range.x) * (most - 1), most);
    };
    const auto [r, roughnesses] = place(surface_.roughness, roughness, gpu::kAnisotropyRoughnessCount);
    const auto [s, strengths] = place(surface_.strength, strength, gpu::kAnisotropyStrengthCount);
    const auto plane = [&, count = roughnesses, most = strengths](uint32_t i, uint32_t j) {
      return read(gpu::kAnisotropyHeader +
                  (std::min(j, most - 1) * count + std::min(i, count - 1)) * gpu::kAnisotropyPlane);
    };
    const auto i = uint32_t(r), j = uint32_t(s);
    return glm::mix(glm::mix(plane(i, j), plane(i + 1, j), r - i),
                    glm::mix(plane(i, j + 1), plane(i + 1, j + 1), r - i), s - j);
  }

  AnisotropicSurface surface_;
  const std::vector<glm::vec2>& table_;
};

glm::dvec3 direction(double mu, double phi) {
  const double sine = std::sqrt(1 - mu * mu);
  return {sine * std::cos(phi), sine * std::sin(phi), mu};
}

// Over a low-discrepancy set in sqrt(mu) and azimuth. The oracle is good to 1e-4.
glm::dvec2 worstError(const Lookup& lookup, double roughness, double strength, int count) {
  const glm::dvec2 width = anisotropicWidth(roughness, strength);
  glm::dvec2 worst(0);
  for (int i = 1; i <= count; ++i) {
    const double x = 0.1 + 0.9 * std::fmod(i * 0.7548776662466927, 1);
    const glm::dvec3 w = direction(x * x, 1.5707 * std::fmod(i * 0.5698402909980532, 1));
    worst = glm::max(worst, glm::abs(lookup.at(roughness, strength, w) - oracle::facetAlbedo({}, w, width, 120)));
  }
  return worst;
}

} // namespace

TEST(AnisotropicAlbedo, OneRoughnessAndStrengthMatchQuadrature) {
  for (const auto& [roughness, strength] : {std::pair(0.2, 0.5), {0.3, 1.0}, {0.5, 0.7}, {0.8, 1.0}}) {
    const Lookup lookup({glm::vec2(float(roughness)), glm::vec2(float(strength))});
    const glm::dvec2 worst = worstError(lookup, double(float(roughness)), double(float(strength)), 12);
    EXPECT_LT(worst.x, 5e-3) << roughness << " " << strength;
    EXPECT_LT(worst.y, 2e-3) << roughness << " " << strength;
    RecordProperty("roughness" + std::to_string(roughness), std::to_string(worst.x) + " " + std::to_string(worst.y));
  }
}

// Where textures give roughness and strength, the table spans all that they can.
TEST(AnisotropicAlbedo, RangesMatchQuadratureSlow) {
  const Lookup lookup({{0, 1}, {0, 1}});
  glm::dvec2 worst(0);
  for (const auto& [roughness, strength] : {std::pair(0.17, 0.4), {0.37, 0.93}, {0.61, 0.55}, {0.9, 0.25}}) {
    worst = glm::max(worst, worstError(lookup, roughness, strength, 8));
  }
  EXPECT_LT(worst.x, 1e-2);
  EXPECT_LT(worst.y, 1e-2);
  RecordProperty("worst", std::to_string(worst.x) + " " + std::to_string(worst.y));
}

// The mean is that of what is read, so that what the lobes restore is exactly what they lose.
TEST(AnisotropicAlbedo, MeanIsThatOfTheTable) {
  const double roughness = 0.3f, strength = 0.8f;
  const Lookup lookup({glm::vec2(0.3f), glm::vec2(0.8f)});
  constexpr int kSide = 400;
  glm::dvec2 sum(0);
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const double mu = std::sqrt((i + 0.5) / kSide); // 2 mu dmu
      sum += lookup.at(roughness, strength, direction(mu, 1.5707963267948966 * (j + 0.5) / kSide));
    }
  }
  sum /= double(kSide * kSide);
  EXPECT_NEAR(sum.x, lookup.mean(roughness, strength).x, 1e-4);
  EXPECT_NEAR(sum.y, lookup.mean(roughness, strength).y, 1e-4);
}
