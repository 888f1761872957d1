#ifndef ISOPHOTE_TESTS_FRESNEL_CASE_H
#define ISOPHOTE_TESTS_FRESNEL_CASE_H

#include "shared/glsl_compat.h"

ISOPHOTE_SHARED_BEGIN

struct FresnelCase {
  float cosine;
  float eta;
  vec3 f0;
  vec3 f90;
};

struct FresnelResult {
  float dielectric;
  vec3 schlick;
};

ISOPHOTE_SHARED_END

#endif
