// The attributes in the headers of an OpenEXR file, walked before OpenEXR reads them.
#pragma once

#include <cstdint>
#include <filesystem>

namespace isophote::io {

/// OpenEXR allocates what a size within a header says before it reads any of it, and reads on where a value ended,
/// whatever its size was said to be. So every size must fit the file, and be that of its value.
///
/// @param parts  the file may have several parts, whose headers follow each other
/// @throws std::runtime_error saying what is wrong
void checkExrAttributes(const std::filesystem::path& file, bool parts);

} // namespace isophote::io
