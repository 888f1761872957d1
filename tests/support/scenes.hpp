// Small scenes with known answers.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "envelope/scene_parts.hpp"
#include "isophote/scene.hpp"

namespace isophote::test {

using namespace envelope; // materials, primitives, cameras

/// The same scene without instancing: one mesh and instance per primitive, positions in world space.
/// For rigid, scaled and mirrored maps; normals and tangents follow.
[[nodiscard]] Scene flattened(const Scene& scene);

/// White floor under a sphere light at distance 2: radiance 1/4 at the origin, whatever its radius.
[[nodiscard]] Scene floorUnderASphere(float radius);

/// Floor of reflectance 1/2 under an environment of 3 in one half of the hemisphere and 1 in the other: radiance 1.
[[nodiscard]] Scene floorUnderAHalfBrightSky();

/// Point light at the center of a Lambert sphere of radius 1 seen from inside.
[[nodiscard]] Scene sphereWithPointLight(float intensity, float rho, uint32_t rings);

/// The Cornell box (Cornell University Program of Computer Graphics, "Cornell Box Data", measured geometry in mm; here
/// in metres, x turned to the right-handed frame). Reflectances and light are the RGB values common for it, see
/// scenes.cpp.
[[nodiscard]] Scene cornellBox();
[[nodiscard]] Camera cornellCamera();

/// Five smooth spheres side by side, roughness 0.1 to 1, metals above and dielectrics below.
[[nodiscard]] Scene materialSpheres();
[[nodiscard]] Camera materialSpheresCamera();

/// A ball of each kind, of radius 1/2 and side by side on a floor, under a small bright panel and a dim sky.
[[nodiscard]] Scene ballsOf(const std::vector<Material>& materials);
[[nodiscard]] Camera ballsCamera();

/// `layers` black sheets of opacity alpha over a white emitter, seen by an orthographic camera from +z.
[[nodiscard]] Scene alphaLayers(uint32_t layers, float alpha);

/// A width x height environment, black but for one texel.
[[nodiscard]] Environment oneTexelEnvironment(uint32_t width, uint32_t height, uint32_t x, uint32_t y,
                                              glm::vec3 radiance);

/// One mesh of two primitives instanced with rotation, uniform scale and mirroring, over a lit floor.
[[nodiscard]] Scene instanceGrid();
[[nodiscard]] Camera instanceGridCamera();

/// Textured, normal-mapped, vertex-colored, alpha-masked and emissive-textured surfaces under a constant environment.
[[nodiscard]] Scene texturedStillLife();
[[nodiscard]] Camera texturedStillLifeCamera();

/// Floor, box and sphere lit by a point, a spot and a directional light.
[[nodiscard]] Scene punctualStillLife();
[[nodiscard]] Camera punctualStillLifeCamera();

} // namespace isophote::test
