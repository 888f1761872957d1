// Refraction at the boundary between two dielectrics, and its Jacobians.
//
// Directions are unit; wo and wi leave the surface on its two sides. eta is the index behind the boundary, as wo sees
// it, over the index in front of it.
#ifndef ISOPHOTE_BSDF_DIELECTRIC_INTERFACE_GLSL
#define ISOPHOTE_BSDF_DIELECTRIC_INTERFACE_GLSL

/// Returns eta of a surface between air, which is on its front, and a dielectric of index `ior`.
float relativeIor(const float ior, const bool frontFace) { return frontFace ? ior : 1.0 / ior; }

/// Returns the direction in which light leaves that came along wo and was refracted by a facet of normal wm (Snell).
///
/// It is (-wo - k wm) / eta with k = eta cosT - cosI = (eta^2 - 1) / (eta cosT + cosI), which does not cancel for eta
/// near 1; for eta = 1 it is -wo to the last bit.
/// @param cosI dot(wo, wm), in (0, 1]
/// @return     unit; the zero vector for total internal reflection, by the same comparison as fresnelDielectric's
vec3 refractAbout(const vec3 wo, const vec3 wm, const float cosI, const float eta) {
  if (eta == 1.0) return -wo;
  const float contrast = (eta - 1.0) * (eta + 1.0);
  const float g2 = contrast + cosI * cosI; // (eta cosT)^2
  if (g2 <= 0.0) return vec3(0.0);
  return -normalize(wo + (contrast / (sqrt(g2) + cosI)) * wm);
}

/// A pair of directions joined by refraction, and the facet that joins them.
struct RefractingFacet {
  vec3 wm;        // unit, wm.z > 0
  float cosO;     // dot(wo, wm)
  float cosI;     // |dot(wi, wm)|
  float jacobian; // cosI / |wo + eta wi|^2; times eta^2: steradians of wm per steradian of wi
  bool valid;     // wo and wi lie on the facet's two sides
};

/// Finds the facet that refracts wo into wi.
///
/// Source: Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces", eq. 16 and 17.
/// @param eta not 1
RefractingFacet refractingFacet(const vec3 wo, const vec3 wi, const float eta) {
  const vec3 sum = wo + eta * wi;
  const float length2 = dot(sum, sum); // at least (eta - 1)^2
  const vec3 wm = sum * ((sum.z < 0.0 ? -1.0 : 1.0) * inversesqrt(length2));
  const float cosO = dot(wo, wm);
  const float cosI = -dot(wi, wm);
  return RefractingFacet(wm, cosO, cosI, cosI / length2, cosO > 0.0 && cosI > 0.0);
}

#endif
