// The table behind shaders/bsdf/ggx_albedo.glsl.
#pragma once

#include <vector>

#include <glm/glm.hpp>

namespace isophote {

/// The integrals (A, B) of isotropic GGX over outgoing cosine and roughness, laid out as shared/bsdf_constants.h says,
/// computed in double precision at the first call (about 0.1 s) and kept.
///
/// A and B are the directional albedo's parts with Fresnel weights 1 - (1-c)^5 and (1-c)^5, c the cosine at the half
/// vector; distribution and height-correlated masking as in Heitz 2014, "Understanding the Masking-Shadowing Function
/// in Microfacet-Based BRDFs", JCGT 3(2). Roughness 0 is the smooth mirror: A = 1 - (1-mu)^5, B = (1-mu)^5.
[[nodiscard]] const std::vector<glm::vec2>& ggxAlbedoTable();

} // namespace isophote
