#ifndef ISOPHOTE_TESTS_LIGHT_TREE_CASE_H
#define ISOPHOTE_TESTS_LIGHT_TREE_CASE_H

#include "shared/light_types.h"

ISOPHOTE_SHARED_BEGIN

struct LightTreeCase {
  LightReceiver receiver;
  uvec2 bits;
  uint light;
};

struct LightTreeResult {
  uint index; // chosen by bits
  float pmf;
  float pmfOfIndex; // asked for the chosen light
  float pmfOfLight; // asked for LightTreeCase.light
};

ISOPHOTE_SHARED_END

#endif
