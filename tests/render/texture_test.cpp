// Textures, normal maps and vertex colors: single lookups exactly, whole scenes against the reference.
#include <gtest/gtest.h>

#include "oracle/texture_lookup.hpp"
#include "support/render.hpp"
#include "support/scenes.hpp"

namespace isophote {
namespace {

using namespace isophote::test;

/// Vulkan lets linear filtering weigh texels in steps of 2^-8 (subTexelPrecisionBits may be as low as 4, the devices
/// this runs on have 8): a lookup may be off by one step of the largest contrast, here 1.
constexpr double kFilterStep = 1.0 / 256;

const std::vector<glm::u8vec4>& texels() {
  static const std::vector<glm::u8vec4> kTexels{{255, 40, 40, 255}, {40, 255, 40, 128},  {40, 40, 255, 255},
                                                {200, 200, 30, 64}, {30, 200, 200, 255}, {200, 30, 200, 255}};
  return kTexels;
}

std::string textureLookupName(const testing::TestParamInfo<std::tuple<Filter, Wrap>>& info) {
  const char* const filters[] = {"Linear", "Nearest"};
  const char* const wraps[] = {"Repeat", "Clamp", "Mirror"};
  return std::string(filters[static_cast<size_t>(std::get<0>(info.param))]) +
         wraps[static_cast<size_t>(std::get<1>(info.param))];
}

class TextureLookups : public testing::TestWithParam<std::tuple<Filter, Wrap>> {};

TEST_P(TextureLookups, UnlitQuadShowsTheTextureAtPixelCenters) {
  const auto [filter, wrap] = GetParam();
  Scene scene;
  Material material;
  material.unlit = true;
  material.baseColorTexture = useTexture(addTexture(scene, 3, 2, texels(), filter, wrap));
  material.baseColorTexture.uRow = {2.5f, 0, -0.8f}; // beyond both ends of [0, 1]
  material.baseColorTexture.vRow = {0.3f, 2.5f, -0.7f};
  addPrimitive(scene, facingQuad(1, 1, addMaterial(scene, material)));
  // One sample somewhere in a pixel of 2/64: the texture is read where the position layer says the ray hit.
  constexpr uint32_t kSize = 64;
  const Image image = renderImage(scene, orthographicLookAt({0, 0, 1}, {}, 1, 1), kSize, kSize, 1);
  const auto red = plane(image, "R"), green = plane(image, "G"), blue = plane(image, "B");
  const auto x = plane(image, "position.X"), y = plane(image, "position.Y");
  uint32_t wrong = 0;
  for (size_t i = 0; i < red.size(); ++i) {
    const glm::dvec2 uv((x[i] + 1) / 2, (1 - y[i]) / 2);
    const glm::dvec4 expected = oracle::lookUp(scene, material.baseColorTexture, uv, oracle::Encoding::Srgb);
    const glm::dvec3 difference = glm::abs(glm::dvec3(red[i], green[i], blue[i]) - glm::dvec3(expected));
    if (std::max({difference.x, difference.y, difference.z}) > 2 * kFilterStep) ++wrong; // two axes
  }
  // Rounding may put a point on the other side of a texel's border: rarely, and only without interpolation.
  EXPECT_LE(wrong, filter == Filter::Nearest ? 4u : 0u);
}

INSTANTIATE_TEST_SUITE_P(RenderTexture, TextureLookups,
                         testing::Combine(testing::Values(Filter::Linear, Filter::Nearest),
                                          testing::Values(Wrap::Repeat, Wrap::ClampToEdge, Wrap::MirroredRepeat)),
                         textureLookupName);

TEST(RenderTexture, EightBitSrgbIsDecodedWithinHalfAStep) {
  // Devices decode sRGB in the sampler, some by a fitted curve: half a step of the encoding is what to expect of them.
  Scene scene;
  std::vector<glm::u8vec4> ramp;
  for (uint32_t i = 0; i < 256; ++i) ramp.emplace_back(i, i, i, 255);
  Material material;
  material.unlit = true;
  material.baseColorTexture = useTexture(addTexture(scene, 256, 1, ramp, Filter::Nearest, Wrap::ClampToEdge));
  addPrimitive(scene, facingQuad(256, 1, addMaterial(scene, material)));
  const Image image = renderImage(scene, orthographicLookAt({0, 0, 1}, {}, 256, 1), 256, 1, 1);
  const auto decoded = plane(image, "G");
  for (uint32_t i = 0; i < 256; ++i) {
    EXPECT_GE(decoded[i], oracle::decodeSrgb(std::max(i - 0.5, 0.0) / 255) - 1e-7) << i;
    EXPECT_LE(decoded[i], oracle::decodeSrgb((i + 0.5) / 255)) << i;
  }
}

TEST(RenderTexture, SixteenBitTexelsKeepTheirPrecision) {
  Scene scene;
  ImageData image;
  image.width = image.height = 1;
  image.bitsPerChannel = 16;
  for (const uint32_t value : {0x1234u, 0x8001u, 0xfffeu, 0xffffu}) {
    image.pixels.push_back(static_cast<std::byte>(value & 0xff));
    image.pixels.push_back(static_cast<std::byte>(value >> 8));
  }
  scene.images.push_back(image);
  scene.textures.push_back({});
  Material material;
  material.unlit = true;
  material.baseColorTexture = useTexture(0);
  addPrimitive(scene, facingQuad(2, 2, addMaterial(scene, material)));
  const Image render = renderImage(scene, lookAt({0, 0, 1}, {}, 0.5), 1, 1, 1);
  const char* const names[] = {"R", "G", "B"};
  const double encoded[] = {0x1234 / 65535.0, 0x8001 / 65535.0, 0xfffe / 65535.0};
  for (size_t c = 0; c < 3; ++c) {
    const double expected = oracle::decodeSrgb(encoded[c]);
    EXPECT_NEAR(plane(render, names[c])[0], expected, 1e-4 * expected);
  }
}

TEST(RenderTexture, StillLifeWithEveryKindOfTextureMatchesTheReference) {
  const Scene scene = texturedStillLife();
  const Camera camera = texturedStillLifeCamera();
  const auto reference = oracle::renderReference(scene, camera, 36, 32, 1024, {.seed = 7});
  const Image image = renderImage(scene, camera, 36, 32, 768);
  EXPECT_TRUE(sameImage(measured(image), measured(reference), {.absoluteTolerance = kFilterStep, .powerFloor = 0.01}));
}

TEST(RenderTexture, TexturedEmittersLightAFloorLikeTheReference) {
  Scene scene = lambertFloor(glm::vec3(0.8f), 2);
  Material screen = emitter({4, 4, 4});
  screen.emissiveTexture =
      useTexture(addTexture(scene, 2, 1, {{255, 0, 0, 255}, {0, 255, 255, 255}}, Filter::Nearest, Wrap::ClampToEdge));
  addPrimitive(scene, quad({-1, 0.2, -1}, {2, 0, 0}, {0, 1, 0}, addMaterial(scene, screen)));
  const Camera camera = lookAt({0, 1.5, 3}, {0, 0.3, 0}, 0.8);
  const auto reference = oracle::renderReference(scene, camera, 24, 24, 1024, {.seed = 8});
  const Image image = renderImage(scene, camera, 24, 24, 1024);
  EXPECT_TRUE(sameImage(measured(image), measured(reference), {.powerFloor = 0.015}));
}

} // namespace
} // namespace isophote
