// The specialisation constants of both lists, as GLSL constants.
#ifndef ISOPHOTE_CONSTANTS_GLSL
#define ISOPHOTE_CONSTANTS_GLSL

#define ISOPHOTE_FEATURE(id, constant, name, omitted) layout(constant_id = id) const bool constant = true;
#include "shared/features.inc"
#undef ISOPHOTE_FEATURE

#define ISOPHOTE_SETTING(id, constant, fallback) layout(constant_id = id) const uint constant = fallback;
#include "shared/settings.inc"
#undef ISOPHOTE_SETTING

#endif
