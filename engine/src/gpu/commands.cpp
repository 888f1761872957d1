#include "gpu/commands.hpp"

#include "isophote/error.hpp"

#include "gpu/barrier.hpp"
#include "gpu/device_impl.hpp"
#include "gpu/vulkan_check.hpp"

#include <algorithm>

namespace isophote::gpu {

struct CommandStream::Impl {
  explicit Impl(Device::Impl& owner) : device(owner) {}
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl();

  void create(uint32_t dispatches, const char* name);
  void record(const Kernel& kernel, const void* push, uint32_t pushBytes, VkDescriptorSet textures);
  void finishDispatch();
  void readTimes();

  Device::Impl& device;
  VkCommandPool pool = VK_NULL_HANDLE;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  VkFence fence = VK_NULL_HANDLE;
  VkQueryPool queries = VK_NULL_HANDLE; // 2 i and 2 i + 1: start and end of dispatch i
  uint32_t maxDispatches = 0;
  uint64_t timestampMask = 0;
  std::vector<size_t> recorded; // index into times, by dispatch
  std::vector<KernelTime> times;
  double longestMilliseconds = 0;
  double submitMilliseconds = 0;
};

CommandStream::Impl::~Impl() {
  if (queries) vkDestroyQueryPool(device.handle, queries, nullptr);
  if (fence) vkDestroyFence(device.handle, fence, nullptr);
  if (pool) vkDestroyCommandPool(device.handle, pool, nullptr);
}

void CommandStream::Impl::create(uint32_t dispatches, const char* name) {
  maxDispatches = dispatches;
  const VkCommandPoolCreateInfo poolInfo{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                         .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
                                         .queueFamilyIndex = device.queueFamily};
  check(vkCreateCommandPool(device.handle, &poolInfo, nullptr, &pool), "vkCreateCommandPool");
  const VkCommandBufferAllocateInfo bufferInfo{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                               .commandPool = pool,
                                               .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                               .commandBufferCount = 1};
  check(vkAllocateCommandBuffers(device.handle, &bufferInfo, &commands), "vkAllocateCommandBuffers");
  device.name(commands, VK_OBJECT_TYPE_COMMAND_BUFFER, name);
  const VkFenceCreateInfo fenceInfo{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  check(vkCreateFence(device.handle, &fenceInfo, nullptr, &fence), "vkCreateFence");
  device.name(fence, VK_OBJECT_TYPE_FENCE, name);
  const VkQueryPoolCreateInfo queryInfo{.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                        .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                        .queryCount = std::max(2u * dispatches, 2u)};
  check(vkCreateQueryPool(device.handle, &queryInfo, nullptr, &queries), "vkCreateQueryPool");
  device.name(queries, VK_OBJECT_TYPE_QUERY_POOL, name);

  uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(device.physical, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(device.physical, &count, families.data());
  const uint32_t bits = families[device.queueFamily].timestampValidBits;
  timestampMask = bits >= 64 ? ~0ull : (1ull << bits) - 1;
}

void CommandStream::Impl::record(const Kernel& kernel, const void* push, uint32_t pushBytes, VkDescriptorSet textures) {
  const std::string what = "dispatch of " + kernel.name() + ": ";
  if (recorded.size() >= maxDispatches) throw Error(what + "more than the stream's " + std::to_string(maxDispatches));
  if (pushBytes != kernel.pushBytes()) throw Error(what + "push constants of another size than the kernel's");
  if (kernel.usesTextures() && !textures) throw Error(what + "no textures were given");

  auto time = std::find_if(times.begin(), times.end(), [&](const KernelTime& t) { return t.name == kernel.name(); });
  if (time == times.end()) time = times.insert(times.end(), KernelTime{.name = kernel.name()});
  const uint32_t query = static_cast<uint32_t>(2 * recorded.size());
  recorded.push_back(static_cast<size_t>(time - times.begin()));

  if (device.beginLabel) {
    const VkDebugUtilsLabelEXT label{.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT,
                                     .pLabelName = kernel.name().c_str()};
    device.beginLabel(commands, &label);
  }
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.pipeline());
  if (kernel.usesTextures()) {
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.layout(), 0, 1, &textures, 0, nullptr);
  }
  if (pushBytes > 0) {
    vkCmdPushConstants(commands, kernel.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0, pushBytes, push);
  }
  // The barrier after each dispatch makes the previous one end before this timestamp.
  vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, queries, query);
}

void CommandStream::Impl::finishDispatch() {
  const uint32_t query = static_cast<uint32_t>(2 * recorded.size() - 1);
  vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, queries, query);
  recordFullBarrier(commands);
  if (device.endLabel) device.endLabel(commands);
}

void CommandStream::Impl::readTimes() {
  longestMilliseconds = 0;
  submitMilliseconds = 0;
  if (recorded.empty()) return;
  std::vector<uint64_t> ticks(2 * recorded.size());
  check(vkGetQueryPoolResults(device.handle, queries, 0, static_cast<uint32_t>(ticks.size()),
                              ticks.size() * sizeof(uint64_t), ticks.data(), sizeof(uint64_t), VK_QUERY_RESULT_64_BIT),
        "vkGetQueryPoolResults");
  const auto milliseconds = [&](size_t first, size_t last) {
    const uint64_t elapsed = (ticks[last] - ticks[first]) & timestampMask; // the counter may wrap
    return static_cast<double>(elapsed) * static_cast<double>(device.limits.timestampPeriod) * 1e-6;
  };
  for (size_t i = 0; i < recorded.size(); ++i) {
    const double length = milliseconds(2 * i, 2 * i + 1);
    KernelTime& time = times[recorded[i]];
    ++time.dispatches;
    time.milliseconds += length;
    time.longestMilliseconds = std::max(time.longestMilliseconds, length);
    longestMilliseconds = std::max(longestMilliseconds, length);
  }
  submitMilliseconds = milliseconds(0, ticks.size() - 1);
}

CommandStream::CommandStream(const Device& device, uint32_t maxDispatches, const char* name)
    : impl_(std::make_unique<Impl>(device.impl())) {
  impl_->create(maxDispatches, name);
}

CommandStream::CommandStream(CommandStream&&) noexcept = default;
CommandStream& CommandStream::operator=(CommandStream&&) noexcept = default;
CommandStream::~CommandStream() = default;

void CommandStream::begin() {
  impl_->recorded.clear();
  check(vkResetCommandPool(impl_->device.handle, impl_->pool, 0), "vkResetCommandPool");
  vkResetQueryPool(impl_->device.handle, impl_->queries, 0, std::max(2u * impl_->maxDispatches, 2u));
  const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                       .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
  check(vkBeginCommandBuffer(impl_->commands, &begin), "vkBeginCommandBuffer");
}

void CommandStream::dispatch(const Kernel& kernel, const void* push, uint32_t pushBytes, VkDescriptorSet textures,
                             uint32_t groupsX) {
  const uint32_t limit = impl_->device.limits.maxComputeWorkGroupCount[0];
  if (groupsX > limit) {
    throw LimitError("dispatch of " + kernel.name() + " needs " + std::to_string(groupsX) + " workgroups; " +
                     impl_->device.info.name + " runs at most " + std::to_string(limit));
  }
  impl_->record(kernel, push, pushBytes, textures);
  vkCmdDispatch(impl_->commands, groupsX, 1, 1);
  impl_->finishDispatch();
}

void CommandStream::dispatchIndirect(const Kernel& kernel, const void* push, uint32_t pushBytes,
                                     VkDescriptorSet textures, const Buffer& arguments, uint64_t offset) {
  if (offset + sizeof(VkDispatchIndirectCommand) > arguments.bytes()) {
    throw Error("dispatch of " + kernel.name() + ": indirect arguments outside " + arguments.name());
  }
  impl_->record(kernel, push, pushBytes, textures);
  vkCmdDispatchIndirect(impl_->commands, arguments.handle(), offset);
  impl_->finishDispatch();
}

void CommandStream::fill(const Buffer& buffer, uint32_t value) {
  if (buffer.bytes() == 0) return;
  vkCmdFillBuffer(impl_->commands, buffer.handle(), 0, VK_WHOLE_SIZE, value);
  recordFullBarrier(impl_->commands);
}

void CommandStream::copy(const Buffer& source, const Buffer& destination) {
  const VkBufferCopy region{.size = source.bytes()};
  vkCmdCopyBuffer(impl_->commands, source.handle(), destination.handle(), 1, &region);
  recordFullBarrier(impl_->commands);
}

VkCommandBuffer CommandStream::handle() const { return impl_->commands; }

void CommandStream::submitAndWait(double timeoutSeconds) {
  recordFullBarrier(impl_->commands);
  check(vkEndCommandBuffer(impl_->commands), "vkEndCommandBuffer");
  impl_->device.submitAndWait(impl_->commands, impl_->fence, timeoutSeconds);
  impl_->readTimes();
}

const std::vector<KernelTime>& CommandStream::times() const { return impl_->times; }
double CommandStream::lastLongestDispatchMilliseconds() const { return impl_->longestMilliseconds; }
double CommandStream::lastSubmitMilliseconds() const { return impl_->submitMilliseconds; }

} // namespace isophote::gpu
