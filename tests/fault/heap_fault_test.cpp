// Every allocation of some size on the way from a file to a packed scene, and from an image to a file, fails once (bad
// input 34).
#include <functional>
#include <new>

#include <gtest/gtest.h>

#include "fault/heap_faults.hpp"
#include "isophote/error.hpp"
#include "isophote/image.hpp"
#include "support/paths.hpp"
#include "unit/gltf_asset.hpp"
#include "upload/pack_scene.hpp"

namespace isophote {
namespace {

struct Outcome {
  uint64_t allocations = 0;
  uint64_t tried = 0;
  uint64_t refused = 0; ///< as memory that lacks; the others went on, as sorting does without its buffer
};

/// Anything else that is thrown escapes.
/// @param step between the allocations that fail
Outcome failEach(const std::function<void()>& work, uint64_t step = 1) {
  fault::armHeap(0);
  work();
  Outcome outcome{.allocations = fault::heapAllocations()};
  for (uint64_t nth = 1; nth <= outcome.allocations; nth += step) {
    ++outcome.tried;
    fault::armHeap(nth);
    try {
      work();
    } catch (const std::bad_alloc&) {
      ++outcome.refused;
    } catch (const LimitError&) {
      ++outcome.refused;
    }
    fault::armHeap(0);
  }
  return outcome;
}

TEST(HeapFault, LoadingAndPackingASceneEndWithOneError) {
  const std::filesystem::path file = std::filesystem::path(ISOPHOTE_SOURCE_DIR) / "assets" / "material-grid.glb";
  const Outcome outcome = failEach([&] { (void)packScene(loadGltf(file)); }, 17);
  EXPECT_GT(outcome.allocations, 100u);
  EXPECT_GT(outcome.refused, outcome.tried / 2);
}

TEST(HeapFault, WritingAnImageLeavesTheEarlierFile) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "image.exr";
  Image image{.width = 64, .height = 64, .channels = {{"R", std::vector<float>(4096, 1)}}};
  writeExr(file, image);
  EXPECT_GT(failEach([&] { writeExr(file, image); }).refused, 0u);
  EXPECT_EQ(readExr(file).find("R")->values, image.channels[0].values);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1) << "a temporary file stayed";
}

} // namespace
} // namespace isophote
