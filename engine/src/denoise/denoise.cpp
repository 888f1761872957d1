#include "isophote/denoise.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "denoise/atrous_filter.hpp"
#include "isophote/error.hpp"

namespace isophote {
namespace {

constexpr std::array<const char*, 3> kColors = {"R", "G", "B"};
constexpr std::array<const char*, 3> kAxes = {"X", "Y", "Z"};
constexpr const char* kLayer = "denoised.";

/// Light is divided by the albedo that it was multiplied by, but by no less: what shines on a black surface is no
/// diffuse reflection.
constexpr float kLeastAlbedo = 0.05f;

const std::vector<float>& valuesOf(const Image& image, const std::string& name) {
  const Channel* channel = image.find(name);
  if (channel == nullptr) throw UsageError("there is no layer " + name + ", which the denoiser needs");
  return channel->values;
}

std::vector<glm::vec3> vectorsOf(const Image& image, const std::string& prefix,
                                 const std::array<const char*, 3>& components) {
  std::vector<glm::vec3> vectors(size_t{image.width} * image.height);
  for (size_t c = 0; c < 3; ++c) {
    const std::vector<float>& values = valuesOf(image, prefix + components[c]);
    for (size_t i = 0; i < vectors.size(); ++i) vectors[i][static_cast<int>(c)] = values[i];
  }
  return vectors;
}

std::vector<denoise::Guide> guidesOf(const Image& image) {
  const std::vector<glm::vec3> albedo = vectorsOf(image, "albedo.", kColors);
  const std::vector<glm::vec3> normal = vectorsOf(image, "normal.", kAxes);
  const std::vector<glm::vec3> position = vectorsOf(image, "position.", kAxes);
  const std::vector<float>&coverage = valuesOf(image, "A"), &count = valuesOf(image, "sampleCount.Y");
  std::vector<denoise::Guide> guides(albedo.size());
  for (size_t i = 0; i < guides.size(); ++i) {
    guides[i] = {.albedo = albedo[i],
                 .normal = normal[i],
                 .position = position[i],
                 .coverage = coverage[i],
                 .empty = !(count[i] > 0)};
  }
  return guides;
}

/// What light is multiplied by in a pixel: albedo where there is a surface, nothing where the environment shows.
glm::vec3 modulation(const denoise::Guide& guide) {
  return glm::mix(glm::vec3(1), glm::max(guide.albedo, glm::vec3(kLeastAlbedo)), guide.coverage);
}

} // namespace

void addDenoised(Image& image) {
  const std::vector<denoise::Guide> guides = guidesOf(image);
  denoise::FilterImage light{.width = image.width,
                             .height = image.height,
                             .color = vectorsOf(image, "", kColors),
                             .variance = vectorsOf(image, "stderr.", kColors)};
  for (size_t i = 0; i < guides.size(); ++i) {
    const glm::vec3 divisor = modulation(guides[i]);
    light.color[i] /= divisor;
    light.variance[i] /= divisor;
    light.variance[i] *= light.variance[i];
  }
  light = denoise::atrousFilter(std::move(light), guides);
  for (int c = 0; c < 3; ++c) {
    const std::string name = kLayer + std::string(kColors[static_cast<size_t>(c)]);
    std::erase_if(image.channels, [&](const Channel& channel) { return channel.name == name; });
    Channel channel{name, std::vector<float>(guides.size())};
    for (size_t i = 0; i < guides.size(); ++i) channel.values[i] = light.color[i][c] * modulation(guides[i])[c];
    image.channels.push_back(std::move(channel));
  }
}

Image denoisedImage(const Image& image) {
  Image result{.width = image.width,
               .height = image.height,
               .attributes = image.attributes,
               .renderSeconds = image.renderSeconds};
  for (const char* color : kColors) result.channels.push_back({color, valuesOf(image, kLayer + std::string(color))});
  if (const Channel* alpha = image.find("A")) result.channels.push_back(*alpha);
  return result;
}

} // namespace isophote
