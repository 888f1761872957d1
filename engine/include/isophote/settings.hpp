// What a render is asked to do. Defaults are unbiased.
#pragma once

#include <cstdint>
#include <limits>

#include <glm/glm.hpp>

namespace isophote {

/// Sobol: a pixel's eight replicates are scrambled independently, which makes its error bars true. SobolJoint: its
/// samples are one sequence, which makes the image better and its error bars too wide.
enum class SamplerKind : uint32_t { Sobol, Independent, SobolJoint };
enum class PixelFilter : uint32_t { Box, Gaussian, BlackmanHarris };
enum class LightSampling : uint32_t { Mis, LightsOnly, BsdfOnly };
enum class LightSelection : uint32_t { Uniform, Power, Bvh };
enum class TriangleLightSampling : uint32_t { Area, SolidAngle };
/// Both see the whole sphere: uniformly in solid angle, or over its area as Monte Carlo textbooks begin.
enum class SphereLightSampling : uint32_t { Cone, Area };
enum class DirectionSampling : uint32_t { Lobes, Uniform, Cosine, Ndf, VisibleNormals, Mixture };
/// What glass does to shadow rays: it blocks them, and paths find the light behind it; or they cross it unbent
/// (biased).
enum class ShadowTransmission : uint32_t { Off, Straight };
enum class MisHeuristic : uint32_t { Balance, Power };
/// Distribution of microfacet normals; alpha = roughness^2 is its width in all three.
enum class Ndf : uint32_t { Ggx, Beckmann, BlinnPhong };
/// Smith's masking and shadowing of microfacets, correlated by their height or as if independent.
enum class Masking : uint32_t { Correlated, Separable };
/// Reflectance of dielectrics: exact for glass and Schlick's approximation for opaque ones, as glTF has it; or one of
/// both throughout.
enum class Fresnel : uint32_t { Gltf, Exact, Schlick };
/// How likely a dim path goes on: as the root of its throughput, or as its throughput.
enum class RussianRoulette : uint32_t { Off, Root, Throughput };
/// Rays against triangles: without gaps at edges, or by Moeller and Trumbore's test, which has them (biased).
enum class Intersection : uint32_t { Watertight, Fast };
/// How far from a surface rays start: beyond what rounding did to the point, or 1e-4 scene units (biased).
enum class RayOffset : uint32_t { Bound, Fixed };
/// Sines, cosines and angles: own polynomials, or the device's functions, whose error differs by device (biased).
enum class Trigonometry : uint32_t { Own, Device };
/// Textures of materials: filtered as the asset says, or the nearest texel (biased).
enum class TextureFilter : uint32_t { Asset, Nearest };
/// How a path gets from one vertex to the next: a kernel for each stage with queues between them, or all stages in one
/// kernel. Auto: on CPU devices whichever traces more rays a second, as a race of the two tells; on others Wavefront.
enum class Pipeline : uint32_t { Wavefront, Fused, Auto };

inline constexpr uint32_t kUnlimitedDepth = std::numeric_limits<uint32_t>::max();
inline constexpr float kNoClamp = std::numeric_limits<float>::infinity();

/// Everything the image depends on besides scene, camera and sample range.
struct EstimatorSettings {
  SamplerKind sampler = SamplerKind::Sobol;
  PixelFilter filter = PixelFilter::BlackmanHarris;
  LightSampling lightSampling = LightSampling::Mis;
  LightSelection lightSelection = LightSelection::Bvh; ///< Bvh: by power where the scene has few lights
  TriangleLightSampling triangleLightSampling = TriangleLightSampling::SolidAngle;
  DirectionSampling directionSampling = DirectionSampling::Lobes;
  MisHeuristic misHeuristic = MisHeuristic::Power;
  SphereLightSampling sphereLightSampling = SphereLightSampling::Cone;
  ShadowTransmission shadowTransmission = ShadowTransmission::Off;
  uint32_t maxDepth = kUnlimitedDepth; ///< scattering events on a path; 0: emission seen directly
  RussianRoulette russianRoulette = RussianRoulette::Root;
  Ndf ndf = Ndf::Ggx;
  Masking masking = Masking::Correlated;
  Fresnel fresnel = Fresnel::Gltf;
  Intersection intersection = Intersection::Watertight;
  RayOffset rayOffset = RayOffset::Bound;
  Trigonometry trigonometry = Trigonometry::Own;
  TextureFilter textureFilter = TextureFilter::Asset;
  bool multipleScattering = true; ///< between the facets of rough surfaces; false loses their light
  /// Radiance of a sample's brightest channel; brighter samples are scaled down to it, which removes light.
  float clamp = kNoClamp;
  uint64_t seed = 0;
};

/// Who finds what a ray meets: the project's own BVH and kernels, or the device's acceleration structures
/// (VK_KHR_ray_query). Where a ray passes within rounding of an edge, or two surfaces coincide, they may choose
/// another triangle.
enum class Backend : uint32_t { Compute, RayQuery };

/// What a scene's BVHs are built for: rays that take few steps, or being there soon. A ray that meets two surfaces at
/// the same distance may get the other one; the image is the same otherwise.
enum class BvhBuild : uint32_t { FastTrace, FastBuild };

/// How the work is cut; never changes a bit of the image on one device and driver.
struct ExecutionSettings {
  /// Paths in flight. 0: found by measurement in a long render, and kept for the device in the user's cache.
  uint32_t pathPoolSize = 0;
  uint32_t workgroupSize = 0; ///< 0: chosen for the device
  Pipeline pipeline = Pipeline::Auto;
  /// Pipeline::Auto tries the second pipeline once its compilation takes at most this share of the time before it.
  double compileShare = 0.02;
  bool specialize = true;          ///< false: the all-features kernels
  bool depthLedger = true;         ///< with a maxDepth and a film that asks: follow some paths on, to measure its cost
  double submitMilliseconds = 100; ///< aim for the length of one submit
};

/// A rectangle of the full image in pixels, [x0, x1) x [y0, y1), row 0 at the top.
struct PixelRect {
  uint32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  bool operator==(const PixelRect&) const = default;
};

/// Samples [first, last) of every pixel.
struct SampleRange {
  uint32_t first = 0;
  uint32_t last = 0;
  uint64_t begun =
      0; ///< places in the order of rendering at which sample `first` is done already; see PathTracer::left
  bool operator==(const SampleRange&) const = default;
};

} // namespace isophote
