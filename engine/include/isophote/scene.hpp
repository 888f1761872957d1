// The scene as plain CPU values: what a loader produces and packScene consumes. No Vulkan here.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace isophote {

inline constexpr int32_t kNone = -1;      ///< "no such thing" for signed indices below
inline constexpr uint32_t kMaxUvSets = 4; ///< TEXCOORD_0 to TEXCOORD_3

enum class Wrap : uint32_t { Repeat, ClampToEdge, MirroredRepeat };
enum class Filter : uint32_t { Linear, Nearest };
enum class AlphaMode : uint32_t { Opaque, Mask, Blend };

/// Decoded pixels, row 0 at the top, 4 interleaved channels (missing ones filled: grey replicated, alpha 1).
struct ImageData {
  std::string name;
  uint32_t width = 0;
  uint32_t height = 0;
  uint32_t bitsPerChannel = 8;   ///< 8 or 16, little endian
  std::vector<std::byte> pixels; ///< width * height * 4 * bitsPerChannel / 8 bytes
};

struct Texture {
  uint32_t image = 0;
  Wrap wrapS = Wrap::Repeat;
  Wrap wrapT = Wrap::Repeat;
  Filter filter = Filter::Linear; ///< the magnification filter: a path tracer reads level 0 only
};

/// A use of a texture by a material.
struct TextureRef {
  int32_t texture = kNone;
  uint32_t uvSet = 0;
  float scale = 1.0f; ///< normalTexture.scale; 1 elsewhere
  /// Rows of the affine map from mesh uv to texture uv (KHR_texture_transform), uv' = (dot(row, (u, v, 1))).
  glm::vec3 uRow{1, 0, 0};
  glm::vec3 vRow{0, 1, 0};

  [[nodiscard]] bool present() const { return texture != kNone; }
};

/// KHR_materials_clearcoat: a colorless dielectric layer of index 1.5 on top.
struct Clearcoat {
  float factor = 0; ///< 0: no coat
  float roughness = 0;
  TextureRef texture;          ///< R
  TextureRef roughnessTexture; ///< G
  TextureRef normalTexture;    ///< absent: the interpolated normal, not the base's bumped one
};

/// KHR_materials_sheen: a layer of fibres under the coat.
struct Sheen {
  glm::vec3 color{0}; ///< black: no sheen
  float roughness = 0;
  TextureRef colorTexture;     ///< sRGB
  TextureRef roughnessTexture; ///< A
};

/// KHR_materials_anisotropy: alpha along the tangent grows to 1 with strength^2.
struct Anisotropy {
  float strength = 0;
  float rotation = 0; ///< radians, counter-clockwise from the tangent
  TextureRef texture; ///< RG: direction 2t - 1, B: strength
};

/// KHR_materials_iridescence: a thin film on the specular lobe.
struct Iridescence {
  float factor = 0; ///< 0: no film
  float ior = 1.3f;
  float thicknessMinimum = 100; ///< nm, where the thickness texture is 0
  float thicknessMaximum = 400; ///< nm, where it is 1 and where there is none
  TextureRef texture;           ///< R
  TextureRef thicknessTexture;  ///< G
};

/// KHR_materials_transmission: the share of the dielectric base that is glass instead of diffuse.
struct Transmission {
  float factor = 0;
  TextureRef texture; ///< R
};

/// KHR_materials_diffuse_transmission: the share of the diffuse lobe that scatters to the other side.
struct DiffuseTransmission {
  float factor = 0;
  glm::vec3 color{1};
  TextureRef texture;      ///< A
  TextureRef colorTexture; ///< sRGB
};

/// KHR_materials_volume and _volume_scatter: what fills a closed mesh. Lengths are in world units.
struct Volume {
  float thickness = 0; ///< 0: thin-walled, no volume behind the surface
  glm::vec3 attenuationColor{1};
  float attenuationDistance = 0;  ///< distance at which white has become attenuationColor; 0: infinite
  glm::vec3 multiscatterColor{0}; ///< multiple-scattering albedo; black: absorption only
  float scatterAnisotropy = 0;    ///< Henyey-Greenstein g, in (-1, 1)
  TextureRef thicknessTexture;    ///< G
};

/// Metallic-roughness and its extensions. Factors are linear; a texture multiplies the factor it stands beside.
struct Material {
  std::string name;
  glm::vec4 baseColor{1};
  float metallic = 1;
  float roughness = 1;   ///< perceptual; alpha = roughness^2
  glm::vec3 emissive{0}; ///< emissiveFactor * emissiveStrength, radiance
  float ior = 1.5f;
  float dispersion = 0; ///< KHR_materials_dispersion: 20 / Abbe number
  float specular = 1;
  glm::vec3 specularColor{1};
  AlphaMode alphaMode = AlphaMode::Opaque;
  float alphaCutoff = 0.5f;
  bool doubleSided = false;
  bool unlit = false;
  Clearcoat clearcoat;
  Sheen sheen;
  Anisotropy anisotropy;
  Iridescence iridescence;
  Transmission transmission;
  DiffuseTransmission diffuseTransmission;
  Volume volume;
  TextureRef baseColorTexture;         ///< sRGB
  TextureRef metallicRoughnessTexture; ///< G roughness, B metallic, linear
  TextureRef normalTexture;
  TextureRef emissiveTexture;      ///< sRGB
  TextureRef specularTexture;      ///< A, linear
  TextureRef specularColorTexture; ///< sRGB
};

/// The texture uses of a material, present or not, for loops over all of them.
[[nodiscard]] std::vector<TextureRef*> textureRefs(Material& material);
[[nodiscard]] std::vector<const TextureRef*> textureRefs(const Material& material);

/// One triangle list. Attribute arrays are empty or as long as `positions`; all values are finite.
struct Primitive {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;  ///< unit; empty: flat shading with the geometric normal
  std::vector<glm::vec4> tangents; ///< unit xyz, w = +-1; present whenever the material has a normal texture
  std::array<std::vector<glm::vec2>, kMaxUvSets> uvs;
  std::vector<glm::vec4> colors; ///< linear RGBA
  std::vector<uint32_t> indices; ///< 3 per triangle, each < positions.size(); degenerate triangles removed
  uint32_t material = 0;
};

struct Mesh {
  std::string name;
  std::vector<Primitive> primitives;
};

struct Instance {
  uint32_t mesh = 0;
  glm::dmat4 worldFromObject{1}; ///< accumulated in double; invertible
  std::string name;
};

enum class LightKind : uint32_t { Point, Spot, Directional };

/// KHR_lights_punctual. `intensity` is color * intensity: W/sr per channel, or W/m^2 for directional.
struct PunctualLight {
  std::string name;
  LightKind kind = LightKind::Point;
  glm::vec3 intensity{1};
  float range = 0;          ///< 0: unlimited
  float innerConeAngle = 0; ///< radians, spot only
  float outerConeAngle = 0.7853981634f;
  glm::dvec3 position{0};
  glm::dvec3 direction{0, 0, -1}; ///< unit, the way the light travels
};

enum class CameraKind : uint32_t { Perspective, Orthographic };

struct Camera {
  std::string name;
  CameraKind kind = CameraKind::Perspective;
  double yfov = 0.7853981633974483;  ///< radians, perspective
  std::optional<double> aspectRatio; ///< perspective: width / height; absent: the image decides
  double xmag = 1, ymag = 1;         ///< half extents of the orthographic view, world units
  double znear = 0;                  ///< geometry nearer along the view axis is not seen by the camera
  double zfar = 0;                   ///< 0: unlimited
  glm::dmat4 worldFromCamera{1};     ///< rigid (scale removed); looks down -z, y up
};

/// Equirectangular radiance map: row 0 is +y (up); columns run as u = 0.5 + atan2(d.x, -d.z) / 2pi.
/// One pixel makes a constant environment.
struct Environment {
  uint32_t width = 0;
  uint32_t height = 0;
  std::vector<glm::vec3> pixels; ///< linear radiance, finite, >= 0
  float intensity = 1;
  double rotation = 0; ///< radians about +y
};

struct Scene {
  std::string name; ///< path or label, used in messages and headers
  std::vector<ImageData> images;
  std::vector<Texture> textures;
  std::vector<Material> materials; ///< never empty once a primitive exists
  std::vector<Mesh> meshes;
  std::vector<Instance> instances;
  std::vector<PunctualLight> lights;
  std::vector<Camera> cameras;
  std::optional<Environment> environment;
  std::vector<std::string> warnings; ///< one line each, once per cause
  std::vector<std::string> extensionsUsed;
  std::vector<std::string> extensionsIgnored; ///< optional ones this build does not know
};

/// Axis-aligned bounds of all instances in world space; lower > upper when there is no geometry.
struct Bounds {
  glm::dvec3 lower{1e300};
  glm::dvec3 upper{-1e300};
  [[nodiscard]] bool empty() const { return lower.x > upper.x; }
};
[[nodiscard]] Bounds worldBounds(const Scene& scene);

/// A perspective camera that frames the whole scene; used where the asset has none.
[[nodiscard]] Camera framingCamera(const Scene& scene, double aspectRatio);

} // namespace isophote
