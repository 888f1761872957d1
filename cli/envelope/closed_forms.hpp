// Exact answers in double precision.
#pragma once

#include <vector>

#include <glm/glm.hpp>

namespace isophote::envelope {

inline constexpr double kPi = 3.14159265358979323846;

/// Irradiance at the origin with normal +y from a polygon of radiance 1 above the horizon. Source: Lambert 1760,
/// "Photometria": half the sum of edge angles times the cosine between the edge's plane normal and the receiver's.
[[nodiscard]] double polygonIrradiance(const std::vector<glm::dvec3>& vertices);

/// Reflectance of the boundary to a dielectric of index `eta` over that in front, the mean of both polarizations
/// (Fresnel 1823). @param cosine  of the angle of incidence, in [0, 1]
[[nodiscard]] double fresnelReflectance(double cosine, double eta);

/// What a clear plate lets through, all reflections between its faces summed: (1 - R) / (1 + R).
[[nodiscard]] double plateTransmittance(double cosine, double eta);

/// Radiance of a GGX mirror (Smith masking, correlated heights, one scattering, reflectance 1) looked at along its
/// normal, that reflects a disk of radiance 1 and angular radius `radius` around the normal.
[[nodiscard]] double ggxReflectionOfDisk(double alpha, double radius);

} // namespace isophote::envelope
