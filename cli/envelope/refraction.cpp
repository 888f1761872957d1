// The index of refraction, and glass seen along its surface.
#include <cmath>

#include "envelope/closed_forms.hpp"
#include "envelope/scene_parts.hpp"
#include "envelope/sweep.hpp"

namespace isophote::envelope {
namespace {

/// A plate of glass over an emitter of radiance 1 in the dark, seen at `cosine` from its normal.
Case plate(double ior, double cosine) {
  const auto given = static_cast<float>(ior);
  Case c{.mostSamples = 1 << 14};
  constexpr double kHalf = 1e3;
  addPrimitive(c.scene, box({-kHalf, 1, -kHalf}, {kHalf, 2, kHalf}, false, addMaterial(c.scene, glass(0, given))));
  addPrimitive(c.scene, quad({-kHalf, 0, kHalf}, {2 * kHalf, 0, 0}, {0, 0, -2 * kHalf},
                             addMaterial(c.scene, emitter(glm::vec3(1)))));
  const double sine = std::sqrt(1 - cosine * cosine);
  const glm::dvec3 target(0, 2, 0);
  c.camera = orthographicLookAt(target + 3.0 * glm::dvec3(0.6 * sine, cosine, 0.8 * sine), target, 1e-6, 1e-6);
  c.exact = plateTransmittance(cosine, static_cast<double>(given));
  c.scale = 1;
  return c;
}

} // namespace

void addRefractionSweeps(std::vector<Sweep>& sweeps) {
  const std::string text = "A clear plate over an emitter, Fresnel's equations; relative to the emitter";
  sweeps.push_back({"ior",
                    "index of refraction",
                    text + "; at 45 degrees",
                    {1 - 1e-7, 1, 1 + 1.2e-7, 1 + 1e-6, 1.0001, 1.01, 1.1, 1.5, 2.4, 4, 10, 100, 1000},
                    1.5,
                    [](double value) { return plate(value, std::sqrt(0.5)); }});
  sweeps.push_back({"grazing-glass",
                    "cosine of the view",
                    text + "; index 1.5",
                    {1, 0.5, 0.3, 0.1, 0.03, 0.01, 1e-3},
                    0.5,
                    [](double value) { return plate(1.5, value); }});
}

} // namespace isophote::envelope
