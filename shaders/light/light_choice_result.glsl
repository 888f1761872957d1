// A choice among a scene's lights.
#ifndef ISOPHOTE_LIGHT_LIGHT_CHOICE_RESULT_GLSL
#define ISOPHOTE_LIGHT_LIGHT_CHOICE_RESULT_GLSL

struct LightChoice {
  uint index;
  float pmf; // 0: no light is chosen, index is unspecified
};

#endif
