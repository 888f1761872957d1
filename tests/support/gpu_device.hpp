// The Vulkan device that all tests of one executable share.
#pragma once

#include <string>
#include <vector>

#include "isophote/device.hpp"

namespace isophote::test {

/// Made on first use with core and synchronization validation on; the fastest device of the machine, a software one
/// included; ISOPHOTE_TEST_DEVICE selects another. Where there is no device or no validation layer the test fails:
/// nothing is skipped. After each test, any message of the layer that was not taken fails it (support/test_main.cpp).
[[nodiscard]] const Device& gpuDevice();

/// Messages of the shared instance since the last call, oldest first; none where no test has used the device yet.
[[nodiscard]] std::vector<std::string> takeValidationMessages();

/// Ends the shared device and returns what the layer said meanwhile, such as objects that were never destroyed.
[[nodiscard]] std::vector<std::string> destroySharedGpu();

} // namespace isophote::test
