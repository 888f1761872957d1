// The Film's exact sums. 64-bit fixed point: a value v is stored as round(v * scale) with scale a power of two, rounded
// stochastically by a hash of the sample so that the expectation is exact at any magnitude. Integer addition commutes:
// the sums do not depend on the order of samples.
#ifndef ISOPHOTE_SHARED_FILM_TYPES_H
#define ISOPHOTE_SHARED_FILM_TYPES_H

#include "glsl_compat.h"

ISOPHOTE_SHARED_BEGIN

// Sample s of a pixel belongs to replicate s % kReplicateCount and is point s / kReplicateCount of that replicate's
// sequence. Replicates are scrambled independently, so the spread of their means estimates the error of the image also
// where samples within a replicate are correlated (Owen-scrambled Sobol).
ISOPHOTE_CONST uint kReplicateCount = 8u;

struct ReplicateSum {
  Int64 red;
  Int64 green;
  Int64 blue;
  uint count;    // samples
  uint hitCount; // samples whose camera ray met a surface
};

// Sums over the camera rays that met a surface, of samples with index below kAovSampleCount.
struct AovSum {
  Int64 albedo[3];
  Int64 normal[3];
  Int64 depth;       // along the view axis; of a panorama the distance
  Int64 position[3]; // relative to the scene's world origin
  uint count;
  uint unused; // keeps 64-bit members aligned in arrays
};
ISOPHOTE_CONST uint kAovSampleCount = 64u;

// Radiance that a setting took from a pixel's samples (EstimatorSettings::clamp, ::maxDepth), in the units of
// ReplicateSum.
struct RemovedSum {
  Int64 red;
  Int64 green;
  Int64 blue;
};

// Radiance is stored in units of 2^-kRadianceFractionBits * PackedScene::emitterScale. A sum holds 2^27 samples of
// emitterScale, a single sample is clipped (and counted) at 2^26 emitterScale.
ISOPHOTE_CONST uint kRadianceFractionBits = 36u;

// Where one of the eight replicates holds more of a pixel's squared deviations, its error bar rests on about one event
// and is not trusted. By Grubbs' test (1950) this share is t = 8 on 6 degrees of freedom: of normal pixels 0.16% a
// channel are misjudged so.
ISOPHOTE_CONST float kTrustedShare = 0.8f;

// One invocation's share of the image's error estimate.
struct ErrorPartial {
  float luminance;      // sum over pixels of the mean's luminance
  float relativeSquare; // sum over pixels and channels of Var[mean] / (mean^2 + e^2)
  float termSquare;     // sum over pixels of the square of that pixel's share of relativeSquare
  float untrusted;      // the part of relativeSquare that untrusted pixels hold
  uint pixelCount;      // pixels with at least two replicates
  uint untrustedCount;  // of them
};
ISOPHOTE_CONST uint kErrorInvocations = 4096u;

struct FilmArgs {
  Address replicates; // ReplicateSum[pixelCount * kReplicateCount], pixel-major
  Address target;     // ErrorPartial[kErrorInvocations] or packed RGBA8
  uint pixelCount;
  float valueScale;    // from fixed point to radiance
  float epsilonSquare; // e^2 of the error metric
  float exposure;      // factor
  uint toneMap;
};

ISOPHOTE_SHARED_END

#endif
