#include "oracle/bsdf_fresnel.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace isophote::oracle {

double fresnelDielectric(double cosI, double eta) {
  if (eta == 1) return 0; // no boundary; the formula below is 0 / 0 at cosI = 0
  const double sinT2 = (1 - cosI * cosI) / (eta * eta);
  if (sinT2 >= 1) return 1;
  const double cosT = std::sqrt(1 - sinT2);
  const double s = (cosI - eta * cosT) / (cosI + eta * cosT);
  const double p = (eta * cosI - cosT) / (eta * cosI + cosT);
  return (s * s + p * p) / 2;
}

glm::dvec3 fresnelSchlick(const glm::dvec3& f0, const glm::dvec3& f90, double cosine) {
  return f0 + (f90 - f0) * std::pow(1 - std::clamp(cosine, 0.0, 1.0), 5);
}

double fresnelConductor(double cosI, double n, double k) {
  const std::complex<double> index(n, k);
  const std::complex<double> sinT = std::sqrt(1 - cosI * cosI) / index;
  const std::complex<double> cosT = std::sqrt(1.0 - sinT * sinT);
  const std::complex<double> s = (cosI - index * cosT) / (cosI + index * cosT);
  const std::complex<double> p = (index * cosI - cosT) / (index * cosI + cosT);
  return (std::norm(s) + std::norm(p)) / 2;
}

namespace {

double filmIor(const ThinFilm& film) { // fades in over 0.03 nm, by Hermite's cubic
  const double t = std::clamp(film.thickness / 0.03, 0.0, 1.0);
  return std::lerp(1.0, film.ior, t * t * (3 - 2 * t));
}

double schlick(double f0, double cosine) { return f0 + (1 - f0) * std::pow(1 - cosine, 5); }

double iorOf(double f0) {
  const double root = std::sqrt(std::clamp(f0, 0.0, 0.9999));
  return (1 + root) / (1 - root);
}

double normalReflectance(double behind, double front) { return std::pow((behind - front) / (behind + front), 2); }

// One Gaussian of the color matching functions' Fourier transforms.
double gaussian(double opd, double shift, double value, double position, double variance) {
  const double phase = 2 * std::numbers::pi * opd * 1e-9;
  return value * std::sqrt(2 * std::numbers::pi * variance) * std::cos(position * phase + shift) *
         std::exp(-variance * phase * phase);
}

glm::dvec3 sensitivity(double opd, const glm::dvec3& shift) {
  const double x = gaussian(opd, shift.x, 5.4856e-13, 1.6810e+06, 4.3278e+09) +
                   gaussian(opd, shift.x, 9.7470e-14, 2.2399e+06, 4.5282e+09);
  const double y = gaussian(opd, shift.y, 4.4201e-13, 1.7953e+06, 9.3046e+09);
  const double z = gaussian(opd, shift.z, 5.2481e-13, 2.2084e+06, 6.6121e+09);
  const glm::dvec3 rgb(3.2404542 * x - 1.5371385 * y - 0.4985314 * z, -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
                       0.0556434 * x - 0.2040259 * y + 1.0572252 * z);
  return rgb / 1.0685e-7;
}

} // namespace

glm::dvec3 filmReflectance(const ThinFilm& film, double cosine, const glm::dvec3& f0) {
  const double ior = filmIor(film);
  const double cosineInside = std::sqrt(1 - (1 - cosine * cosine) / (ior * ior));
  const double R12 = schlick(normalReflectance(ior, 1), cosine);
  const double T121 = 1 - R12;
  const double D = 2 * ior * film.thickness * cosineInside;
  glm::dvec3 result(0), shift(0), r23(0);
  for (int i = 0; i < 3; ++i) {
    r23[i] = schlick(normalReflectance(iorOf(f0[i]), ior), cosineInside);
    shift[i] = std::numbers::pi * (iorOf(f0[i]) < ior ? 2 : 1);
  }
  for (int i = 0; i < 3; ++i) {
    const double loop = std::clamp(R12 * r23[i], 1e-5, 0.9999);
    const double Rs = T121 * T121 * r23[i] / (1 - loop);
    result[i] = R12 + Rs;
    for (int m = 1; m <= 2; ++m)
      result[i] += (Rs - T121) * std::pow(std::sqrt(loop), m) * 2 * sensitivity(m * D, double(m) * shift)[i];
  }
  return glm::clamp(result, 0.0, 1.0);
}

double filmBound(const ThinFilm& film, const glm::dvec3& f0) {
  double bound = 0;
  for (int i = 1; i <= 8; ++i) {
    const double cosine = std::pow(i / 8.0, 1.5);
    const glm::dvec3 reflectance = filmReflectance(film, cosine, f0);
    const double grazing = std::pow(1 - cosine, 5);
    bound = std::max(bound, (std::max({reflectance.x, reflectance.y, reflectance.z}) - grazing) / (1 - grazing));
  }
  return bound;
}

} // namespace isophote::oracle
