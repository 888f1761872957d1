// The only file that knows OpenEXR.
#include <algorithm>
#include <cstdint>
#include <exception>
#include <fstream>
#include <new>
#include <optional>
#include <set>
#include <thread>

#include <ImfChannelList.h>
#include <ImfCompression.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>
#include <ImfVersion.h>
#include <ImfXdr.h>

#include "io/atomic_file.hpp"
#include "io/exr_attributes.hpp"
#include "isophote/error.hpp"
#include "isophote/image.hpp"

namespace isophote {
namespace {

/// The most pixels read; the width and height in a header are the file's word, so they are checked before allocation.
constexpr uint64_t kMaxPixels = 1ull << 28;
/// The most floats read over all channels: 16 GiB.
constexpr uint64_t kMaxValues = 1ull << 32;
/// No compression of the format makes less of a plane than this part: zlib's best is 1 / 1032, PIZ's runs are coded in
/// some 1 / 2000. Headers that claim more are wrong, and would cost memory and time before that shows.
constexpr uint64_t kMaxCompression = 8192;

constexpr const char* kRenderTime = "renderTime";

class AtomicStream : public Imf::OStream {
public:
  explicit AtomicStream(io::AtomicFile& file, const std::string& name) : Imf::OStream(name.c_str()), file_(file) {}
  void write(const char bytes[], int count) override { file_.write(bytes, static_cast<size_t>(count)); }
  uint64_t tellp() override { return file_.position(); }
  void seekp(uint64_t position) override { file_.seek(position); }

private:
  io::AtomicFile& file_;
};

class FileStream : public Imf::IStream {
public:
  explicit FileStream(const std::filesystem::path& file)
      : Imf::IStream(file.c_str()), stream_(file, std::ios::binary) {}
  [[nodiscard]] bool isOpen() const { return stream_.is_open(); }
  bool read(char bytes[], int count) override {
    stream_.read(bytes, count);
    if (stream_.gcount() < count) throw std::runtime_error("the file ends early");
    return stream_.peek() != std::ifstream::traits_type::eof();
  }
  uint64_t tellg() override { return static_cast<uint64_t>(static_cast<std::streamoff>(stream_.tellg())); }
  void seekg(uint64_t position) override {
    stream_.clear();
    stream_.seekg(static_cast<std::streamoff>(position));
  }
  void clear() override { stream_.clear(); }

private:
  std::ifstream stream_;
};

/// OpenEXR compresses on a process-wide pool that starts empty; give it this machine's cores once.
int compressionThreads() {
  if (Imf::globalThreadCount() == 0) {
    Imf::setGlobalThreadCount(static_cast<int>(std::max(1u, std::thread::hardware_concurrency())));
  }
  return Imf::globalThreadCount();
}

Imf::Header makeHeader(const Image& image) {
  Imf::Header header(static_cast<int>(image.width), static_cast<int>(image.height));
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::addChromaticities(header, Imf::Chromaticities()); // the default is Rec. ITU-R BT.709-3 with D65
  Imf::addWhiteLuminance(header, 1.0f);                  // radiance units are the scene's own
  if (image.renderSeconds > 0) header.insert(kRenderTime, Imf::FloatAttribute(image.renderSeconds));
  for (const auto& [name, text] : image.attributes) header.insert(name, Imf::StringAttribute(text));
  for (const Channel& channel : image.channels) header.channels().insert(channel.name, Imf::Channel(Imf::FLOAT));
  for (const IntegerChannel& channel : image.integers) {
    header.channels().insert(channel.name, Imf::Channel(Imf::UINT));
  }
  return header;
}

void checkPlanes(const Image& image) {
  const uint64_t pixels = uint64_t(image.width) * image.height;
  constexpr uint32_t kLargest = 0x7fffffff;
  if (pixels == 0 || image.width > kLargest || image.height > kLargest) throw UsageError("an image without pixels");
  if (image.channels.empty()) throw UsageError("an image without channels");
  std::set<std::string> names;
  const auto check = [&](const auto& channel) {
    if (channel.values.size() != pixels)
      throw UsageError("channel " + channel.name + " does not have one value a pixel");
    if (!names.insert(channel.name).second) throw UsageError("two channels called " + channel.name);
  };
  for (const Channel& channel : image.channels) check(channel);
  for (const IntegerChannel& channel : image.integers) check(channel);
}

/// Rows that are compressed together, and for which a buffer is made even where there are fewer.
uint64_t rowsPerChunk(Imf::Compression compression) {
  switch (compression) {
  case Imf::ZIP_COMPRESSION:
  case Imf::PXR24_COMPRESSION:
    return 16;
  case Imf::PIZ_COMPRESSION:
  case Imf::B44_COMPRESSION:
  case Imf::B44A_COMPRESSION:
  case Imf::DWAA_COMPRESSION:
    return 32;
  case Imf::DWAB_COMPRESSION:
    return 256;
  default:
    return 1;
  }
}

/// @throws SceneError, UnsupportedError, LimitError before any pixel memory exists
void checkHeader(const std::string& file, uint64_t fileBytes, const Imf::Header& header) {
  const Imath::Box2i window = header.dataWindow();
  const int64_t width = int64_t(window.max.x) - window.min.x + 1;
  const int64_t height = int64_t(window.max.y) - window.min.y + 1;
  if (width <= 0 || height <= 0) throw SceneError(file, "", "an OpenEXR image with pixels");
  const uint64_t pixels = static_cast<uint64_t>(width) * static_cast<uint64_t>(height); // both below 2^32
  uint64_t channels = 0;
  for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
    ++channels;
    if (channel.channel().xSampling != 1 || channel.channel().ySampling != 1) {
      throw UnsupportedError(file, "", std::string("channel ") + channel.name() + " is subsampled");
    }
  }
  if (channels == 0) throw SceneError(file, "", "an OpenEXR image with channels");
  if (pixels > kMaxPixels || pixels * channels > kMaxValues) {
    throw LimitError(file + ": " + std::to_string(width) + " x " + std::to_string(height) + " pixels in " +
                     std::to_string(channels) + " channels exceed the limit of " + std::to_string(kMaxPixels) +
                     " pixels and " + std::to_string(kMaxValues) + " values");
  }
  const uint64_t rows = std::max(static_cast<uint64_t>(height), rowsPerChunk(header.compression()));
  if (static_cast<uint64_t>(width) * rows * channels / kMaxCompression > fileBytes) {
    throw SceneError(file, "",
                     "an OpenEXR image whose " + std::to_string(fileBytes) + " bytes can hold the " +
                         std::to_string(width) + " x " + std::to_string(height) + " pixels of its header");
  }
}

/// The first header of the file, read by itself: InputFile would allocate for its size at once.
Imf::Header readFirstHeader(const std::filesystem::path& file, FileStream& stream) {
  int magic = 0;
  int version = 0;
  Imf::Xdr::read<Imf::StreamIO>(stream, magic);
  Imf::Xdr::read<Imf::StreamIO>(stream, version);
  if (magic != Imf::MAGIC) throw std::runtime_error("not an OpenEXR file");
  if (Imf::getVersion(version) != Imf::EXR_VERSION || !Imf::supportsFlags(Imf::getFlags(version))) {
    throw std::runtime_error("an OpenEXR version that cannot be read");
  }
  io::checkExrAttributes(file, Imf::isMultiPart(version));
  Imf::Header header;
  header.readFrom(stream, version);
  return header;
}

Image readPlanes(Imf::InputFile& input) {
  const Imf::Header& header = input.header();
  const Imath::Box2i window = header.dataWindow();
  Image image;
  image.width = static_cast<uint32_t>(window.max.x - window.min.x + 1);
  image.height = static_cast<uint32_t>(window.max.y - window.min.y + 1);
  for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
    const size_t pixels = size_t(image.width) * image.height;
    if (channel.channel().type == Imf::UINT) {
      image.integers.push_back({channel.name(), std::vector<uint32_t>(pixels)});
    } else {
      image.channels.push_back({channel.name(), std::vector<float>(pixels)});
    }
  }
  Imf::FrameBuffer frame;
  for (Channel& channel : image.channels) {
    frame.insert(channel.name, Imf::Slice::Make(Imf::FLOAT, channel.values.data(), window, sizeof(float),
                                                sizeof(float) * image.width));
  }
  for (IntegerChannel& channel : image.integers) {
    frame.insert(channel.name, Imf::Slice::Make(Imf::UINT, channel.values.data(), window, sizeof(uint32_t),
                                                sizeof(uint32_t) * image.width));
  }
  input.setFrameBuffer(frame);
  input.readPixels(window.min.y, window.max.y);
  for (auto attribute = header.begin(); attribute != header.end(); ++attribute) {
    const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute.attribute());
    if (text != nullptr) image.attributes[attribute.name()] = text->value();
  }
  const auto* seconds = header.findTypedAttribute<Imf::FloatAttribute>(kRenderTime);
  if (seconds != nullptr) image.renderSeconds = seconds->value();
  return image;
}

} // namespace

void writeExr(const std::filesystem::path& file, const Image& image) {
  checkPlanes(image);
  io::AtomicFile out(file);
  try {
    AtomicStream stream(out, file.string());
    const Imf::Header header = makeHeader(image);
    Imf::OutputFile output(stream, header, compressionThreads());
    Imf::FrameBuffer frame;
    for (const Channel& channel : image.channels) {
      // Slice takes a mutable pointer for reading and writing alike; writing a file only reads it.
      char* values = const_cast<char*>(reinterpret_cast<const char*>(channel.values.data()));
      frame.insert(channel.name, Imf::Slice(Imf::FLOAT, values, sizeof(float), sizeof(float) * image.width));
    }
    for (const IntegerChannel& channel : image.integers) {
      char* values = const_cast<char*>(reinterpret_cast<const char*>(channel.values.data()));
      frame.insert(channel.name, Imf::Slice(Imf::UINT, values, sizeof(uint32_t), sizeof(uint32_t) * image.width));
    }
    output.setFrameBuffer(frame);
    output.writePixels(static_cast<int>(image.height));
    // ~OutputFile writes the table of line offsets and swallows what that throws; commit() throws it again.
  } catch (const OutputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw OutputError(file.string() + ": " + error.what());
  }
  out.commit();
}

Image readExr(const std::filesystem::path& file) {
  FileStream stream(file);
  if (!stream.isOpen() || std::filesystem::is_directory(file))
    throw SceneError(file.string(), "", "a readable OpenEXR file");
  try {
    const uint64_t bytes = std::filesystem::file_size(file);
    checkHeader(file.string(), bytes, readFirstHeader(file, stream));
    stream.seekg(0);
    Imf::InputFile input(stream);
    if (!input.isComplete()) throw std::runtime_error("an OpenEXR file whose writing was not finished");
    checkHeader(file.string(), bytes, input.header());
    return readPlanes(input);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw SceneError(file.string(), "", error.what());
  }
}

} // namespace isophote
