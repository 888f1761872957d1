#include "scene/gltf_textures.hpp"

#include <fmt/format.h>

#include "isophote/error.hpp"
#include "scene/gltf_specular_glossiness.hpp"
#include "scene/image_decode.hpp"
#include "scene/uri.hpp"
#include "scene/webp_decode.hpp"

namespace isophote::gltf {
namespace {

Wrap wrapMode(uint64_t code) {
  constexpr uint64_t kClampToEdge = 33071;
  constexpr uint64_t kMirroredRepeat = 33648;
  if (code == kClampToEdge) return Wrap::ClampToEdge;
  return code == kMirroredRepeat ? Wrap::MirroredRepeat : Wrap::Repeat;
}

/// The encoded bytes of an image: owned where they came from a URI.
struct EncodedImage {
  Bytes owned;
  std::span<const std::byte> bytes;
  std::string mediaType; ///< declared; may be empty
};

EncodedImage loadEncoded(const Document& document, const Buffers& buffers, const Json& image,
                         const std::string& pointer) {
  EncodedImage encoded;
  encoded.mediaType = stringOr(image, "mimeType", "");
  const bool hasUri = image.contains("uri");
  const std::optional<uint32_t> view = indexOf(image, "bufferView");
  if (hasUri == view.has_value()) document.fail(pointer, "either a uri or a bufferView");
  if (view) {
    encoded.bytes = buffers.view(*view);
    return encoded;
  }
  LoadedUri loaded =
      loadUri(document, image.at("uri").get<std::string>(), pointer + "/uri", document.options.maxBufferBytes);
  if (encoded.mediaType.empty()) encoded.mediaType = loaded.mediaType;
  encoded.owned = std::move(loaded.bytes);
  encoded.bytes = encoded.owned;
  return encoded;
}

void checkMediaType(const Document& document, const EncodedImage& encoded, const std::string& pointer) {
  const std::optional<ImageFormat> format = imageFormat(encoded.bytes);
  if (!format) document.fail(pointer, "a PNG, JPEG or WebP image (IMAGE_UNRECOGNIZED_FORMAT)");
  const bool declaresOther = encoded.mediaType.starts_with("image/") && encoded.mediaType != mediaType(*format);
  if (declaresOther) {
    document.fail(pointer, fmt::format("{} as declared, the bytes are {} (IMAGE_MIME_TYPE_INVALID)", encoded.mediaType,
                                       mediaType(*format)));
  }
  if (*format == ImageFormat::Webp && !webpAvailable()) {
    throw UnsupportedError(document.file, pointer, "a PNG or JPEG image, this build has no WebP");
  }
}

} // namespace

int32_t Textures::use(uint32_t index, Scene& scene) {
  const auto found = textures_.find(index);
  if (found != textures_.end()) return found->second;
  int32_t result = kNone;
  if (const std::optional<uint32_t> image = source(index)) {
    Texture texture = readSampler(arrayOrEmpty(document_.root, "textures")[index]);
    texture.image = useImage(*image, scene);
    result = static_cast<int32_t>(scene.textures.size());
    scene.textures.push_back(texture);
  } else {
    document_.warnings.add("a texture without an image that this build decodes is left out",
                           fmt::format("/textures/{}", index));
  }
  textures_.emplace(index, result);
  return result;
}

int32_t Textures::useGlossiness(uint32_t index, float glossinessFactor, Scene& scene) {
  const int32_t plain = use(index, scene);
  if (plain == kNone) return kNone;
  Texture texture = scene.textures[static_cast<size_t>(plain)];
  const ImageData& image = scene.images[texture.image];
  document_.claim(uint64_t{image.width} * image.height * 4, fmt::format("/textures/{}", index));
  ImageData roughness = roughnessFromGlossiness(image, glossinessFactor);
  texture.image = static_cast<uint32_t>(scene.images.size());
  scene.images.push_back(std::move(roughness));
  scene.textures.push_back(texture);
  return static_cast<int32_t>(scene.textures.size() - 1);
}

std::optional<uint32_t> Textures::source(uint32_t index) const {
  const Json& texture = arrayOrEmpty(document_.root, "textures")[index];
  const Json* webp = extension(texture, "EXT_texture_webp");
  if (webp && webpAvailable()) {
    if (const std::optional<uint32_t> image = indexOf(*webp, "source")) return image;
  }
  return indexOf(texture, "source");
}

Texture Textures::readSampler(const Json& texture) const {
  Texture result;
  const std::optional<uint32_t> index = indexOf(texture, "sampler");
  if (!index) return result;
  constexpr uint64_t kNearest = 9728;
  const Json& sampler = arrayOrEmpty(document_.root, "samplers")[*index];
  result.wrapS = wrapMode(integerOr(sampler, "wrapS", 0));
  result.wrapT = wrapMode(integerOr(sampler, "wrapT", 0));
  result.filter = integerOr(sampler, "magFilter", 0) == kNearest ? Filter::Nearest : Filter::Linear;
  return result;
}

uint32_t Textures::useImage(uint32_t index, Scene& scene) {
  const auto found = images_.find(index);
  if (found != images_.end()) return found->second;
  const Json& json = arrayOrEmpty(document_.root, "images")[index];
  const std::string pointer = fmt::format("/images/{}", index);
  const EncodedImage encoded = loadEncoded(document_, buffers_, json, pointer);
  checkMediaType(document_, encoded, pointer);
  ImageData image;
  image.name = stringOr(json, "name", "");
  const auto refuse = [&](const DecodeProblem& problem) {
    if (!problem.tooLarge.empty())
      throw LimitError(fmt::format("{}: {}: {}", document_.file, pointer, problem.tooLarge));
    if (!problem.broken.empty())
      document_.fail(pointer, "a readable image, " + problem.broken + " (IMAGE_DATA_INVALID)");
  };
  refuse(readImageHeader(encoded.bytes, document_.options.maxImagePixels, image));
  document_.claim(uint64_t{image.width} * image.height * 4 * image.bitsPerChannel / 8, pointer);
  refuse(decodeImage(encoded.bytes, image));
  const auto result = static_cast<uint32_t>(scene.images.size());
  scene.images.push_back(std::move(image));
  images_.emplace(index, result);
  return result;
}

} // namespace isophote::gltf
