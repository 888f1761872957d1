// Layout: the magic line, the length of the JSON head (64 bits, little endian), the head, the film's bytes, and a
// CRC-32 (ISO 3309, as zlib has it) of all before. Files are read on the kind of machine that wrote them.
#include "isophote/checkpoint.hpp"

#include <bit>
#include <cstring>
#include <fstream>
#include <string_view>

#include <nlohmann/json.hpp>
#include <zlib.h>

#include "io/atomic_file.hpp"
#include "isophote/error.hpp"
#include "render/film_head.hpp"
#include "render/whole_number.hpp"

namespace isophote {
namespace {

using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little);

constexpr std::string_view kMagic = "isophote checkpoint 1\n";

/// Writes and keeps the checksum of what was written.
class CheckedFile {
public:
  explicit CheckedFile(const std::filesystem::path& file) : file_(file) {}
  void write(const void* bytes, size_t count) {
    if (count == 0) return; // of a null pointer zlib gives the checksum of nothing
    file_.write(bytes, count);
    checksum_ = crc32_z(checksum_, static_cast<const Bytef*>(bytes), count);
  }
  void commit() {
    const auto checksum = static_cast<uint32_t>(checksum_);
    file_.write(&checksum, sizeof(checksum));
    file_.commit();
  }

private:
  io::AtomicFile file_;
  uLong checksum_ = crc32_z(0, nullptr, 0);
};

Json headOf(const Checkpoint& checkpoint) {
  return {{"identity", checkpoint.identity},
          {"left", {checkpoint.left.first, checkpoint.left.last, checkpoint.left.begun}},
          {"seconds", checkpoint.seconds},
          {"film", filmHead(checkpoint.sums)},
          {"replicate_bytes", checkpoint.sums.replicates.size()},
          {"aov_bytes", checkpoint.sums.aovs.size()},
          {"clamped_bytes", checkpoint.sums.clamped.size()},
          {"beyond_bytes", checkpoint.sums.beyond.size()}};
}

Checkpoint fromHead(const Json& head) {
  return {.identity = head.at("identity"),
          .left = {wholeNumber<uint32_t>(head.at("left").at(0)), wholeNumber<uint32_t>(head.at("left").at(1)),
                   wholeNumber<uint64_t>(head.at("left").at(2))},
          .seconds = head.at("seconds"),
          .sums = filmFromHead(head.at("film"))};
}

/// All bytes before the checksum, which has been compared.
std::string checkedBytes(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file)) throw SceneError(file.string(), "", "a readable checkpoint");
  std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (!bytes.starts_with(kMagic)) throw SceneError(file.string(), "", "a checkpoint of this version of Isophote");
  uint32_t expected = 0;
  if (bytes.size() < kMagic.size() + sizeof(uint64_t) + sizeof(expected)) {
    throw SceneError(file.string(), "", "a whole checkpoint, this one ends early");
  }
  std::memcpy(&expected, bytes.data() + bytes.size() - sizeof(expected), sizeof(expected));
  bytes.resize(bytes.size() - sizeof(expected));
  const uLong actual = crc32_z(crc32_z(0, nullptr, 0), reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  if (actual != expected) throw SceneError(file.string(), "", "a whole checkpoint, this one is cut off or damaged");
  return bytes;
}

} // namespace

void writeCheckpoint(const std::filesystem::path& file, const Checkpoint& checkpoint) {
  const std::string head = headOf(checkpoint).dump(-1, ' ', false, Json::error_handler_t::replace);
  const uint64_t length = head.size();
  CheckedFile out(file);
  out.write(kMagic.data(), kMagic.size());
  out.write(&length, sizeof(length));
  out.write(head.data(), head.size());
  out.write(checkpoint.sums.replicates.data(), checkpoint.sums.replicates.size());
  out.write(checkpoint.sums.aovs.data(), checkpoint.sums.aovs.size());
  out.write(checkpoint.sums.clamped.data(), checkpoint.sums.clamped.size());
  out.write(checkpoint.sums.beyond.data(), checkpoint.sums.beyond.size());
  out.commit();
}

Checkpoint readCheckpoint(const std::filesystem::path& file) {
  const std::string bytes = checkedBytes(file);
  const size_t start = kMagic.size() + sizeof(uint64_t);
  uint64_t length = 0;
  std::memcpy(&length, bytes.data() + kMagic.size(), sizeof(length));
  try {
    if (length > bytes.size() - start) throw std::runtime_error("the head is longer than the file");
    const Json head = Json::parse(bytes.data() + start, bytes.data() + start + length);
    Checkpoint checkpoint = fromHead(head);
    const auto* at = reinterpret_cast<const std::byte*>(bytes.data()) + start + length;
    size_t left = bytes.size() - start - length;
    const auto take = [&](const char* size, std::vector<std::byte>& to) {
      const auto count = wholeNumber<size_t>(head.at(size));
      if (count > left) throw std::runtime_error("the film is of another size");
      to.assign(at, at + count);
      at += count;
      left -= count;
    };
    take("replicate_bytes", checkpoint.sums.replicates);
    take("aov_bytes", checkpoint.sums.aovs);
    take("clamped_bytes", checkpoint.sums.clamped);
    take("beyond_bytes", checkpoint.sums.beyond);
    if (left != 0) throw std::runtime_error("the film is of another size");
    return checkpoint;
  } catch (const std::exception& error) {
    throw SceneError(file.string(), "", std::string("a checkpoint: ") + error.what());
  }
}

} // namespace isophote
