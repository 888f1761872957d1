#include "isophote/film.hpp"

#include <cmath>
#include <string>

#include <fmt/format.h>

#include "isophote/error.hpp"
#include "isophote_kernels.hpp"
#include "render/film_impl.hpp"

namespace isophote {
namespace {

constexpr uint32_t kFilmWorkgroup = 64;

PixelRect fullOr(const PixelRect& crop, uint32_t width, uint32_t height) {
  if (crop.x1 == 0 && crop.y1 == 0) return {0, 0, width, height};
  if (crop.x0 >= crop.x1 || crop.y0 >= crop.y1 || crop.x1 > width || crop.y1 > height) {
    throw UsageError(fmt::format("crop {},{},{},{} does not lie within the image of {} x {} pixels", crop.x0, crop.y0,
                                 crop.x1, crop.y1, width, height));
  }
  return crop;
}

} // namespace

Film::Film(const Device& device, const FilmOptions& options) : impl_(std::make_unique<Impl>()) {
  if (options.width < 1 || options.height < 1 || options.width > 65535 || options.height > 65535) {
    throw LimitError(
        fmt::format("image of {} x {} pixels: each side must be between 1 and 65535", options.width, options.height));
  }
  impl_->device = &device;
  impl_->options = options;
  impl_->options.crop = fullOr(options.crop, options.width, options.height);
  impl_->cropWidth = impl_->options.crop.x1 - impl_->options.crop.x0;
  impl_->cropHeight = impl_->options.crop.y1 - impl_->options.crop.y0;
  const uint64_t pixels = uint64_t{impl_->cropWidth} * impl_->cropHeight;
  if (pixels > (1ull << 28)) {
    throw LimitError(fmt::format("image of {} pixels: at most {} fit", pixels, 1ull << 28));
  }
  impl_->replicates = gpu::Buffer(device, pixels * gpu::kReplicateCount * sizeof(gpu::ReplicateSum),
                                  gpu::Memory::Device, "film.replicates");
  if (options.aovs) {
    impl_->aovs = gpu::Buffer(device, pixels * sizeof(gpu::AovSum), gpu::Memory::Device, "film.aovs");
  }
  const uint64_t removedBytes = pixels * sizeof(gpu::RemovedSum);
  if (options.clampLedger) impl_->clamped = gpu::Buffer(device, removedBytes, gpu::Memory::Device, "film.clamped");
  if (options.depthLedger) impl_->beyond = gpu::Buffer(device, removedBytes, gpu::Memory::Device, "film.beyond");
  impl_->commands.emplace(device, 1, "film");
  clear();
}

Film::Film(Film&&) noexcept = default;
Film& Film::operator=(Film&&) noexcept = default;
Film::~Film() = default;

const FilmOptions& Film::options() const { return impl_->options; }

uint64_t Film::bytes() const {
  return impl_->replicates.bytes() + impl_->aovs.bytes() + impl_->clamped.bytes() + impl_->beyond.bytes();
}

void Film::clear() {
  impl_->commands->begin();
  impl_->commands->fill(impl_->replicates, 0);
  if (impl_->aovs.bytes() != 0) impl_->commands->fill(impl_->aovs, 0);
  if (impl_->clamped.bytes() != 0) impl_->commands->fill(impl_->clamped, 0);
  if (impl_->beyond.bytes() != 0) impl_->commands->fill(impl_->beyond, 0);
  impl_->commands->submitAndWait();
  impl_->scale.reset();
}

namespace {

std::vector<std::byte> readAll(const Device& device, const gpu::Buffer& buffer) {
  std::vector<std::byte> bytes(buffer.bytes());
  if (!bytes.empty()) gpu::readBuffer(device, buffer, 0, bytes);
  return bytes;
}

} // namespace

FilmSums Film::sums() const {
  FilmSums sums{.options = impl_->options};
  if (impl_->scale) {
    sums.radiancePerUnit = impl_->scale->radiancePerUnit;
    sums.lengthPerUnit = impl_->scale->lengthPerUnit;
    sums.worldOrigin = impl_->scale->worldOrigin;
  }
  sums.replicates = readAll(*impl_->device, impl_->replicates);
  sums.aovs = readAll(*impl_->device, impl_->aovs);
  sums.clamped = readAll(*impl_->device, impl_->clamped);
  sums.beyond = readAll(*impl_->device, impl_->beyond);
  return sums;
}

void Film::restore(const FilmSums& sums) {
  const FilmOptions& own = impl_->options;
  if (sums.options.width != own.width || sums.options.height != own.height || !(sums.options.crop == own.crop) ||
      sums.replicates.size() != impl_->replicates.bytes() || sums.aovs.size() != impl_->aovs.bytes() ||
      sums.clamped.size() != impl_->clamped.bytes() || sums.beyond.size() != impl_->beyond.bytes()) {
    throw UsageError("the samples are of an image of another size, crop or set of layers");
  }
  gpu::writeBuffer(*impl_->device, impl_->replicates, 0, sums.replicates);
  if (!sums.aovs.empty()) gpu::writeBuffer(*impl_->device, impl_->aovs, 0, sums.aovs);
  if (!sums.clamped.empty()) gpu::writeBuffer(*impl_->device, impl_->clamped, 0, sums.clamped);
  if (!sums.beyond.empty()) gpu::writeBuffer(*impl_->device, impl_->beyond, 0, sums.beyond);
  impl_->scale.reset();
  if (sums.radiancePerUnit > 0) impl_->scale = {sums.radiancePerUnit, sums.lengthPerUnit, sums.worldOrigin};
}

gpu::FilmArgs Film::Impl::arguments(uint64_t target) const {
  return {.replicates = replicates.address(),
          .target = target,
          .pixelCount = pixelCount(),
          .valueScale = scale ? static_cast<float>(scale->radiancePerUnit) : 0.0f,
          .epsilonSquare = 0.0f,
          .exposure = 1.0f,
          .toneMap = 0};
}

void Film::Impl::run(gpu::Kernel& kernel, const char* name, const gpu::FilmArgs& args, uint32_t invocations) const {
  if (kernel.pipeline() == VK_NULL_HANDLE) {
    const gpu::SpecConstant workgroup{0, kFilmWorkgroup};
    kernel = gpu::Kernel(*device, isophote_kernels::kernelSource(name), {&workgroup, 1}, VK_NULL_HANDLE, sizeof(args));
  }
  commands->begin();
  commands->dispatch(kernel, &args, sizeof(args), VK_NULL_HANDLE, (invocations + kFilmWorkgroup - 1) / kFilmWorkgroup);
  commands->submitAndWait();
}

void Film::display(uint64_t address, float exposureEv, ToneMap operation) const {
  gpu::FilmArgs args = impl_->arguments(address);
  args.exposure = std::exp2(exposureEv);
  args.toneMap = static_cast<uint32_t>(operation);
  impl_->run(impl_->displayKernel, "film_display", args, impl_->pixelCount());
}

} // namespace isophote
