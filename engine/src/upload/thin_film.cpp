#include "upload/thin_film.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace isophote {
namespace {

using std::numbers::pi;

double schlick(double f0, double cosine) { return f0 + (1 - f0) * std::pow(1 - cosine, 5); }

double normalReflectance(double behind, double front) { return std::pow((behind - front) / (behind + front), 2); }

double indexOfReflectance(double f0) {
  const double amplitude = std::sqrt(std::clamp(f0, 0.0, 0.9999));
  return (1 + amplitude) / (1 - amplitude);
}

/// Fourier transform of one Gaussian: value, position and variance as fitted.
double gaussian(double opd, double shift, double value, double position, double variance) {
  const double phase = 2 * pi * opd * 1e-9;
  return value * std::sqrt(2 * pi * variance) * std::cos(phase * position + shift) *
         std::exp(-phase * phase * variance);
}

/// @param shift of phase, radians
glm::dvec3 sensitivity(double opd, const glm::dvec3& shift) {
  const glm::dvec3 xyz(gaussian(opd, shift.x, 5.4856e-13, 1.6810e+06, 4.3278e+09) +
                           gaussian(opd, shift.x, 9.7470e-14, 2.2399e+06, 4.5282e+09),
                       gaussian(opd, shift.y, 4.4201e-13, 1.7953e+06, 9.3046e+09),
                       gaussian(opd, shift.z, 5.2481e-13, 2.2084e+06, 6.6121e+09));
  const glm::dmat3 rec709FromXyz(3.2404542, -0.9692660, 0.0556434, -1.5371385, 1.8760108, -0.2040259, -0.4985314,
                                 0.0415560, 1.0572252);
  return rec709FromXyz * (xyz / 1.0685e-7);
}

} // namespace

glm::dvec3 thinFilmReflectance(double filmIor, double thickness, double cosine, const glm::dvec3& f0) {
  const double grown = std::clamp(thickness / 0.03, 0.0, 1.0);
  const double ior = std::lerp(1.0, filmIor, grown * grown * (3 - 2 * grown)); // no film, no boundary
  const double cosineInside = std::sqrt(std::max(1 - (1 - cosine * cosine) / (ior * ior), 0.0));
  const double outer = schlick(normalReflectance(ior, 1), cosine);
  const double through = 1 - outer;
  const double opd = 2 * ior * thickness * cosineInside;
  glm::dvec3 shift(0), roundTrip(0), sum(0), order(0);
  for (int i = 0; i < 3; ++i) {
    const double below = indexOfReflectance(f0[i]);
    const double inner = schlick(normalReflectance(below, ior), cosineInside);
    shift[i] = pi * (below < ior ? 2 : 1);
    roundTrip[i] = std::clamp(outer * inner, 1e-5, 0.9999);
    const double returned = through * through * inner / (1 - roundTrip[i]);
    sum[i] = outer + returned;
    order[i] = returned - through;
  }
  for (int m = 1; m <= 2; ++m) {
    order *= glm::sqrt(roundTrip);
    sum += order * 2.0 * sensitivity(m * opd, double(m) * shift);
  }
  return glm::clamp(sum, 0.0, 1.0);
}

} // namespace isophote
