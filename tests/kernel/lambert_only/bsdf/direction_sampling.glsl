// Of the control: the one technique stands in bsdf/surface_bsdf.glsl.
#include "bsdf/surface_bsdf.glsl"
