#include "oracle/surface.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "oracle/texture_lookup.hpp"

namespace isophote::oracle {

namespace {

/// One hit with the tables its attributes come from.
struct Attributes {
  const Scene& scene;
  const Primitive& primitive;
  const Material& material;
  glm::uvec3 vertices;
  glm::dvec3 weights;

  Attributes(const Scene& source, const Triangle& triangle, const Hit& hit)
      : scene(source),
        primitive(source.meshes[source.instances[triangle.instance].mesh].primitives[triangle.primitive]),
        material(source.materials[triangle.material]), vertices(0), weights(1 - hit.b1 - hit.b2, hit.b1, hit.b2) {
    for (int corner = 0; corner < 3; ++corner)
      vertices[corner] = primitive.indices[size_t{3} * triangle.index + static_cast<size_t>(corner)];
  }

  template <int N> [[nodiscard]] glm::vec<N, double> interpolate(const std::vector<glm::vec<N, float>>& values) const {
    using Vector = glm::vec<N, double>;
    return weights.x * Vector(values[vertices.x]) + weights.y * Vector(values[vertices.y]) +
           weights.z * Vector(values[vertices.z]);
  }

  [[nodiscard]] glm::dvec4 texture(const TextureRef& reference, Encoding encoding) const {
    const auto& uvs = primitive.uvs[reference.uvSet];
    const glm::dvec2 uv = uvs.empty() ? glm::dvec2(0) : interpolate<2>(uvs);
    return lookUp(scene, reference, uv, encoding);
  }

  [[nodiscard]] glm::dvec4 baseColor() const {
    glm::dvec4 color(material.baseColor);
    if (material.baseColorTexture.present()) color *= texture(material.baseColorTexture, Encoding::Srgb);
    if (!primitive.colors.empty()) color *= interpolate<4>(primitive.colors);
    return color;
  }
};

SurfaceMaterial evaluateMaterial(const Attributes& at) {
  SurfaceMaterial result;
  const Material& source = at.material;
  result.baseColor = glm::clamp(glm::dvec3(at.baseColor()), 0.0, 1.0); // a reflectance, whatever the vertex colors say
  result.metallic = source.metallic;
  result.roughness = source.roughness;
  result.ior = source.ior;
  result.specular = source.specular;
  result.specularColor = glm::dvec3(source.specularColor);
  if (source.metallicRoughnessTexture.present()) {
    const glm::dvec4 texel = at.texture(source.metallicRoughnessTexture, Encoding::Linear);
    result.roughness *= texel.y;
    result.metallic *= texel.z;
  }
  if (source.specularTexture.present()) result.specular *= at.texture(source.specularTexture, Encoding::Linear).w;
  if (source.specularColorTexture.present())
    result.specularColor *= glm::dvec3(at.texture(source.specularColorTexture, Encoding::Srgb));
  result.clearcoat = source.clearcoat.factor;
  if (source.clearcoat.texture.present()) result.clearcoat *= at.texture(source.clearcoat.texture, Encoding::Linear).x;
  result.clearcoatRoughness = source.clearcoat.roughness;
  if (source.clearcoat.roughnessTexture.present())
    result.clearcoatRoughness *= at.texture(source.clearcoat.roughnessTexture, Encoding::Linear).y;
  result.sheenColor = glm::dvec3(source.sheen.color);
  if (source.sheen.colorTexture.present())
    result.sheenColor *= glm::dvec3(at.texture(source.sheen.colorTexture, Encoding::Srgb));
  result.sheenRoughness = source.sheen.roughness;
  if (source.sheen.roughnessTexture.present())
    result.sheenRoughness *= at.texture(source.sheen.roughnessTexture, Encoding::Linear).w;
  result.anisotropy = source.anisotropy.strength;
  if (source.anisotropy.texture.present())
    result.anisotropy *= at.texture(source.anisotropy.texture, Encoding::Linear).z;
  const Iridescence& film = source.iridescence;
  result.film = {double(film.factor), double(film.ior), double(film.thicknessMaximum)};
  if (film.texture.present()) result.film.amount *= at.texture(film.texture, Encoding::Linear).x;
  if (film.thicknessTexture.present())
    result.film.thickness = std::lerp(double(film.thicknessMinimum), double(film.thicknessMaximum),
                                      at.texture(film.thicknessTexture, Encoding::Linear).y);
  if (source.conductor.given) {
    result.conductorN = glm::dvec3(source.conductor.n);
    result.conductorK = glm::dvec3(source.conductor.k);
  }
  result.transmission = source.ior >= 1 ? source.transmission.factor : 0; // index 0 is infinite: nothing gets in
  if (source.transmission.texture.present())
    result.transmission *= at.texture(source.transmission.texture, Encoding::Linear).x;
  const DiffuseTransmission& diffuse = source.diffuseTransmission;
  result.diffuseTransmission = diffuse.factor;
  if (diffuse.texture.present()) result.diffuseTransmission *= at.texture(diffuse.texture, Encoding::Linear).w;
  result.diffuseTransmissionColor = glm::dvec3(diffuse.color);
  if (diffuse.colorTexture.present())
    result.diffuseTransmissionColor *= glm::dvec3(at.texture(diffuse.colorTexture, Encoding::Srgb));
  result.thinWalled = source.volume.thickness == 0;
  result.dispersion = source.dispersion;
  return result;
}

/// Unit shading normal on the front side: interpolated normal, bent by a normal texture (glTF 2.0, 3.9.3).
/// Interpolated normals on the far side of the triangle are turned over.
glm::dvec3 frontShadingNormal(const Attributes& at, const Triangle& triangle, const TextureRef& normalTexture) {
  if (at.primitive.normals.empty()) return triangle.ng;
  const glm::dmat3 worldFromObject(at.scene.instances[triangle.instance].worldFromObject);
  glm::dvec3 normal =
      glm::normalize(glm::transpose(glm::inverse(worldFromObject)) * at.interpolate<3>(at.primitive.normals));
  if (glm::dot(normal, triangle.ng) < 0) normal = -normal;
  if (!normalTexture.present() || at.primitive.tangents.empty()) return normal;
  const glm::dvec4 source = at.interpolate<4>(at.primitive.tangents);
  const glm::dvec3 along = worldFromObject * glm::dvec3(source);
  const glm::dvec3 tangent = glm::normalize(along - normal * glm::dot(normal, along));
  const double handedness = (source.w < 0 ? -1.0 : 1.0) * (glm::determinant(worldFromObject) < 0 ? -1.0 : 1.0);
  const glm::dvec3 bitangent = glm::cross(normal, tangent) * handedness;
  const glm::dvec3 texel = 2.0 * glm::dvec3(at.texture(normalTexture, Encoding::Linear)) - 1.0;
  const double scale = normalTexture.scale;
  return glm::normalize(scale * texel.x * tangent + scale * texel.y * bitangent + texel.z * normal);
}

/// Unit direction of anisotropy about `normal`, the shading normal on the front side. Source: Khronos,
/// KHR_materials_anisotropy: the texture's direction 2t - 1 in the tangent plane, turned counter-clockwise.
glm::dvec3 anisotropyDirection(const Attributes& at, const Triangle& triangle, glm::dvec3 normal) {
  const Anisotropy& source = at.material.anisotropy;
  if (source.strength == 0 || at.primitive.tangents.empty()) return glm::dvec3(0);
  const glm::dmat3 worldFromObject(at.scene.instances[triangle.instance].worldFromObject);
  const glm::dvec4 interpolated = at.interpolate<4>(at.primitive.tangents);
  const glm::dvec3 along = worldFromObject * glm::dvec3(interpolated);
  const glm::dvec3 tangent = glm::normalize(along - normal * glm::dot(normal, along));
  const double handedness = (interpolated.w < 0 ? -1.0 : 1.0) * (glm::determinant(worldFromObject) < 0 ? -1.0 : 1.0);
  const glm::dvec3 bitangent = glm::cross(normal, tangent) * handedness;
  glm::dvec2 direction(1, 0);
  if (source.texture.present()) direction = 2.0 * glm::dvec2(at.texture(source.texture, Encoding::Linear)) - 1.0;
  const double cosine = std::cos(double(source.rotation)), sine = std::sin(double(source.rotation));
  return glm::normalize((cosine * direction.x - sine * direction.y) * tangent +
                        (sine * direction.x + cosine * direction.y) * bitangent);
}

/// A rule of the renderer's surface model: a shading normal that leans away from the viewer is turned towards wo, in
/// the plane of the two, until its cosine to wo is 0.01, or the geometric normal's where that is less.
glm::dvec3 turnedToViewer(glm::dvec3 ns, glm::dvec3 ng, glm::dvec3 wo) {
  const double least = std::min(0.01, glm::dot(ng, wo));
  if (glm::dot(ns, wo) >= least) return ns;
  const glm::dvec3 across = ns - glm::dot(ns, wo) * wo;
  const double length = glm::length(across);
  if (length < 1e-4) return ng;
  return glm::normalize(least * wo + std::sqrt(1 - least * least) / length * across);
}

} // namespace

SurfacePoint evaluateSurface(const Scene& scene, const Triangle& triangle, const Hit& hit, glm::dvec3 wo) {
  const Attributes at(scene, triangle, hit);
  SurfacePoint point;
  point.position = triangle.v0 + hit.b1 * triangle.edge1 + hit.b2 * triangle.edge2;
  const double side = glm::dot(triangle.ng, wo) < 0 ? -1 : 1;
  point.ng = side * triangle.ng;
  point.frontFace = side > 0;
  point.unlit = at.material.unlit;
  if (point.unlit) {
    point.emission = glm::dvec3(at.baseColor());
    return point;
  }
  point.ns = turnedToViewer(side * frontShadingNormal(at, triangle, at.material.normalTexture), point.ng, wo);
  point.coatNormal =
      turnedToViewer(side * frontShadingNormal(at, triangle, at.material.clearcoat.normalTexture), point.ng, wo);
  point.along = anisotropyDirection(at, triangle, side * point.ns);
  point.emission = evaluateEmission(scene, triangle, hit, wo);
  point.material = evaluateMaterial(at);
  return point;
}

glm::dvec3 evaluateEmission(const Scene& scene, const Triangle& triangle, const Hit& hit, glm::dvec3 wo) {
  const Attributes at(scene, triangle, hit);
  if (at.material.unlit || at.material.emissive == glm::vec3(0)) return glm::dvec3(0);
  if (!at.material.doubleSided && glm::dot(triangle.ng, wo) <= 0) return glm::dvec3(0);
  const glm::dvec3 factor(at.material.emissive);
  if (!at.material.emissiveTexture.present()) return factor;
  return factor * glm::dvec3(at.texture(at.material.emissiveTexture, Encoding::Srgb));
}

double evaluateCoverage(const Scene& scene, const Triangle& triangle, const Hit& hit) {
  if (triangle.opaque) return 1;
  const Attributes at(scene, triangle, hit);
  const double alpha = at.baseColor().w;
  if (at.material.alphaMode == AlphaMode::Mask) return alpha >= at.material.alphaCutoff ? 1 : 0;
  return std::clamp(alpha, 0.0, 1.0);
}

} // namespace isophote::oracle
