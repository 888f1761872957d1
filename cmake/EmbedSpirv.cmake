# Script: writes ${OUT}/${TARGET}_kernels.{hpp,cpp} with the words of each SPIR-V file in BINARIES.
set(semicolon "\;")
file(WRITE ${OUT}/${TARGET}_kernels.hpp "#pragma once

#include <string_view>

#include \"gpu/kernel.hpp\"

namespace ${TARGET}_kernels {
/// @throws isophote::Error where no kernel has that name
const isophote::gpu::KernelSource& kernelSource(std::string_view name);
} // namespace ${TARGET}_kernels
")
set(cpp ${OUT}/${TARGET}_kernels.cpp)
file(WRITE ${cpp} "#include \"${TARGET}_kernels.hpp\"

#include <array>
#include <string>

#include \"isophote/error.hpp\"

namespace {
")
foreach(file IN LISTS BINARIES)
  get_filename_component(name ${file} NAME_WE)
  file(READ ${file} hex HEX)
  string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1,\n" words "${hex}")
  file(APPEND ${cpp} "const uint32_t ${name}Words[] = {\n${words}};\n")
endforeach()
list(LENGTH BINARIES count)
file(APPEND ${cpp} "const std::array<isophote::gpu::KernelSource, ${count}> kSources{{\n")
foreach(file IN LISTS BINARIES)
  get_filename_component(name ${file} NAME_WE)
  file(APPEND ${cpp} "    {\"${name}\", ${name}Words},\n")
endforeach()
file(APPEND ${cpp} "}};
} // namespace

namespace ${TARGET}_kernels {
const isophote::gpu::KernelSource& kernelSource(std::string_view name) {
  for (const auto& source : kSources) {
    if (name == source.name) return source;
  }
  throw isophote::Error(\"no kernel named \" + std::string(name));
}
} // namespace ${TARGET}_kernels
")
