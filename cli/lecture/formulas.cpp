#include "lecture/formulas.hpp"

#include <cmath>
#include <functional>
#include <numbers>

#include <fmt/format.h>

namespace isophote::cli {
namespace {

constexpr double kPi = std::numbers::pi;

/// Midpoint rule; 2e5 points leave less than 1e-6 of these integrands.
double integral(double from, double to, const std::function<double(double)>& f) {
  constexpr int kPoints = 200000;
  const double step = (to - from) / kPoints;
  double sum = 0;
  for (int i = 0; i < kPoints; ++i) sum += f(from + (i + 0.5) * step);
  return sum * step;
}

/// Of a function of the polar angle over the hemisphere of directions.
double overHemisphere(const std::function<double(double)>& f) {
  return 2 * kPi * integral(0, kPi / 2, [&](double theta) { return f(theta) * std::sin(theta); });
}

/// The projected area of all facets: 1 for a distribution of normals.
double projectedArea(const std::function<double(double)>& D) {
  return overHemisphere([&](double theta) { return D(theta) * std::cos(theta); });
}

double ggx(double alpha, double theta) {
  const double c = std::cos(theta), a2 = alpha * alpha;
  return a2 / (kPi * std::pow((a2 - 1) * c * c + 1, 2));
}

std::vector<CourseFormula> normals() {
  std::vector<CourseFormula> list;
  for (const double alpha : {0.1, 0.5}) {
    const auto beckmann = [=](double t) {
      return std::sin(t) / (kPi * alpha * alpha * std::pow(std::cos(t), 3)) *
             std::exp(-std::pow(std::tan(t) / alpha, 2));
    };
    list.push_back({fmt::format("Beckmann's D: projected area of the facets, α = {}", alpha),
                    "sin θ exp(-tan²θ/α²) / (π α² cos³θ)", "exp(-tan²θ/α²) / (π α² cos⁴θ)", projectedArea(beckmann),
                    1});
  }
  for (const double exponent : {10.0, 100.0}) {
    const auto blinn = [=](double t) {
      return (exponent + 2) / (2 * kPi) * std::pow(std::cos(t), exponent + 1) * std::sin(t);
    };
    list.push_back({fmt::format("Blinn's D: the same, exponent {}", exponent), "(α+2)/2π cos^(α+1) θ sin θ",
                    "(α+2)/2π cos^α θ", projectedArea(blinn), 1});
  }
  list.push_back({"GGX's D: the same, α = 0.2", "α² / (π ((α²-1) cos²θ + 1)²)", "as written",
                  projectedArea([](double t) { return ggx(0.2, t); }), 1});
  return list;
}

/// Reflectance of a white Lambertian surface, seen from above, by the mixture of cosine and GGX (α and share: r).
double mixtureReflectance(double r) {
  return overHemisphere([=](double theta) {
    const double f = 1 / kPi * std::cos(theta);
    const double diffuse = std::cos(theta) / kPi;
    const double half = theta / 2;
    const double specular = ggx(r, half) * std::cos(half) / (4 * std::cos(half));
    // Sampled by one, the density of the other "is set to 1".
    return r * diffuse * f / (r * diffuse + (1 - r)) + (1 - r) * specular * f / (r + (1 - r) * specular);
  });
}

/// Irradiance by a sphere of radius 1 and radiance 1 at `distance` in the zenith; as written: |x-x'|²/4πr², with
/// neither the cosine at the light nor, where `both`, its own shadow on its far side.
double sphereIrradiance(double distance, bool both) {
  return 2 * kPi * integral(-1, 1, [=](double z) {
           const double squared = distance * distance + 1 - 2 * distance * z; // to a point at height distance - z
           const double towards = distance * z - 1;                           // positive on the side that is seen
           if (!both && towards <= 0) return 0.0;
           return (distance - z) / std::sqrt(squared) / squared;
         });
}

double schlick(double r0, double c) { return r0 + (1 - r0) * std::pow(1 - c, 5); }

double fresnel(double eta, double c) {
  const double ct = std::sqrt(std::max(0.0, 1 - (1 - c * c) / (eta * eta)));
  const double s = (c - eta * ct) / (c + eta * ct), p = (eta * c - ct) / (eta * c + ct);
  return 0.5 * (s * s + p * p);
}

std::vector<CourseFormula> fresnels() {
  double worst = 0, worstCosine = 0;
  for (double c = 0.001; c < 1; c += 0.001) {
    const double error = std::abs(schlick(0.04, c) - fresnel(1.5, c));
    if (error > worst) {
      worst = error;
      worstCosine = c;
    }
  }
  const double critical = std::sqrt(1 - 1 / (1.5 * 1.5));
  return {{fmt::format("Schlick for glass of 1.5 from outside, where it is worst: cos θ = {:.3f}", worstCosine),
           "R0 + (1-R0)(1-cos θ)⁵", "Fresnel's equations", schlick(0.04, worstCosine), fresnel(1.5, worstCosine)},
          {"Schlick from inside, at the critical angle", "with the angle inside",
           "with the angle outside: all is reflected", schlick(0.04, critical), 1}};
}

double encodeSrgb(double x) { return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055; }

CourseFormula gamma() {
  double worst = 0, at = 0;
  for (double x = 1e-4; x < 1; x += 1e-4) {
    const double error = std::abs(std::pow(x, 1 / 2.2) - encodeSrgb(x));
    if (error > worst) {
      worst = error;
      at = x;
    }
  }
  return {fmt::format("Gamma, in steps of 255, where it is worst: x = {:.4f}", at), "x^(1/2.2)", "the curve of sRGB",
          255 * std::pow(at, 1 / 2.2), 255 * encodeSrgb(at)};
}

} // namespace

std::vector<CourseFormula> courseFormulas() {
  std::vector<CourseFormula> list = normals();
  for (const double r : {0.2, 0.8}) {
    list.push_back({fmt::format("Mixture of cosine and GGX: reflectance of a white diffuse surface, roughness {}", r),
                    "p = r p_d + (1-r) p_s, the one not sampled set to 1", "both evaluated at the direction taken",
                    mixtureReflectance(r), 1});
  }
  const double seen = kPi / 100; // of the whole disk: π r²/d²
  list.push_back({"Round light, ten radii away: irradiance, shadowed by itself", "p = |x-x'|² / 4πr²",
                  "p = |x-x'|² / (4πr² |cos θ'|)", sphereIrradiance(10, false), seen});
  list.push_back({"The same without visibility", "likewise", "the far side contributes nothing",
                  sphereIrradiance(10, true), seen});
  for (CourseFormula& formula : fresnels()) list.push_back(std::move(formula));
  list.push_back(gamma());
  // Sum of ρ^k over the reflections that the path is allowed.
  list.push_back({"A path that ends on emitters: in a closed room of emission 1 and reflectance 0.5", "L = Le",
                  "emission is added and the path goes on: Le / (1 - ρ)", 1, 2});
  return list;
}

} // namespace isophote::cli
