#ifndef ISOPHOTE_TESTS_FRAME_CASE_H
#define ISOPHOTE_TESTS_FRAME_CASE_H

#include "shared/glsl_compat.h"

ISOPHOTE_SHARED_BEGIN

struct FrameCase {
  vec3 normal;
  vec3 tangent;
  float handedness;
};

struct FrameResult {
  vec3 tangent; // of frameFromNormal
  vec3 bitangent;
  vec3 tangentGiven; // of frameFromNormalTangent
  vec3 bitangentGiven;
  vec3 roundTrip;  // toWorld(toLocal(case.tangent)) in the first frame
  vec3 normalized; // safeNormalize(case.tangent, case.normal)
};

ISOPHOTE_SHARED_END

#endif
