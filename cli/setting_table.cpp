#include "setting_table.hpp"

#include <limits>
#include <utility>

#include <fmt/format.h>

#include "isophote/error.hpp"
#include "parse.hpp"

namespace isophote::cli {
namespace {

template <class T> using Names = std::vector<std::pair<const char*, T>>;

template <class T> T fromName(const Names<T>& names, const std::string& text) {
  std::string all;
  for (const auto& [name, value] : names) {
    if (text == name) return value;
    all += (all.empty() ? "" : ", ") + std::string(name);
  }
  throw UsageError(fmt::format("'{}' is none of {}", text, all));
}

template <class T> std::string toName(const Names<T>& names, T wanted) {
  for (const auto& [name, value] : names) {
    if (value == wanted) return name;
  }
  throw Error("a setting without a name");
}

/// An entry whose value is one of a few names.
template <class Part, class T>
SettingEntry choice(SettingEntry entry, Part Settings::*part, T Part::*member, Names<T> names) {
  entry.set = [=](Settings& settings, const std::string& text) { settings.*part.*member = fromName(names, text); };
  entry.get = [=](const Settings& settings) { return toName(names, settings.*part.*member); };
  for (const auto& [name, value] : names) entry.trials.emplace_back(name);
  return entry;
}

/// An entry that is a whole number, one of which has a name.
template <class Part, class T>
SettingEntry number(SettingEntry entry, Part Settings::*part, T Part::*member, uint64_t largest, const char* name,
                    T namedValue) {
  entry.set = [=](Settings& settings, const std::string& text) {
    settings.*part.*member =
        name != nullptr && text == name ? namedValue : static_cast<T>(parseUnsigned(text, 0, largest));
  };
  entry.get = [=](const Settings& settings) {
    const T value = settings.*part.*member;
    return name != nullptr && value == namedValue ? std::string(name) : std::to_string(value);
  };
  entry.trials = {entry.exact, entry.fast};
  return entry;
}

/// An entry that is a positive number, or off: infinite.
SettingEntry limit(SettingEntry entry, float EstimatorSettings::*member) {
  constexpr float kOff = std::numeric_limits<float>::infinity();
  entry.set = [=](Settings& settings, const std::string& text) {
    settings.estimator.*member = text == "off" ? kOff : static_cast<float>(parseNumber(text, 1e-30, 1e30));
  };
  entry.get = [=](const Settings& settings) {
    const float value = settings.estimator.*member;
    return value == kOff ? std::string("off") : fmt::format("{}", value);
  };
  entry.trials = {entry.exact, entry.fast};
  return entry;
}

/// An entry whose values ask for other images, so that none is a price for another.
SettingEntry untraded(SettingEntry entry) {
  entry.trials.clear();
  return entry;
}

/// An entry one of whose values the comparison cannot judge.
SettingEntry withoutTrial(const std::string& value, SettingEntry entry) {
  std::erase(entry.trials, value);
  return entry;
}

std::vector<SettingEntry> makeTable() {
  const Names<bool> onOff = {{"on", true}, {"off", false}};
  using E = EstimatorSettings;
  using X = ExecutionSettings;
  const auto estimator = &Settings::estimator;
  const auto execution = &Settings::execution;
  return {
      withoutTrial(
          "sobol-joint", // its error bars do not tell its noise
          choice({"sampler", "sobol, sobol-joint, independent", "sobol", "sobol",
                  "where random numbers come from: Owen-scrambled Sobol points in eight sequences a pixel, for "
                  "true error bars, or in one, for less noise under error bars that are too wide"},
                 estimator, &E::sampler,
                 {{"sobol", SamplerKind::Sobol},
                  {"sobol-joint", SamplerKind::SobolJoint},
                  {"independent", SamplerKind::Independent}})),
      untraded(choice({"filter", "box, gaussian, blackman-harris", "blackman-harris", "blackman-harris",
                       "pixel filter, importance sampled"},
                      estimator, &E::filter,
                      {{"box", PixelFilter::Box},
                       {"gaussian", PixelFilter::Gaussian},
                       {"blackman-harris", PixelFilter::BlackmanHarris}})),
      number({"max-depth", "0 to 4294967294, unlimited", "unlimited", "4",
              "scattering events on a path: 0 is emission seen directly, 1 direct light; a limit loses light (bias)"},
             estimator, &E::maxDepth, kUnlimitedDepth - 1, "unlimited", kUnlimitedDepth),
      choice({"light-sampling", "mis, lights, bsdf", "mis", "mis",
              "next event estimation and BSDF sampling combined, or one alone"},
             estimator, &E::lightSampling,
             {{"mis", LightSampling::Mis}, {"lights", LightSampling::LightsOnly}, {"bsdf", LightSampling::BsdfOnly}}),
      choice({"sphere-light-sampling", "cone, area", "cone", "cone",
              "points on sphere lights: by the solid angle they are seen under, or by area (noisier)"},
             estimator, &E::sphereLightSampling,
             {{"cone", SphereLightSampling::Cone}, {"area", SphereLightSampling::Area}}),
      choice({"light-selection", "bvh, power, uniform", "bvh", "bvh",
              "how one of many lights is chosen: by what it can do at the point (by power where lights are few), by "
              "power, or all alike"},
             estimator, &E::lightSelection,
             {{"bvh", LightSelection::Bvh}, {"power", LightSelection::Power}, {"uniform", LightSelection::Uniform}}),
      choice(
          {"triangle-light-sampling", "area, solid-angle", "solid-angle", "solid-angle",
           "how points on emissive triangles are sampled: alike on the triangle, or alike as seen from the receiver"},
          estimator, &E::triangleLightSampling,
          {{"solid-angle", TriangleLightSampling::SolidAngle}, {"area", TriangleLightSampling::Area}}),
      choice({"direction-sampling", "lobes, uniform, cosine, ndf, visible-normals, mixture", "lobes", "lobes",
              "how a path's next direction is drawn: from the lobes of the surface, or by a textbook technique"},
             estimator, &E::directionSampling,
             {{"lobes", DirectionSampling::Lobes},
              {"uniform", DirectionSampling::Uniform},
              {"cosine", DirectionSampling::Cosine},
              {"ndf", DirectionSampling::Ndf},
              {"visible-normals", DirectionSampling::VisibleNormals},
              {"mixture", DirectionSampling::Mixture}}),
      choice({"ndf", "ggx, beckmann, blinn-phong", "ggx", "ggx",
              "how the normals of microfacets are distributed: another model of rough surfaces, not another estimate"},
             estimator, &E::ndf, {{"ggx", Ndf::Ggx}, {"beckmann", Ndf::Beckmann}, {"blinn-phong", Ndf::BlinnPhong}}),
      choice({"masking", "correlated, separable", "correlated", "correlated",
              "Smith's masking and shadowing of microfacets: correlated by their height, or as if independent"},
             estimator, &E::masking, {{"correlated", Masking::Correlated}, {"separable", Masking::Separable}}),
      choice(
          {"fresnel", "gltf, exact, schlick", "gltf", "gltf",
           "reflectance of dielectrics: exact (mean of s and p), by Schlick's approximation, or as glTF has it: exact "
           "for glass, Schlick's for opaque surfaces"},
          estimator, &E::fresnel, {{"gltf", Fresnel::Gltf}, {"exact", Fresnel::Exact}, {"schlick", Fresnel::Schlick}}),
      choice({"shadow-transmission", "off, straight", "off", "off",
              "glass before a light: shadow rays end there and paths find the light, or they cross it unbent (bias)"},
             estimator, &E::shadowTransmission,
             {{"off", ShadowTransmission::Off}, {"straight", ShadowTransmission::Straight}}),
      choice({"mis-heuristic", "power, balance", "power", "power", "weights of multiple importance sampling"},
             estimator, &E::misHeuristic, {{"power", MisHeuristic::Power}, {"balance", MisHeuristic::Balance}}),
      choice(
          {"russian-roulette", "on, throughput, off", "on", "on",
           "end dim paths at random, without bias: they go on with the chance of the root of their throughput, or of "
           "the throughput itself (shorter paths, more noise); off needs a max-depth"},
          estimator, &E::russianRoulette,
          {{"on", RussianRoulette::Root}, {"throughput", RussianRoulette::Throughput}, {"off", RussianRoulette::Off}}),
      choice({"intersection", "watertight, fast", "watertight", "fast",
              "rays against triangles: none passes between two that share an edge, or some do (bias)"},
             estimator, &E::intersection, {{"watertight", Intersection::Watertight}, {"fast", Intersection::Fast}}),
      choice({"ray-offset", "bound, fixed", "bound", "fixed",
              "where rays leave a surface: just beyond the error of its point, or 1e-4 scene units above it (bias)"},
             estimator, &E::rayOffset, {{"bound", RayOffset::Bound}, {"fixed", RayOffset::Fixed}}),
      choice(
          {"trigonometry", "own, device", "own", "device",
           "sines, cosines and angles: own polynomials, or the device's functions, which may be off by 1/2048 (bias)"},
          estimator, &E::trigonometry, {{"own", Trigonometry::Own}, {"device", Trigonometry::Device}}),
      choice({"texture-filter", "asset, nearest", "asset", "nearest",
              "textures of materials: filtered as the asset says, or the nearest texel (bias)"},
             estimator, &E::textureFilter, {{"asset", TextureFilter::Asset}, {"nearest", TextureFilter::Nearest}}),
      choice({"multiple-scattering", "on, off", "on", "on",
              "light scattered more than once between the facets of a rough surface; off loses it (bias)"},
             estimator, &E::multipleScattering, onOff),
      limit({"clamp", "off, a radiance above 0", "off", "10",
             "largest radiance of one sample; brighter ones are scaled down to it, and what that removes is accounted "
             "for "
             "(bias)"},
            &E::clamp),
      number({"seed", "0 to 18446744073709551615", "0", "0", "another seed is another, independent image"}, estimator,
             &E::seed, ~uint64_t{0}, nullptr, uint64_t{0}),
      number({"path-pool-size", "auto, 1 to 4194304", "auto", "auto",
              "paths in flight; auto is measured in long renders and kept for the device", SettingKind::Execution},
             execution, &X::pathPoolSize, 1u << 22, "auto", uint32_t{0}),
      number(
          {"workgroup-size", "auto, 1 to 1024", "auto", "auto", "invocations of a workgroup", SettingKind::Execution},
          execution, &X::workgroupSize, 1024, "auto", uint32_t{0}),
      choice(
          {"bvh-build", "fast-trace, fast-build", "fast-trace", "fast-build",
           "trees over the triangles that rays cross in few steps, or that are there soon; where surfaces coincide a "
           "ray may meet the other one",
           SettingKind::Execution},
          &Settings::scene, &SceneSettings::bvhBuild,
          {{"fast-trace", BvhBuild::FastTrace}, {"fast-build", BvhBuild::FastBuild}}),
      choice({"depth-ledger", "on, off", "on", "on",
              "with a max-depth, follow one in eight paths beyond it to measure what it leaves out",
              SettingKind::Execution},
             execution, &X::depthLedger, onOff),
      choice({"pipeline", "auto, wavefront, fused", "auto", "auto",
              "a kernel for each stage, all stages in one, or the faster of the two as measured (on a GPU: the first)",
              SettingKind::Execution},
             execution, &X::pipeline,
             {{"auto", Pipeline::Auto}, {"wavefront", Pipeline::Wavefront}, {"fused", Pipeline::Fused}}),
      choice(
          {"specialize", "on, off", "on", "on", "kernels without what the scene does not use", SettingKind::Execution},
          execution, &X::specialize, onOff),
      choice({"denoiser", "none, atrous", "none", "atrous",
              "a filter of the finished image that trades noise for bias, written as the layer denoised.{R,G,B}",
              SettingKind::Layer},
             &Settings::layers, &LayerSettings::denoiser, {{"none", Denoiser::None}, {"atrous", Denoiser::Atrous}}),
  };
}

} // namespace

const std::vector<SettingEntry>& settingTable() {
  static const std::vector<SettingEntry> table = makeTable();
  return table;
}

void setSetting(Settings& settings, const std::string& key, const std::string& value) {
  std::string keys;
  for (const SettingEntry& entry : settingTable()) {
    if (key == entry.key) {
      entry.set(settings, value);
      return;
    }
    keys += (keys.empty() ? "" : ", ") + std::string(entry.key);
  }
  throw UsageError(fmt::format("no setting '{}'; there are {}", key, keys));
}

void setSetting(Settings& settings, const std::string& assignment) {
  const size_t equals = assignment.find('=');
  if (equals == std::string::npos) throw UsageError(fmt::format("'{}' is not of the form key=value", assignment));
  const std::string key = assignment.substr(0, equals);
  try {
    setSetting(settings, key, assignment.substr(equals + 1));
  } catch (const UsageError& error) {
    throw UsageError(key + ": " + error.what());
  }
}

nlohmann::ordered_json settingsJson(const Settings& settings, SettingKind kind) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const SettingEntry& entry : settingTable()) {
    if (entry.kind == kind) json[entry.key] = entry.get(settings);
  }
  return json;
}

nlohmann::ordered_json biasJson(const Settings& settings) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  if (settings.estimator.maxDepth != kUnlimitedDepth) {
    json["max-depth"] = {
        {"value", settings.estimator.maxDepth},
        {"exact", "unlimited"},
        {"leaves_out", fmt::format("light after more than {} scattering events", settings.estimator.maxDepth)}};
  }
  if (settings.estimator.clamp < kNoClamp) {
    json["clamp"] = {{"value", settings.estimator.clamp},
                     {"exact", "off"},
                     {"leaves_out", fmt::format("what samples hold above a radiance of {}", settings.estimator.clamp)}};
  }
  if (!settings.estimator.multipleScattering) {
    json["multiple-scattering"] = {
        {"value", "off"},
        {"exact", "on"},
        {"leaves_out", "light scattered more than once between the facets of rough surfaces"}};
  }
  if (settings.estimator.shadowTransmission != ShadowTransmission::Off) {
    json["shadow-transmission"] = {{"value", "straight"},
                                   {"exact", "off"},
                                   {"leaves_out", "the bending of light that glass lets through to other surfaces"}};
  }
  if (settings.estimator.fresnel == Fresnel::Schlick) {
    json["fresnel"] = {{"value", "schlick"},
                       {"exact", "gltf"},
                       {"leaves_out", "the difference of glass's reflectance from Schlick's approximation"}};
  }
  if (settings.estimator.intersection != Intersection::Watertight) {
    json["intersection"] = {{"value", "fast"},
                            {"exact", "watertight"},
                            {"leaves_out", "hits at the edges of triangles, where rays pass between them"}};
  }
  if (settings.estimator.rayOffset != RayOffset::Bound) {
    json["ray-offset"] = {{"value", "fixed"},
                          {"exact", "bound"},
                          {"leaves_out", "what lies within 1e-4 scene units of a surface, and surfaces found twice"}};
  }
  if (settings.estimator.trigonometry != Trigonometry::Own) {
    json["trigonometry"] = {{"value", "device"},
                            {"exact", "own"},
                            {"leaves_out", "directions to better than the device's sines and cosines"}};
  }
  if (settings.estimator.textureFilter != TextureFilter::Asset) {
    json["texture-filter"] = {
        {"value", "nearest"}, {"exact", "asset"}, {"leaves_out", "the filter that the asset gives its textures"}};
  }
  if (settings.layers.denoiser != Denoiser::None) {
    json["denoiser"] = {{"value", "atrous"},
                        {"exact", "none"},
                        {"leaves_out", "of the layer denoised.{R,G,B} alone: detail that noise would explain"}};
  }
  return json;
}

} // namespace isophote::cli
