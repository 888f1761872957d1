// Images as named float planes, and the files they go to.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace isophote {

/// One float plane, row 0 at the top, `width * height` values.
struct Channel {
  std::string name; ///< EXR name, such as "R" or "stderr.G"
  std::vector<float> values;
};

/// The same of whole numbers, which floats would round.
struct IntegerChannel {
  std::string name;
  std::vector<uint32_t> values;
};

struct Image {
  uint32_t width = 0;
  uint32_t height = 0;
  std::vector<Channel> channels;
  std::vector<IntegerChannel> integers;
  std::map<std::string, std::string> attributes; ///< string attributes, such as "isophote.seed"
  float renderSeconds = 0;                       ///< the standard renderTime attribute, where positive

  /// The plane called `name`, or null.
  [[nodiscard]] const Channel* find(const std::string& name) const;
  [[nodiscard]] const IntegerChannel* findIntegers(const std::string& name) const;
};

/// Writes float32 and uint32 planes to one part of an OpenEXR file, through a temporary name in the same folder: the
/// final name appears only when every byte is on disk.
/// @throws OutputError; an earlier file of that name is then untouched
void writeExr(const std::filesystem::path& file, const Image& image);

/// Reads the channels of the first part, those of halves as float32, with the string attributes.
/// @throws SceneError, LimitError
[[nodiscard]] Image readExr(const std::filesystem::path& file);

enum class ToneMap : uint32_t { Neutral, Agx, Aces, Srgb, Linear };

/// How display values are encoded: the curve of sRGB (IEC 61966-2-1), or the power of 1 / 2.2 that approximates it.
enum class Transfer : uint32_t { Srgb, Gamma22 };

/// Scene-linear Rec.709 to display values in [0, 1]. `color` is already exposed. Agx is encoded by its own curve,
/// Linear not at all.
[[nodiscard]] glm::vec3 toneMap(glm::vec3 color, ToneMap operation, Transfer transfer = Transfer::Srgb);

/// R, G, B (and A where present) as the bytes of a PNG file: 8-bit sRGB, tone-mapped after exposure by 2^exposureEv.
/// @throws OutputError where there are more pixels than the format's encoder takes
[[nodiscard]] std::string encodePng(const Image& image, float exposureEv, ToneMap operation,
                                    Transfer transfer = Transfer::Srgb);

/// Writes what encodePng makes, atomically like writeExr.
/// @throws OutputError
void writePng(const std::filesystem::path& file, const Image& image, float exposureEv, ToneMap operation,
              Transfer transfer = Transfer::Srgb);

/// Writes `bytes` under a temporary name in the same folder, syncs, and renames over `file`.
/// @throws OutputError
void writeFileAtomically(const std::filesystem::path& file, const std::string& bytes);

/// Fails early where `file` could not be written at the end: missing or read-only folder, a directory, a bad name.
/// @throws OutputError
void checkWritable(const std::filesystem::path& file);

} // namespace isophote
