// A device with ray query for the tests of one executable.
#pragma once

#include <gtest/gtest.h>

#include "isophote/device.hpp"

namespace isophote::test {

/// Tests of Backend::RayQuery: skipped where the device has none; what the validation layer says fails them.
class RayQueryTest : public testing::Test {
protected:
  void SetUp() override;
  void TearDown() override;

  /// With ray query enabled; it traces through the project's own BVH as well.
  static const Device& device();
};

} // namespace isophote::test
