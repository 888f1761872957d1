// The main function of every test executable.
#include <gtest/gtest.h>

#include "support/gpu_device.hpp"

namespace {

/// Makes silence of the validation layer part of every test.
class ValidationListener : public testing::EmptyTestEventListener {
  void OnTestEnd(const testing::TestInfo&) override {
    for (const auto& message : isophote::test::takeValidationMessages()) ADD_FAILURE() << message;
  }
};

/// Destroys the shared device while the loader and the layer still work, not among the static destructors; what the
/// layer says about leaked objects fails the run.
class SharedGpuEnvironment : public testing::Environment {
  void TearDown() override {
    for (const auto& message : isophote::test::destroySharedGpu()) ADD_FAILURE() << message;
  }
};

} // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  testing::UnitTest::GetInstance()->listeners().Append(new ValidationListener);
  testing::AddGlobalTestEnvironment(new SharedGpuEnvironment);
  return RUN_ALL_TESTS();
}
