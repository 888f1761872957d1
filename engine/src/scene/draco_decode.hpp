// Draco meshes from memory. The only place that knows libdraco.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace isophote {

/// Whether this build has libdraco; without it dracoOpen is not to be called.
[[nodiscard]] bool dracoAvailable();

/// How many triangles and points a stream announces, read before anything of that size is allocated.
struct DracoSize {
  uint32_t faces = 0;
  uint32_t vertices = 0; ///< at most as many points: seams of attributes make more of them
};

/// The numbers that an attribute is asked for in.
enum class DracoNumber : uint32_t { Int8, UInt8, Int16, UInt16, UInt32, Float };

/// Source: Google, Draco 3D Data Compression, bitstream specification 2.2, sections 4 and 5; the version that
/// KHR_draco_mesh_compression asks for.
/// @param problem  receives what is wrong with the stream
/// @return         false where it is no such stream
[[nodiscard]] bool dracoReadSize(std::span<const std::byte> stream, DracoSize& size, std::string& problem);

class DracoMesh {
public:
  DracoMesh();
  ~DracoMesh();
  DracoMesh(const DracoMesh&) = delete;
  DracoMesh& operator=(const DracoMesh&) = delete;

  /// Decodes the whole stream. False, with `problem`, where it is broken.
  [[nodiscard]] bool decode(std::span<const std::byte> stream, std::string& problem);

  [[nodiscard]] uint32_t pointCount() const;
  [[nodiscard]] uint32_t faceCount() const;

  /// Three points a face; not checked against pointCount.
  [[nodiscard]] std::vector<uint32_t> indices() const;

  [[nodiscard]] bool hasAttribute(uint32_t uniqueId) const;

  /// The attribute of every point as `components` tightly packed numbers. Empty where one does not fit `number`, or
  /// where the stream has another number of components.
  [[nodiscard]] std::vector<std::byte> attribute(uint32_t uniqueId, uint32_t components, DracoNumber number) const;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace isophote
