// The specialisation constants' ids of shared/settings.inc.
#pragma once

#include <cstdint>

namespace isophote::setting_id {

enum : uint32_t {
#define ISOPHOTE_SETTING(id, constant, fallback) constant = id,
#include "shared/settings.inc"
#undef ISOPHOTE_SETTING
};

} // namespace isophote::setting_id
