// Transmission: values, reciprocity, sampling, Snell's law, and the limits in which glass is not there.
#include <numbers>

#include <gtest/gtest.h>

#include "glsl/bsdf_material_cases.hpp"
#include "render/setting_ids.hpp"
#include "support/statistics.hpp"

using namespace isophote;
using gpu::BsdfCase;
using gpu::BsdfResult;
using std::numbers::pi;
using test::Side;

namespace {

constexpr Side kSides[] = {Side::Outside, Side::Inside, Side::ThinWall};

// Bins over the facet's normal wm and over the side to which it scatters. wm is binned by its cosine and azimuth when
// stretched by 1 / width, so that narrow lobes spread over many bins.
class FacetGrid {
public:
  static constexpr int kBins = 23;
  static constexpr int kNodes = 10; // per bin and axis
  static constexpr size_t kBinCount = size_t{2} * kBins * kBins;

  explicit FacetGrid(const BsdfCase& c)
      : wo_(c.wo), width_(std::min(2 * double(c.roughness) * double(c.roughness), 1.0)),
        eta_(c.thinWalled != 0 ? 0 : (c.backFace != 0 ? 1 / double(c.ior) : double(c.ior))) {}

  [[nodiscard]] size_t binOf(const glm::dvec3& wi) const {
    const bool below = wi.z < 0;
    glm::dvec3 wm = wo_ + (below && eta_ == 0 ? glm::dvec3(wi.x, wi.y, -wi.z) : wi);
    if (below && eta_ != 0) wm = wo_ + eta_ * wi;
    wm = glm::normalize(wm.z < 0 ? -wm : wm);
    const double c = wm.z / std::sqrt(wm.z * wm.z + (wm.x * wm.x + wm.y * wm.y) / (width_ * width_));
    const double turn = std::atan2(wm.y, wm.x) / (2 * pi) + 0.5;
    return size_t((below ? kBins : 0) + std::min(int(c * kBins), kBins - 1)) * kBins +
           size_t(std::min(int(turn * kBins), kBins - 1));
  }

  struct Node {
    size_t bin;
    glm::dvec3 wi;
    double solidAngle;
  };

  [[nodiscard]] std::vector<Node> nodes() const {
    std::vector<Node> result;
    const int side = kBins * kNodes;
    for (int i = 0; i < side * side; ++i) {
      const double c = (i / side + 0.5) / side;
      const double phi = 2 * pi * ((i % side + 0.5) / side - 0.5);
      const double slope = width_ * std::sqrt(1 / (c * c) - 1);
      const glm::dvec3 wm = glm::normalize(glm::dvec3(slope * std::cos(phi), slope * std::sin(phi), 1));
      const double cosine = glm::dot(wo_, wm);
      if (cosine <= 0) continue;
      // tan = width sqrt(1 / c^2 - 1): dwm = wm.z^3 d(tan^2) dphi / 2 = wm.z^3 width^2 / c^3 dc dphi.
      const double normals = std::pow(wm.z, 3) * width_ * width_ / std::pow(c, 3) * 2 * pi / (double(side) * side);
      const size_t bin = size_t(i / side / kNodes * kBins + i % side / kNodes);
      const glm::dvec3 reflected = 2 * cosine * wm - wo_;
      if (reflected.z > 0) result.push_back({bin, reflected, 4 * cosine * normals});
      const size_t below = bin + kBinCount / 2;
      if (eta_ == 0) {
        if (reflected.z > 0) result.push_back({below, {reflected.x, reflected.y, -reflected.z}, 4 * cosine * normals});
        continue;
      }
      const double cosine2 = 1 - (1 - cosine * cosine) / (eta_ * eta_);
      if (cosine2 <= 0) continue;
      const glm::dvec3 wi = -wo_ / eta_ + (cosine / eta_ - std::sqrt(cosine2)) * wm;
      if (wi.z >= 0) continue;
      const glm::dvec3 sum = wo_ + eta_ * wi;
      result.push_back({below, wi, normals * glm::dot(sum, sum) / (eta_ * eta_ * std::sqrt(cosine2))});
    }
    return result;
  }

private:
  glm::dvec3 wo_;
  double width_;
  double eta_; // 0: thin wall
};

std::vector<BsdfCase> sampleCases(const BsdfCase& material, size_t count, uint32_t seed) {
  std::mt19937 generator(seed);
  std::vector<BsdfCase> cases(count, material);
  for (BsdfCase& c : cases) test::drawUniforms(c, generator);
  return cases;
}

bool isValid(const BsdfResult& result) { return (result.flags & gpu::kBsdfValid) != 0; }
bool isDelta(const BsdfResult& result) { return (result.flags & gpu::kBsdfDelta) != 0; }

// Glass of every kind with wi scattered by a random facet, to either side.
std::vector<BsdfCase> randomCases(size_t count, uint32_t seed) {
  std::mt19937 generator(seed);
  std::vector<BsdfCase> cases;
  while (cases.size() < count) {
    const auto u = [&generator] { return double(test::uniform(generator)); };
    BsdfCase c = test::glass(float(std::lerp(0.1, 1.0, u())), kSides[generator() % 3], {0.9f, 0.5f, 0.7f});
    const float iors[] = {1.5f, 1.1f, 1.33f, 2.4f};
    c.ior = iors[generator() % 4];
    if (generator() % 3 == 0) {
      c.transmission = float(u());
      c.metallic = float(u());
      c.specular = float(u());
      c.specularColor = {1, 0.5f, float(u())};
    }
    c.wo = test::directionOf(0.05 + 0.95 * u(), 2 * pi * u());
    const FacetGrid grid(c);
    const double slope = double(c.roughness * c.roughness) * 3 * u();
    const double phi = 2 * pi * u();
    const glm::dvec3 wm = glm::normalize(glm::dvec3(slope * std::cos(phi), slope * std::sin(phi), 1));
    const glm::dvec3 wo(c.wo);
    const double cosine = glm::dot(wo, wm);
    glm::dvec3 wi = 2 * cosine * wm - wo;
    if (generator() % 4 != 0) {
      if (c.thinWalled != 0) {
        wi.z = -wi.z;
      } else {
        const double eta = c.backFace != 0 ? 1 / double(c.ior) : double(c.ior);
        const double cosine2 = 1 - (1 - cosine * cosine) / (eta * eta);
        if (cosine2 <= 0) continue;
        wi = glm::normalize(-wo / eta + (cosine / eta - std::sqrt(cosine2)) * wm);
      }
    }
    c.wi = glm::vec3(wi);
    if (cosine > 0.02 && std::abs(wi.z) > 0.05) cases.push_back(c);
  }
  return cases;
}

} // namespace

// The facet of refraction is known to 1e-7 / |eta - 1| and D turns that into 1e-7 / (|eta - 1| alpha) of itself, here
// at most 1e-4; the exact Fresnel reflectance has a pole in its slope at total reflection (docs/bsdf.md). Multiple
// scattering comes from tables, known to 1e-2 of a white diffuse lobe, times the squared index ratio of radiance.
TEST(BsdfGlass, ValuesAndDensitiesMatchTheOracle) {
  const auto cases = randomCases(15000, 11);
  for (const bool multiple : {false, true}) {
    const gpu::SpecConstant constants[] = {{setting_id::kMultipleScattering, multiple ? 1u : 0u}};
    const auto results = test::probeBsdf(cases, constants);
    int transmitted = 0;
    for (size_t i = 0; i < cases.size(); ++i) {
      const BsdfCase& c = cases[i];
      oracle::MetallicRoughness m = test::oracleMaterial(c);
      m.multipleScattering = multiple;
      const glm::dvec3 wo(c.wo), wi(c.wi);
      const glm::dvec3 expected = oracle::evalBsdf(m, wo, wi);
      const double density = oracle::pdfBsdf(m, wo, wi);
      if (wi.z < 0 && density > 0) ++transmitted;
      const double lobe = std::abs(wi.z) / pi * (c.backFace != 0 ? double(c.ior) * double(c.ior) : 1.0);
      const double table = multiple ? 1e-2 * lobe : (wi.z < 0 ? 0 : 2e-3 * lobe);
      for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(double(results[i].fCos[k]), expected[k], 1e-3 * expected[k] + table + 1e-6) << test::describe(c);
      EXPECT_NEAR(double(results[i].pdf), density, 5e-3 * density + 3e-3 + (multiple ? 1e-2 * lobe : 0))
          << test::describe(c);
    }
    EXPECT_GT(transmitted, 7000);
  }
}

// f(i -> o) / n_o^2 = f(o -> i) / n_i^2 (Veach 1997, section 5.2), the inner direction's surface seen from the back.
TEST(BsdfGlass, Test8IsReciprocal) {
  auto cases = randomCases(10000, 12);
  std::erase_if(cases, [](const BsdfCase& c) { return c.wi.z >= 0 || c.backFace != 0; });
  std::vector<BsdfCase> reversed = cases;
  for (BsdfCase& c : reversed) {
    const glm::vec3 wo = c.wo;
    c.wo = {c.wi.x, c.wi.y, -c.wi.z};
    c.wi = {wo.x, wo.y, -wo.z};
    c.backFace = c.thinWalled == 0 ? 1 : 0;
  }
  const auto forward = test::probeBsdf(cases);
  const auto backward = test::probeBsdf(reversed);
  for (size_t i = 0; i < cases.size(); ++i) {
    const BsdfCase& c = cases[i];
    const bool thin = c.thinWalled != 0;
    const double n = thin ? 1 : double(c.ior);
    // Sixteen roundings, 2^-20. They turn a facet's normal by that over the length of the sum that it is the direction
    // of, where the density of normals falls by up to 2 / alpha a radian. From inside, the squared cosine outside is
    // 1 - n^2 sin^2: it loses n^2 times as much, and what is transmitted follows the cosine where that is small.
    const glm::dvec3 sum = glm::dvec3(c.wo) + (thin ? glm::dvec3(c.wi.x, c.wi.y, -c.wi.z) : n * glm::dvec3(c.wi));
    const double alpha = double(c.roughness) * double(c.roughness);
    const double facing = std::abs(glm::dot(glm::dvec3(c.wo), glm::normalize(sum)));
    const double relative = 2e-5 + 0x1p-20 * (2 / (alpha * glm::length(sum)) + n * n / (facing * facing));
    for (int k = 0; k < 3; ++k) {
      const double there = double(forward[i].fCos[k]) / -double(c.wi.z);
      const double back = double(backward[i].fCos[k]) / double(c.wo.z) / (n * n);
      EXPECT_NEAR(there, back, relative * there + 1e-7) << test::describe(c);
    }
  }
}

// Significance 1e-3 over the configurations (Sidak). With 5e4 samples in up to 1058 bins, a density that is off by 6%
// root mean square is rejected; its integral is held to 1 within 3e-3 besides.
/// Every `stride`th configuration.
static void expectSamplesFollowTheDensity(size_t stride) {
  const size_t count = 50000;
  std::vector<BsdfCase> configurations;
  for (const float alpha : {0.05f, 0.3f, 1.0f}) {
    for (const Side side : kSides) {
      for (const double cosine : {1.0, 0.6, 0.05}) {
        BsdfCase c = test::glass(std::sqrt(alpha), side, {0.9f, 0.5f, 0.7f});
        c.wo = test::directionOf(cosine, 0.6);
        configurations.push_back(c);
        if (cosine != 0.6) continue;
        c.transmission = 0.6f;
        configurations.push_back(c);
      }
    }
  }
  const double significance = test::sidak(1e-3, configurations.size());
  uint32_t seed = 1;
  for (size_t k = 0; k < configurations.size(); k += stride) {
    const BsdfCase& material = configurations[k];
    const std::string label =
        test::describe(material) + " side " + std::to_string(material.backFace) + std::to_string(material.thinWalled);
    const FacetGrid grid(material);
    const auto nodes = grid.nodes();
    auto cases = sampleCases(material, count, seed++);
    for (const auto& node : nodes) {
      cases.push_back(material);
      cases.back().wi = glm::vec3(node.wi);
    }
    const gpu::SpecConstant facetsOnly[] = {{setting_id::kMultipleScattering, 0}}; // its lobe goes where no facet does
    const auto results = test::probeBsdf(cases, facetsOnly);
    std::vector<uint64_t> observed(FacetGrid::kBinCount + 1);
    for (size_t i = 0; i < count; ++i)
      ++observed[isValid(results[i]) ? grid.binOf(glm::dvec3(results[i].sampledWi)) : FacetGrid::kBinCount];
    std::vector<double> expected(observed.size());
    double mass = 0;
    for (size_t i = 0; i < nodes.size(); ++i) {
      const double probability = double(results[count + i].pdf) * nodes[i].solidAngle;
      expected[nodes[i].bin] += double(count) * probability;
      mass += probability;
    }
    const double absorbed = double(observed.back()) / double(count);
    EXPECT_NEAR(mass + absorbed, 1, 1e-3 + 4.5 * std::sqrt(absorbed * (1 - absorbed) / double(count))) << label;
    expected.back() = double(count) * std::max(1 - mass, 0.0);
    for (size_t i = 0; i < FacetGrid::kBinCount; ++i) { // slivers share the last pool
      if (expected[i] >= 5) continue;
      expected.back() += expected[i];
      observed.back() += observed[i];
      expected[i] = 0;
      observed[i] = 0;
    }
    const auto chiSquare = test::chiSquareTest(observed, expected);
    EXPECT_GT(chiSquare.p, significance) << label << ": " << chiSquare.statistic << " of "
                                         << chiSquare.degreesOfFreedom;
  }
}

TEST(BsdfGlass, Test2SamplesFollowTheDensityWhichIntegratesToOne) { expectSamplesFollowTheDensity(5); }

TEST(BsdfGlass, Test2SamplesFollowTheDensityWhichIntegratesToOneSlow) { expectSamplesFollowTheDensity(1); }

// Multiple scattering included: midpoints over the whole sphere, for lobes that are broad enough for them.
TEST(BsdfGlass, Test3TheDensityOverBothSidesIntegratesToOne) {
  constexpr int kRows = 320, kColumns = 240, kSamples = 20000;
  for (const Side side : kSides) {
    BsdfCase material = test::glass(0.9f, side);
    material.wo = test::directionOf(0.7, 0.6);
    auto cases = sampleCases(material, kSamples, 3);
    for (int i = 0; i < kRows * kColumns; ++i) {
      cases.push_back(material);
      cases.back().wi =
          test::directionOf(-1 + 2 * (i / kColumns + 0.5) / kRows, 2 * pi * (i % kColumns + 0.5) / kColumns);
    }
    const auto results = test::probeBsdf(cases);
    double mass = 0, absorbed = 0;
    for (size_t i = 0; i < results.size(); ++i) {
      if (i < kSamples)
        absorbed += isValid(results[i]) ? 0 : 1.0 / kSamples;
      else
        mass += double(results[i].pdf) * 4 * pi / (kRows * kColumns);
    }
    EXPECT_NEAR(mass + absorbed, 1, 2e-3 + 4.5 * std::sqrt(absorbed * (1 - absorbed) / kSamples)) << int(side);
  }
}

TEST(BsdfGlass, Test4SampleWeightIsValueOverDensity) {
  auto cases = randomCases(5000, 14);
  std::mt19937 generator(15);
  for (BsdfCase& c : cases) test::drawUniforms(c, generator);
  const auto results = test::probeBsdf(cases);
  for (size_t i = 0; i < cases.size(); ++i) {
    const BsdfResult& result = results[i];
    if (!isValid(result) || isDelta(result)) continue;
    EXPECT_NEAR(result.sampledPdf, result.pdfAtSampled, 1e-4 * double(result.pdfAtSampled));
    for (int k = 0; k < 3; ++k) {
      const double value = double(result.fCosSampled[k]);
      EXPECT_NEAR(double(result.weight[k] * result.pdfAtSampled), value, 1e-4 * value) << test::describe(cases[i]);
    }
    const bool refracted = result.sampledWi.z < 0 && cases[i].thinWalled == 0;
    const float eta = cases[i].backFace != 0 ? 1 / cases[i].ior : cases[i].ior;
    EXPECT_EQ(result.eta, refracted ? eta : 1.0f);
  }
}

// Smooth glass: Snell's law, the reflectance's share, and power that is neither gained nor lost.
TEST(BsdfGlass, Test13SmoothGlassRefractsBySnellsLaw) {
  std::mt19937 generator(13);
  std::vector<BsdfCase> cases;
  for (int i = 0; i < 4000; ++i) {
    BsdfCase c = test::glass(0, i % 2 == 0 ? Side::Outside : Side::Inside);
    c.ior = 1 + 2 * test::uniform(generator);
    c.wo = test::directionOf(0.01 + 0.99 * double(test::uniform(generator)), 2 * pi * double(test::uniform(generator)));
    test::drawUniforms(c, generator);
    cases.push_back(c);
  }
  const auto results = test::probeBsdf(cases);
  int refracted = 0;
  for (size_t i = 0; i < cases.size(); ++i) {
    const BsdfCase& c = cases[i];
    const BsdfResult& result = results[i];
    ASSERT_TRUE(isValid(result) && isDelta(result)) << test::describe(c) << " ior " << c.ior;
    const double eta = c.backFace != 0 ? 1 / double(c.ior) : double(c.ior);
    const glm::dvec3 wo(c.wo), wi(result.sampledWi);
    EXPECT_NEAR(glm::length(wi), 1, 1e-6);
    if (wi.z > 0) {
      EXPECT_EQ(result.sampledWi, glm::vec3(-c.wo.x, -c.wo.y, c.wo.z));
      EXPECT_NEAR(result.weight.x, 1, 1e-5);
      continue;
    }
    ++refracted;
    EXPECT_NEAR(eta * wi.x, -wo.x, 1e-5 * std::max(1.0, eta)); // tangential parts: sines and the plane in one
    EXPECT_NEAR(eta * wi.y, -wo.y, 1e-5 * std::max(1.0, eta));
    EXPECT_NEAR(double(result.weight.x) * eta * eta, 1, 1e-5);
  }
  EXPECT_GT(refracted, 1500);
}

TEST(BsdfGlass, Test12MeanReflectanceOfSmoothGlass) {
  // Cosine-weighted: u.y spaces cos^2 evenly; the sample's side is drawn by uLobe.
  for (const auto& [side, expected] : {std::pair{Side::Outside, 0.0917780}, {Side::Inside, 0.596346}}) {
    std::mt19937 generator(3);
    const int count = 200000;
    std::vector<BsdfCase> cases(count, test::glass(0, side));
    for (int i = 0; i < count; ++i) {
      test::drawUniforms(cases[i], generator);
      cases[i].uLobe = float(std::fmod(i * 0.6180339887498949, 1.0) * 0.9999999);
      cases[i].wo = test::directionOf(std::sqrt((i + 0.5) / count), 1);
    }
    double reflected = 0;
    for (const BsdfResult& result : test::probeBsdf(cases)) reflected += result.sampledWi.z > 0 ? 1.0 / count : 0;
    EXPECT_NEAR(reflected, expected, 1e-4);
  }
}

TEST(BsdfGlass, Test49IndexOneIsInvisibleToTheBit) {
  for (const float roughness : {0.0f, 0.05f, 0.5f, 1.0f}) {
    for (const Side side : {Side::Outside, Side::Inside}) {
      BsdfCase c = test::glass(roughness, side);
      c.ior = 1;
      c.wo = test::directionOf(0.3, 1.7);
      for (const BsdfResult& result : test::probeBsdf(sampleCases(c, 1000, 5))) {
        ASSERT_EQ(result.sampledWi, -c.wo) << roughness;
        ASSERT_EQ(result.weight, glm::vec3(1)) << roughness;
        ASSERT_EQ(result.eta, 1);
      }
    }
  }
}

TEST(BsdfGlass, Test49EveryIndexAndAngleIsFinite) {
  std::vector<BsdfCase> cases;
  std::mt19937 generator(49);
  for (const float ior : {1.0f, 1.0000001f, 1.0001f, 1.01f, 2.4f, 1e3f}) {
    for (const float roughness : {0.0f, 0.0071f, 0.1f, 0.5f, 1.0f}) {
      for (const Side side : kSides) {
        for (int exponent = 0; exponent <= 6; ++exponent) {
          for (int i = 0; i < 200; ++i) {
            BsdfCase c = test::glass(roughness, side);
            c.ior = ior;
            c.wo = test::directionOf(std::pow(10.0, -exponent), 2 * pi * double(test::uniform(generator)));
            c.wi = test::directionOf(2 * double(test::uniform(generator)) - 1, 1);
            test::drawUniforms(c, generator);
            cases.push_back(c);
          }
        }
      }
    }
  }
  const auto results = test::probeBsdf(cases);
  for (size_t i = 0; i < cases.size(); ++i) {
    const BsdfResult& result = results[i];
    const std::string label = test::describe(cases[i]) + " ior " + std::to_string(cases[i].ior);
    EXPECT_TRUE(std::isfinite(result.fCos.x) && result.fCos.x >= 0) << label;
    EXPECT_TRUE(std::isfinite(result.pdf) && result.pdf >= 0) << label;
    EXPECT_TRUE(std::isfinite(result.weight.x) && result.weight.x >= 0) << label;
  }
}
