// Parts that small scenes with known answers are made of: for the sweeps here and for the tests.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "isophote/scene.hpp"

namespace isophote::envelope {

// Materials.

/// Ideal diffuse: metallic 0 and specular 0 leave the Lambert lobe alone.
[[nodiscard]] Material lambert(glm::vec3 reflectance);
/// Lambert surface that emits `radiance` from its front.
[[nodiscard]] Material emitter(glm::vec3 radiance, glm::vec3 reflectance = glm::vec3(0));
[[nodiscard]] Material metal(glm::vec3 baseColor, float roughness);
/// glTF's dielectric: a specular coat of index 1.5 over a diffuse base.
[[nodiscard]] Material dielectric(glm::vec3 baseColor, float roughness);
/// Clear glass that fills closed meshes.
[[nodiscard]] Material glass(float roughness, float ior = 1.5f);
/// A clear sheet without thickness.
[[nodiscard]] Material thinGlass(float roughness);

// Geometry. Every function returns one primitive of material `material`.

/// Parallelogram with front side cross(edgeU, edgeV), flat, uv (0, 0) at `corner`, (1, 0) at corner + edgeU.
[[nodiscard]] Primitive quad(glm::dvec3 corner, glm::dvec3 edgeU, glm::dvec3 edgeV, uint32_t material);
/// Quad in the xy plane around the origin, facing +z, with normals, tangents (+x) and uv (0, 0) at the upper left.
[[nodiscard]] Primitive facingQuad(double halfWidth, double halfHeight, uint32_t material);
/// Axis-aligned box; the front side is the outside unless `inward`.
[[nodiscard]] Primitive box(glm::dvec3 lower, glm::dvec3 upper, bool inward, uint32_t material);
/// Sphere of `rings` x 2 `rings` cells around the origin. Smooth ones carry normals; the front side is the outside
/// unless `inward`.
[[nodiscard]] Primitive sphere(double radius, uint32_t rings, bool smooth, bool inward, uint32_t material);

// Assembly.

uint32_t addMaterial(Scene& scene, const Material& material);
/// Adds the primitive as a mesh of its own with one instance; returns the mesh.
uint32_t addPrimitive(Scene& scene, Primitive primitive, const glm::dmat4& worldFromObject = glm::dmat4(1));
/// Adds an RGBA8 image, given row by row from the top, and a texture of it; returns the texture.
uint32_t addTexture(Scene& scene, uint32_t width, uint32_t height, const std::vector<glm::u8vec4>& texels,
                    Filter filter = Filter::Linear, Wrap wrap = Wrap::Repeat);
[[nodiscard]] TextureRef useTexture(uint32_t texture);
/// The environment of radiance `radiance` from everywhere.
[[nodiscard]] Environment constantEnvironment(glm::vec3 radiance);
// Cameras.

[[nodiscard]] Camera lookAt(glm::dvec3 position, glm::dvec3 target, double yfov);
/// Parallel view of half extents `halfWidth` x `halfHeight`.
[[nodiscard]] Camera orthographicLookAt(glm::dvec3 position, glm::dvec3 target, double halfWidth, double halfHeight);

// Scenes.

/// Closed box of 12 triangles, all emitting `Le` inwards and reflecting `rho`: the radiance is Le / (1 - rho)
/// everywhere.
[[nodiscard]] Scene boxFurnace(glm::vec3 Le, glm::vec3 rho);
/// A camera in the box, off its axes of symmetry.
[[nodiscard]] Camera boxFurnaceCamera();

/// Emitting unit square at height 1 over the origin, facing down, over a Lambert floor of reflectance 1.
[[nodiscard]] Scene squareLightOverFloor(float Le);
/// Looks straight down at `point` from below height 1; its view is so small that the irradiance is constant over it.
[[nodiscard]] Camera sensorAt(glm::dvec3 point);

/// Lambert floor of reflectance `rho` in y = 0, `halfSize` around the origin.
[[nodiscard]] Scene lambertFloor(glm::vec3 rho, double halfSize);

} // namespace isophote::envelope
