// The Film's exact sums.
#ifndef ISOPHOTE_SHARED_FILM_TYPES_H
#define ISOPHOTE_SHARED_FILM_TYPES_H

#include "glsl_compat.h"

ISOPHOTE_SHARED_BEGIN

// Sample s of a pixel belongs to replicate s % kReplicateCount and is point s / kReplicateCount of that replicate's
// sequence. Replicates are scrambled independently, so the spread of their means estimates the error of the image also
// where samples within a replicate are correlated (Owen-scrambled Sobol).
ISOPHOTE_CONST uint kReplicateCount = 8u;

ISOPHOTE_SHARED_END

#endif
