// Recording, submitting, timing.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gpu/buffer.hpp"
#include "gpu/kernel.hpp"
#include "isophote/device.hpp"

namespace isophote::gpu {

/// Total device time of one kernel since construction.
struct KernelTime {
  std::string name;
  uint64_t dispatches = 0;
  double milliseconds = 0;
  double longestMilliseconds = 0;
};

/// One reusable command buffer with its fence and a timestamp pair per dispatch. Use: begin, dispatch...,
/// submitAndWait. Every dispatch is wrapped in a debug-utils region and is followed by a full compute ->
/// compute/indirect/transfer memory barrier: stages run one after another. Move-only.
class CommandStream {
public:
  /// @param maxDispatches  most dispatches between begin and submit (sizes the query pool)
  CommandStream(const Device& device, uint32_t maxDispatches, const char* name);
  CommandStream(CommandStream&&) noexcept;
  CommandStream& operator=(CommandStream&&) noexcept;
  ~CommandStream();

  void begin();
  /// @param textures  bound as set 0 where the kernel uses textures; may be null otherwise
  void dispatch(const Kernel& kernel, const void* push, uint32_t pushBytes, VkDescriptorSet textures, uint32_t groupsX);
  /// Group counts come from a VkDispatchIndirectCommand in `arguments` at `offset`.
  void dispatchIndirect(const Kernel& kernel, const void* push, uint32_t pushBytes, VkDescriptorSet textures,
                        const Buffer& arguments, uint64_t offset);
  void fill(const Buffer& buffer, uint32_t value);
  /// Copies all of `source` over the start of `destination`.
  void copy(const Buffer& source, const Buffer& destination);
  [[nodiscard]] VkCommandBuffer handle() const; ///< for what the viewer records itself
  /// Submits, waits with a timeout, adds the timestamps to times().
  /// @throws DeviceError on device loss or after `timeoutSeconds`
  void submitAndWait(double timeoutSeconds = 600);
  [[nodiscard]] const std::vector<KernelTime>& times() const;
  /// Longest dispatch and whole length of the last submit, milliseconds.
  [[nodiscard]] double lastLongestDispatchMilliseconds() const;
  [[nodiscard]] double lastSubmitMilliseconds() const;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace isophote::gpu
