// Does sampleBsdf draw what pdfBsdf says, and weigh it by what evalBsdf says?
#include <numbers>

#include <gtest/gtest.h>

#include "glsl/bsdf_material_cases.hpp"
#include "support/statistics.hpp"

using namespace isophote;
using gpu::BsdfCase;
using gpu::BsdfResult;
using std::numbers::pi;

namespace {

// Bins over wi by its half vector wm with wo: the cosine c and azimuth of the normal that is stretched by 1 / width,
// twice the lobe's alpha, so that both the specular peak and the diffuse lobe spread over many bins.
class HalfVectorGrid {
public:
  static constexpr int kBins = 23;  // odd: bins do not end at the horizon of wo = z
  static constexpr int kNodes = 12; // per bin and axis

  HalfVectorGrid(const glm::dvec3& wo, double alpha) : wo_(wo), width_(std::min(2 * alpha, 1.0)) {}

  [[nodiscard]] size_t binOf(const glm::dvec3& wi) const {
    const glm::dvec3 wm = glm::normalize(wo_ + wi);
    const double c = wm.z / std::sqrt(wm.z * wm.z + (wm.x * wm.x + wm.y * wm.y) / (width_ * width_));
    const double turn = std::atan2(wm.y, wm.x) / (2 * pi) + 0.5;
    return size_t(std::min(int(c * kBins), kBins - 1) * kBins + std::min(int(turn * kBins), kBins - 1));
  }

  struct Node {
    size_t bin;
    glm::dvec3 wi;
    double solidAngle;
  };

  /// Midpoints whose reflection lies above the horizon, with their solid angle of wi.
  [[nodiscard]] std::vector<Node> nodes() const {
    std::vector<Node> result;
    const int side = kBins * kNodes;
    for (int i = 0; i < side * side; ++i) {
      const double c = (i / side + 0.5) / side;
      const double phi = 2 * pi * ((i % side + 0.5) / side - 0.5);
      const double slope = width_ * std::sqrt(1 / (c * c) - 1);
      const glm::dvec3 wm = glm::normalize(glm::dvec3(slope * std::cos(phi), slope * std::sin(phi), 1));
      const double cosine = glm::dot(wo_, wm);
      const glm::dvec3 wi = 2 * cosine * wm - wo_;
      if (cosine <= 0 || wi.z <= 0) continue;
      // tan = width sqrt(1 / c^2 - 1): dwm = wm.z^3 d(tan^2) dphi / 2 = wm.z^3 width^2 / c^3 dc dphi; dwi = 4 cos dwm.
      const double normals = std::pow(wm.z, 3) * width_ * width_ / std::pow(c, 3) * 2 * pi / (double(side) * side);
      result.push_back({size_t(i / side / kNodes * kBins + i % side / kNodes), wi, 4 * cosine * normals});
    }
    return result;
  }

private:
  glm::dvec3 wo_;
  double width_;
};

struct Configuration {
  BsdfCase material;
  std::string label;
};

std::vector<Configuration> configurations() {
  std::vector<Configuration> result;
  for (const float alpha : {0.05f, 0.1f, 0.3f, 0.5f, 1.0f}) {
    const float roughness = std::sqrt(alpha);
    for (const auto& base : {test::metal(roughness), test::dielectric(roughness), test::mixedMaterial(roughness)}) {
      for (const double cosine : {1.0, 0.8, 0.5, 0.2, 0.05}) {
        BsdfCase c = base;
        c.wo = test::directionOf(cosine, 0.6);
        result.push_back({c, test::describe(c)});
      }
    }
  }
  return result;
}

std::vector<BsdfCase> sampleCases(const BsdfCase& material, size_t count, uint32_t seed) {
  std::mt19937 generator(seed);
  std::vector<BsdfCase> cases(count, material);
  for (BsdfCase& c : cases) test::drawUniforms(c, generator);
  return cases;
}

bool isValid(const BsdfResult& result) { return (result.flags & gpu::kBsdfValid) != 0; }

// What one configuration's samples and density say of each other.
struct Comparison {
  double mass = 0;     // integral of the density
  double absorbed = 0; // share of invalid samples
  test::ChiSquareResult chiSquare;
};

Comparison compareSamplesToDensity(const BsdfCase& material, size_t count, uint32_t seed) {
  const HalfVectorGrid grid(glm::dvec3(material.wo), double(material.roughness) * double(material.roughness));
  const auto nodes = grid.nodes();
  auto cases = sampleCases(material, count, seed);
  for (const auto& node : nodes) {
    cases.push_back(material);
    cases.back().wi = glm::vec3(node.wi);
  }
  const auto results = test::probeBsdf(cases);

  const size_t absorbedBin = HalfVectorGrid::kBins * HalfVectorGrid::kBins;
  Comparison comparison;
  std::vector<uint64_t> observed(absorbedBin + 1);
  for (size_t i = 0; i < count; ++i) {
    ++observed[isValid(results[i]) ? grid.binOf(glm::dvec3(results[i].sampledWi)) : absorbedBin];
  }
  std::vector<double> expected(absorbedBin + 1);
  for (size_t i = 0; i < nodes.size(); ++i) {
    const double probability = double(results[count + i].pdf) * nodes[i].solidAngle;
    expected[nodes[i].bin] += double(count) * probability;
    comparison.mass += probability;
  }
  comparison.absorbed = double(observed[absorbedBin]) / double(count);
  expected[absorbedBin] = double(count) * std::max(1 - comparison.mass, 0.0);
  // Bins that the horizon cuts to slivers may have no midpoint inside: they share one pool, so that their samples count
  // against the slivers that have.
  for (size_t i = 0; i < absorbedBin; ++i) {
    if (expected[i] >= 5) continue;
    expected[absorbedBin] += expected[i];
    observed[absorbedBin] += observed[i];
    expected[i] = 0;
    observed[i] = 0;
  }
  comparison.chiSquare = test::chiSquareTest(observed, expected);
  return comparison;
}

} // namespace

// Significance 1e-3 over the 75 configurations (Sidak). With 1e5 samples in 530 bins (the last: absorbed, and slivers)
// a density that is off by 4% root mean square is rejected; its integral is held to 1 within 3e-3 besides.
/// Every `stride`th configuration.
static void expectSamplesFollowTheDensity(size_t stride) {
  const size_t count = 100000;
  const auto all = configurations();
  const double significance = test::sidak(1e-3, all.size());
  uint32_t seed = 1;
  for (size_t i = 0; i < all.size(); i += stride) {
    const Configuration& configuration = all[i];
    const Comparison result = compareSamplesToDensity(configuration.material, count, seed++);
    const double deviation = std::sqrt(result.absorbed * (1 - result.absorbed) / double(count));
    EXPECT_NEAR(result.mass + result.absorbed, 1, 1e-3 + 4.5 * deviation) << configuration.label;
    EXPECT_GT(result.chiSquare.p, significance)
        << configuration.label << ": " << result.chiSquare.statistic << " of " << result.chiSquare.degreesOfFreedom;
  }
}

TEST(Bsdf, SamplesFollowTheDensityWhichIntegratesToOne) { expectSamplesFollowTheDensity(7); }

TEST(Bsdf, SamplesFollowTheDensityWhichIntegratesToOneSlow) { expectSamplesFollowTheDensity(1); }

TEST(Bsdf, SampleWeightIsValueOverDensity) {
  std::vector<BsdfCase> cases;
  for (const Configuration& configuration : configurations()) {
    const auto more = sampleCases(configuration.material, 500, 99);
    cases.insert(cases.end(), more.begin(), more.end());
  }
  const auto results = test::probeBsdf(cases);
  for (size_t i = 0; i < cases.size(); ++i) {
    const BsdfResult& result = results[i];
    if (!isValid(result)) continue;
    EXPECT_NEAR(result.sampledPdf, result.pdfAtSampled, 1e-4 * double(result.pdfAtSampled)) << test::describe(cases[i]);
    for (int c = 0; c < 3; ++c) {
      const double value = double(result.fCosSampled[c]);
      EXPECT_NEAR(double(result.weight[c] * result.pdfAtSampled), value, 1e-4 * value) << test::describe(cases[i]);
    }
  }
}

TEST(Bsdf, SamplesAreFiniteForExtremeRandomNumbersAndDirections) {
  const float last = 1 - std::ldexp(1.0f, -24);
  std::vector<BsdfCase> cases;
  for (const float roughness : {0.0f, 0.0071f, 0.05f, 0.3f, 1.0f}) {
    for (const auto& base : {test::metal(roughness), test::dielectric(roughness), test::mixedMaterial(roughness)}) {
      for (const double cosine : {0.0, 1e-30, 1e-8, 1e-6, 1e-3, 0.05, 0.7, 1.0}) {
        for (int i = 0; i < 27; ++i) {
          const float values[] = {0, std::ldexp(1.0f, -24), last};
          BsdfCase c = base;
          c.wo = test::directionOf(cosine, 2);
          c.wi = test::directionOf(std::pow(10.0, -i), 2 + pi);
          c.uLobe = values[i % 3];
          c.u = {values[i / 3 % 3], values[i / 9]};
          cases.push_back(c);
        }
      }
    }
  }
  const auto results = test::probeBsdf(cases);
  for (size_t i = 0; i < cases.size(); ++i) {
    const BsdfResult& result = results[i];
    const std::string label = test::describe(cases[i]);
    for (int c = 0; c < 3; ++c) {
      EXPECT_TRUE(std::isfinite(result.fCos[c]) && result.fCos[c] >= 0) << label;
      EXPECT_TRUE(std::isfinite(result.weight[c]) && result.weight[c] >= 0) << label;
    }
    EXPECT_TRUE(std::isfinite(result.pdf) && result.pdf >= 0) << label;
    if (!isValid(result)) continue;
    EXPECT_NEAR(double(glm::length(glm::dvec3(result.sampledWi))), 1, 2e-6) << label;
    EXPECT_GT(result.sampledWi.z, 0) << label;
    if ((result.flags & gpu::kBsdfDelta) == 0) {
      EXPECT_GT(result.sampledPdf, 0) << label;
    }
  }
}

TEST(Bsdf, MirrorReflectsExactlyAndKeepsTheDiffuseLobeContinuous) {
  for (const double cosine : {1.0, 0.6, 0.1}) {
    BsdfCase material = test::dielectric(0.005f); // alpha 2.5e-5
    material.wo = test::directionOf(cosine, 1);
    const oracle::MetallicRoughness m = test::oracleMaterial(material);
    const double grazing = std::pow(1 - double(material.wo.z), 5);
    const double reflectance = 0.04 + 0.96 * grazing;
    test::Moments deltaShare;
    for (const BsdfResult& result : test::probeBsdf(sampleCases(material, 20000, 5))) {
      ASSERT_TRUE(isValid(result));
      const bool delta = (result.flags & gpu::kBsdfDelta) != 0;
      deltaShare.add(delta ? 1 : 0);
      if (delta) {
        EXPECT_EQ(result.sampledWi, glm::vec3(-material.wo.x, -material.wo.y, material.wo.z));
        EXPECT_EQ(result.sampledPdf, 0);
        continue;
      }
      const glm::dvec3 expected = oracle::evalBsdf(m, glm::dvec3(material.wo), glm::dvec3(result.sampledWi));
      const double tolerance = 2e-3 * double(material.baseColor.x * result.sampledWi.z) / pi; // the albedo table's
      EXPECT_NEAR(double(result.fCosSampled.x), expected.x, tolerance);
      EXPECT_NEAR(double(result.weight.x * result.sampledPdf), expected.x, tolerance);
    }
    const double luminance = 0.2126 * 0.3 + 0.7152 * 0.7 + 0.0722 * 0.5;
    const double share = reflectance / (reflectance + (1 - reflectance) * luminance);
    EXPECT_NEAR(deltaShare.mean(), share, 5 * deltaShare.standardError() + 1e-3) << cosine;
  }
}
