#ifndef ISOPHOTE_TESTS_CAMERA_FILTER_CASE_H
#define ISOPHOTE_TESTS_CAMERA_FILTER_CASE_H

#include "shared/glsl_compat.h"

ISOPHOTE_SHARED_BEGIN

struct CameraFilterCase {
  vec2 u;
};

struct CameraFilterResult {
  vec2 offset;
};

ISOPHOTE_SHARED_END

#endif
