#ifndef ISOPHOTE_TESTS_FACET_CASE_H
#define ISOPHOTE_TESTS_FACET_CASE_H

#include "shared/glsl_compat.h"

ISOPHOTE_SHARED_BEGIN

struct FacetCase {
  float cosine;
  float n;
  float k;
  float filmIor;
  float thickness;
  vec3 f0;
};

struct FacetResult {
  float conductor;
  float dielectric; // of index n
  vec3 film;
  float bound;
};

ISOPHOTE_SHARED_END

#endif
