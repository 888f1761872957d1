#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <set>

#include "shared/camera_types.h"
#include "shared/film_types.h"
#include "shared/geometry_types.h"
#include "shared/light_types.h"
#include "shared/material_types.h"
#include "shared/path_types.h"
#include "shared/scene_view.h"

#include "layout/spirv_layout.hpp"
#include "support/paths.hpp"
#include "test_layout_kernels.hpp"

using namespace isophote;

namespace {

struct HostStruct {
  std::string name;
  size_t bytes = 0;
  std::vector<test::MemberLayout> members;
};

// LISTED(f, S, a, b, ...) is f(S, a) f(S, b) ...: C++20's __VA_OPT__ recursion (David Mazieres, 2021, "Recursive macros
// with C++20 __VA_OPT__"). Each EXPAND level doubles the scans: 2^7 members at most.
#define EXPAND(...) EXPAND6(EXPAND6(__VA_ARGS__))
#define EXPAND6(...) EXPAND5(EXPAND5(__VA_ARGS__))
#define EXPAND5(...) EXPAND4(EXPAND4(__VA_ARGS__))
#define EXPAND4(...) EXPAND3(EXPAND3(__VA_ARGS__))
#define EXPAND3(...) EXPAND2(EXPAND2(__VA_ARGS__))
#define EXPAND2(...) EXPAND1(EXPAND1(__VA_ARGS__))
#define EXPAND1(...) __VA_ARGS__
#define PARENTHESES ()
#define LISTED(macro, type, ...) __VA_OPT__(EXPAND(LISTED_STEP(macro, type, __VA_ARGS__)))
#define LISTED_STEP(macro, type, first, ...)                                                                           \
  macro(type, first) __VA_OPT__(LISTED_AGAIN PARENTHESES(macro, type, __VA_ARGS__))
#define LISTED_AGAIN() LISTED_STEP

#define HOST_MEMBER(type, member) {#member, static_cast<uint32_t>(offsetof(gpu::type, member))},
#define UNPACK(...) __VA_ARGS__
#define HOST_MEMBERS(type, ...) LISTED(HOST_MEMBER, type, __VA_ARGS__)
#define SHARED_STRUCT(Name, members) {#Name, sizeof(gpu::Name), {HOST_MEMBERS(Name, UNPACK members)}},
const std::vector<HostStruct> kHostStructs = {
#include "layout/layout_structs.inc"
};

std::multimap<std::string, test::StructLayout> deviceStructs() {
  return test::readStructLayouts(test_layout_kernels::kernelSource("layout_probe").spirv);
}

/// Names after `struct` at the start of a line in shaders/shared/*.h.
std::set<std::string> declaredStructs() {
  std::set<std::string> names;
  const auto folder = std::filesystem::path(ISOPHOTE_SOURCE_DIR) / "shaders" / "shared";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".h") continue;
    std::ifstream file(entry.path());
    const std::string keyword = "struct ";
    for (std::string line; std::getline(file, line);) {
      if (!line.starts_with(keyword)) continue;
      const auto end =
          line.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_", keyword.size());
      names.insert(line.substr(keyword.size(), end - keyword.size()));
    }
  }
  return names;
}

} // namespace

TEST(Layout, EveryMemberLiesAtTheSameOffsetOnHostAndDevice) {
  const auto device = deviceStructs();
  for (const HostStruct& host : kHostStructs) {
    ASSERT_TRUE(device.contains(host.name)) << host.name << " is not in layout_probe.comp's SPIR-V";
    const auto [first, last] = device.equal_range(host.name);
    for (auto found = first; found != last; ++found) {
      const auto& members = found->second.members;
      ASSERT_EQ(host.members.size(), members.size()) << host.name << ": members in layout_structs.inc and in GLSL";
      for (size_t i = 0; i < members.size(); ++i) {
        EXPECT_EQ(host.members[i].name, members[i].name) << host.name << ", member " << i;
        EXPECT_EQ(host.members[i].offset, members[i].offset) << host.name << "::" << members[i].name;
      }
    }
  }
}

TEST(Layout, ArraysHaveTheSameStrideOnHostAndDevice) {
  const auto device = deviceStructs();
  for (const HostStruct& host : kHostStructs) {
    uint32_t stride = 0;
    const auto [first, last] = device.equal_range(host.name);
    for (auto found = first; found != last; ++found) stride = std::max(stride, found->second.arrayStride);
    EXPECT_EQ(host.bytes, stride) << "sizeof " << host.name;
  }
}

TEST(Layout, EverySharedStructIsListed) {
  std::set<std::string> listed;
  for (const HostStruct& host : kHostStructs) listed.insert(host.name);
  for (const std::string& name : declaredStructs()) {
    EXPECT_TRUE(listed.contains(name)) << "add struct " << name << " to tests/layout/layout_structs.inc";
  }
}
