// The entry points of libFuzzer, for the target named in ISOPHOTE_FUZZ_TARGET. scripts/fuzz runs it.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <string>

#include "fuzz/fuzz_target.hpp"
#include "fuzz/gltf_mutator.hpp"

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t capacity);

namespace {

const isophote::fuzz::FuzzTarget& target() {
  static const isophote::fuzz::FuzzTarget& chosen = [&]() -> const isophote::fuzz::FuzzTarget& {
    const char* name = std::getenv("ISOPHOTE_FUZZ_TARGET");
    for (const auto& candidate : isophote::fuzz::fuzzTargets()) {
      if (name != nullptr && std::strcmp(name, candidate.name) == 0) return candidate;
    }
    std::fputs("ISOPHOTE_FUZZ_TARGET names no target\n", stderr);
    std::exit(2);
  }();
  return chosen;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const isophote::test::TemporaryFolder folder;
  (void)isophote::fuzz::accepts(target(), folder, std::string(reinterpret_cast<const char*>(data), size));
  return 0;
}

// Half of a scene's mutations keep it a glTF file; bytes alone would hardly get past its JSON.
extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t capacity, unsigned int seed) {
  if (std::strcmp(target().name, "scene") != 0 || seed % 2 == 0) return LLVMFuzzerMutate(data, size, capacity);
  std::mt19937 random(seed);
  const std::string mutated =
      isophote::fuzz::mutateGltf(std::string(reinterpret_cast<const char*>(data), size), random);
  if (mutated.size() > capacity || mutated.empty()) return LLVMFuzzerMutate(data, size, capacity);
  std::copy(mutated.begin(), mutated.end(), data);
  return mutated.size();
}
