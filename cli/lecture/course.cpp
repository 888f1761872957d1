#include "lecture/course.hpp"

#include <algorithm>
#include <numbers>

#include "isophote/error.hpp"

namespace isophote::cli {
namespace {

/// The course finds lights by chance until its last chapter, and picks among several uniformly.
Configuration course(const std::string& directions, uint32_t bounces, std::vector<Change> more = {}) {
  Configuration configuration{{{"max-depth", std::to_string(bounces)},
                               {"light-sampling", "bsdf"},
                               {"light-selection", "uniform"},
                               {"direction-sampling", directions}}};
  for (Change& change : more) {
    const auto same = std::find_if(configuration.changes.begin(), configuration.changes.end(),
                                   [&](const Change& own) { return own.key == change.key; });
    if (same != configuration.changes.end()) {
      same->value = change.value;
    } else {
      configuration.changes.push_back(std::move(change));
    }
  }
  return configuration;
}

std::vector<CourseComparison> directLight() {
  constexpr double kPi = std::numbers::pi;
  return {
      {"Uniform directions, 100 and 1000 samples",
       "Ten times the samples: a tenth of the squared noise.",
       {{"p = 1/2π, n = 100", "diffuse", course("uniform", 1), 100},
        {"p = 1/2π, n = 1000", "diffuse", course("uniform", 1), 1000}}},
      {"Uniform or cosine directions",
       "The cosine in the integrand cancels.",
       {{"p = 1/2π", "diffuse", course("uniform", 1)}, {"p = cos θ/π", "diffuse", course("cosine", 1)}}},
      {"A BRDF of ρ or of ρ/π",
       "f = ρ reflects π times the light that it should: all of the bias is in the surfaces, none in the lamp.",
       {{"f = ρ", "diffuse", course("cosine", 1), 100, kPi}, {"f = ρ/π", "diffuse", course("cosine", 1)}}},
  };
}

std::vector<CourseComparison> paths() {
  return {
      {"Paths of ten bounces",
       "",
       {{"p = 1/2π", "diffuse", course("uniform", 10)}, {"p = cos θ/π", "diffuse", course("cosine", 10)}}},
      {"Microfacets of roughness 0.2 by the cosine or by their normals",
       "",
       {{"p = cos θ/π", "metal everywhere", course("cosine", 10)},
        {"p = D cos θh / 4 ωr·ωh", "metal everywhere", course("ndf", 10)}}},
      {"Microfacets of roughness 1 and Lambert's surface",
       "",
       {{"GGX, p = D cos θh / 4 ωr·ωh", "rough metal", course("ndf", 10)},
        {"Lambert, p = cos θ/π", "diffuse", course("cosine", 10)}}},
      {"GGX alone, and GGX with the cosine",
       "The mixture's densities are all evaluated at the direction taken; the course's own mixture is wrong (below).",
       {{"GGX", "plastic", course("ndf", 10)}, {"GGX + cosine", "plastic", course("mixture", 10)}}},
      {"With and without light sampling",
       "",
       {{"GGX + cosine", "plastic", course("mixture", 10)},
        {"GGX + cosine + lights", "plastic", course("mixture", 10, {{"light-sampling", "mis"}})}}},
      {"Glass of roughness 0.2 and 0.8, 1000 samples",
       "",
       {{"r = 0.2", "glass 0.2", course("mixture", 10), 1000}, {"r = 0.8", "glass 0.8", course("mixture", 10), 1000}}},
  };
}

/// What the course says of facets and of Fresnel's equations, where it is a setting here.
std::vector<CourseComparison> facets() {
  return {
      {"Schlick's approximation of Fresnel's equations, 1000 samples",
       "Of glass; for opaque surfaces glTF itself asks for Schlick's.",
       {{"exact", "glass 0.2", course("mixture", 10), 1000},
        {"Schlick", "glass 0.2", course("mixture", 10, {{"fresnel", "schlick"}}), 1000}}},
      {"Normals after GGX, Beckmann and Blinn",
       "Beckmann's and Blinn's distributions are other materials, not errors; what the course writes for them is "
       "(below). Half of their directions are drawn by lobe, for their normals never reach what scatters between "
       "facets.",
       {{"GGX", "metal everywhere", course("ndf", 10)},
        {"Beckmann", "metal everywhere", course("ndf", 10, {{"ndf", "beckmann"}})},
        {"Blinn", "metal everywhere", course("ndf", 10, {{"ndf", "blinn-phong"}})}}},
  };
}

} // namespace

std::vector<CourseComparison> courseComparisons() {
  std::vector<CourseComparison> list = directLight();
  for (auto* part : {&paths, &facets}) {
    for (CourseComparison& comparison : part()) list.push_back(std::move(comparison));
  }
  return list;
}

} // namespace isophote::cli
