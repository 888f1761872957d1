#pragma once

namespace isophote {
inline constexpr const char* kVersion = "0.1.0";
}
