#include "upload/facets.hpp"

namespace isophote {
namespace {

using std::numbers::pi;

double beckmannLength(double z, double across) {
  if (across < 1e-9 * z) return z;
  const double a = z / across;
  return z * std::erf(a) + across / std::sqrt(pi) * std::exp(-a * a);
}

/// Mean of |c - s p| over slopes p of Student's distribution; see shaders/bsdf/blinn_phong.glsl.
double studentMeanProjection(double c, double s2, double b) {
  const double c2 = c * c;
  const bool steep = c2 < 0.5;
  const double exponent = b * (steep ? std::log1p(-c2) : std::log(std::max(s2, 1e-300)));
  if (exponent < -30) return c;
  const double tail = std::exp(std::lgamma(b + 0.5) - std::lgamma(b) + exponent) / std::sqrt(pi);
  const double x = steep ? c2 : s2;
  const double shift = steep ? 0.5 : b;
  double term = 1;
  double sum = 1;
  for (int j = 1; term > 1e-12 * sum; ++j) {
    term *= x * (b - 0.5 + j) / (shift + j);
    sum += term;
  }
  const double beyond = 2 / (2 * b - 1);
  return steep ? tail * (2 * c2 * sum + beyond) : c + tail * (beyond - c2 * sum / b);
}

} // namespace

double Facets::projectedLength(const glm::dvec3& w) const {
  if (model_.ndf == Ndf::Ggx) return ggxProjectedLength(w);
  const glm::dvec2 across = alpha_ * glm::dvec2(w);
  if (model_.ndf == Ndf::Beckmann) return beckmannLength(w.z, glm::length(across));
  const double area = alpha_.x * alpha_.y;
  const double across2 = glm::dot(across, across) / area;
  const double size = std::sqrt(across2 + w.z * w.z);
  return size * studentMeanProjection(std::min(w.z / size, 1.0), across2 / (size * size), 1 / area);
}

double Facets::ratioToGgx(double squaredSlope) const {
  if (model_.ndf == Ndf::Ggx) return 1;
  const double root = 1 + squaredSlope;
  if (model_.ndf == Ndf::Beckmann) return root * root * std::exp(-squaredSlope);
  const double b = 1 / (alpha_.x * alpha_.y);
  return root * root * std::exp(-(b + 1) * std::log1p(squaredSlope / b));
}

} // namespace isophote
