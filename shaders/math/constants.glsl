#ifndef ISOPHOTE_MATH_CONSTANTS_GLSL
#define ISOPHOTE_MATH_CONSTANTS_GLSL

const float kPi = 3.14159265;
const float kTwoPi = 6.28318531;
const float kInvPi = 0.318309886;
const float kInvTwoPi = 0.159154943;
const float kInv4Pi = 0.0795774715;

#endif
