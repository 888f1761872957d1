#include "isophote/ray_bench.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <limits>

#include "io/atomic_file.hpp"
#include "isophote/error.hpp"
#include "render/ray_batch.hpp"
#include "scene/file_bytes.hpp"

namespace isophote {
namespace {

struct Header {
  char magic[8] = {'I', 's', 'o', 'R', 'a', 'y', 's', '1'};
  uint32_t question = 0;
  uint32_t reserved = 0;
  uint64_t count = 0;
};
static_assert(sizeof(Header) == 24 && sizeof(Ray) == 32);

constexpr size_t kFewestRepetitions = 3;

} // namespace

RayList readRays(const std::filesystem::path& path) {
  const auto expect = [&](bool holds) {
    if (!holds) throw SceneError(path.string(), "", "not a file of rays, or cut short");
  };
  const Bytes bytes = readFileBytes(path, uint64_t{1} << 36, path.string(), "");
  Header header;
  expect(bytes.size() >= sizeof(header));
  std::memcpy(&header, bytes.data(), sizeof(header));
  expect(std::memcmp(header.magic, Header{}.magic, sizeof(header.magic)) == 0 && header.question <= 1);
  expect(header.count <= std::numeric_limits<uint32_t>::max() &&
         bytes.size() == sizeof(header) + header.count * sizeof(Ray));
  RayList list{static_cast<RayQuestion>(header.question), std::vector<Ray>(header.count)};
  if (!list.rays.empty()) std::memcpy(list.rays.data(), bytes.data() + sizeof(header), header.count * sizeof(Ray));
  return list;
}

void writeRays(const std::filesystem::path& path, const RayList& list) {
  Header header;
  header.question = static_cast<uint32_t>(list.question);
  header.count = list.rays.size();
  io::AtomicFile file(path);
  file.write(&header, sizeof(header));
  file.write(list.rays.data(), list.rays.size() * sizeof(Ray));
  file.commit();
}

RayTimes timeRays(const Device& device, const GpuScene& scene, const RayList& list, double seconds) {
  RayBatch batch(device, scene, list);
  RayTimes times;
  const auto traceOnce = [&] {
    batch.reset();
    const auto start = std::chrono::steady_clock::now();
    batch.trace();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  traceOnce();
  double elapsed = 0;
  while (times.seconds.size() < kFewestRepetitions || elapsed < seconds) {
    times.seconds.push_back(traceOnce());
    elapsed += times.seconds.back();
    if (list.rays.empty()) break;
  }
  const std::vector<bool> met = batch.met();
  times.hits = static_cast<uint64_t>(std::count(met.begin(), met.end(), true));
  return times;
}

} // namespace isophote
