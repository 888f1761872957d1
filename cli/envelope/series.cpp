// Long paths: how often light is scattered, and how little is lost each time.
#include <cmath>

#include "envelope/scene_parts.hpp"
#include "envelope/sweep.hpp"

namespace isophote::envelope {
namespace {

Case room(float emitted, float reflectance) {
  return {.scene = boxFurnace(glm::vec3(emitted), glm::vec3(reflectance)),
          .camera = boxFurnaceCamera(),
          .estimator = {.filter = PixelFilter::Box, .lightSampling = LightSampling::BsdfOnly}};
}

/// The series of its reflections cut after `depth`: depth + 1 by every path.
Case lossless(double depth) {
  Case c = room(1, 1);
  c.estimator.maxDepth = static_cast<uint32_t>(depth);
  c.estimator.russianRoulette = RussianRoulette::Off;
  c.exact = depth + 1;
  c.fewestSamples = c.mostSamples = depth > 1000 ? 8 : 64;
  return c;
}

/// A geometric series of the reflectance, by every path, cut where less than 1e-5 of it is left or after 10,000.
Case series(double albedo) {
  const auto given = static_cast<float>(albedo);
  Case c = room(1 - given, given);
  const double rho = static_cast<double>(given);
  c.estimator.maxDepth = static_cast<uint32_t>(std::min(10000.0, std::ceil(std::log(1e-5) / std::log(rho))));
  c.estimator.russianRoulette = RussianRoulette::Off;
  c.exact = 1 - std::pow(rho, c.estimator.maxDepth + 1.0);
  c.fewestSamples = c.mostSamples = c.estimator.maxDepth > 1000 ? 8 : 64;
  return c;
}

/// The whole series, ended by roulette: paths of 1 / (1 - albedo) scatterings, whose deviation is about that of one
/// path, so that the noise and not the range of numbers ends the curve.
Case roulette(double albedo) {
  const auto given = static_cast<float>(albedo);
  Case c = room(1 - given, given);
  c.mostSamples = static_cast<uint32_t>(std::max(64.0, 32768 * std::min(1.0, 8 * (1 - albedo))));
  return c;
}

} // namespace

void addSeriesSweeps(std::vector<Sweep>& sweeps) {
  sweeps.push_back({"depth",
                    "scatterings on a path",
                    "A room that emits 1 and loses nothing, cut after so many scatterings: their number and 1",
                    {0, 1, 10, 100, 1000, 10000},
                    1,
                    lossless});
  sweeps.back().slow = {10000};
  sweeps.push_back({"albedo",
                    "reflectance",
                    "A room that emits what it absorbs, the geometric series cut after at most 10,000 scatterings",
                    {0, 0.5, 0.9, 0.99, 0.999, 0.9999, 0.99999, 0.999999},
                    0.5,
                    series});
  sweeps.back().slow = {0.999, 0.9999, 0.99999, 0.999999};
  sweeps.push_back({"albedo-roulette",
                    "reflectance",
                    "A room that emits what it absorbs, paths ended by Russian roulette: 1; ended by noise",
                    {0, 0.5, 0.9, 0.99, 0.999},
                    0.5,
                    roulette});
}

} // namespace isophote::envelope
