// What passes between the stages of the wavefront. Each path owns one slot of the pool; queues hold slot numbers.
#ifndef ISOPHOTE_SHARED_PATH_TYPES_H
#define ISOPHOTE_SHARED_PATH_TYPES_H

#include "camera_types.h"
#include "film_types.h"
#include "glsl_compat.h"
#include "light_types.h"

ISOPHOTE_SHARED_BEGIN

struct RayState {
  vec3 origin;
  float tMin;
  vec3 direction; // unit
  float tMax;
};

struct HitState {
  uint instance; // kInvalidIndex: none (stored for escaped paths only where there are sphere lights)
  uint triangle; // kInvalidIndex: a sphere light
  vec2 barycentrics;
};

struct PathState {
  vec3 beta;           // throughput, 1/pdf included
  float pdfSolidAngle; // of the last BSDF sample; 0: camera ray or delta bounce, which no light sample can match
  vec3 radiance;
  uint depth; // scattering events so far
  uint pixel; // x | y << 16 in the full image
  uint sampleIndex;
  uint hit; // 1: the camera ray met a surface
};

// PathState.sampleIndex of a slot that holds no sample: padding of a border tile, or free between dispatches of
// `fused`.
ISOPHOTE_CONST uint kNoSample = 0xffffffffu;

struct ShadowState {
  vec3 origin;
  float tMax;
  vec3 direction;
  uint target;       // sphere light that the ray ends on and that does not shade itself: its instance; or kInvalidIndex
  vec3 contribution; // complete: beta, BSDF, light, MIS weight and 1/pdf
};

// The media around a point, by the material of their boundaries, in the order in which a path entered them;
// kInvalidIndex after the last.
ISOPHOTE_CONST uint kMediumStackSize = 4u;
struct MediumStack {
  uint materials[4]; // kMediumStackSize
};

// What a path knows of media; only in scenes with volumes.
struct MediaState {
  MediumStack path;   // around its ray
  MediumStack shadow; // around its shadow ray
  float travelled;    // since the last scattering, through boundaries that do nothing, up to the ray's origin
  float hitDistance;  // of the ray
  uint segments;      // free paths sampled so far
};

// Where a path is, in scenes with transmission.
struct InteriorState {
  float etaScale; // squared index of the path's medium over that at the camera
  uint channel;   // the one that dispersion left of the path: 1 + its index, 0: all
};

// StraightState.path: whether shadow rays that cross glass unbent have counted the light that a path may still find.
ISOPHOTE_CONST uint kStraightNone = 0u;    // not since it left the camera, a mirror or glass that reflected it
ISOPHOTE_CONST uint kStraightSampled = 1u; // its last vertex sent such a ray
ISOPHOTE_CONST uint kStraightCounted =
    2u; // the same, and it has passed nothing but glass since: what it finds is theirs

// Only where shadow rays cross glass unbent.
struct StraightState {
  float lightWeight; // of multiple importance sampling, in the shadow ray's contribution; 0: glass stops this ray
  uint path;         // kStraight*
};

// Only where paths are followed beyond the depth limit, to measure what it leaves out. One sample in kBeyondShare is.
struct BeyondState {
  vec3 kept;    // radiance within the limit, while the path gathers what lies beyond
  uint reached; // 1: it does
};
ISOPHOTE_CONST uint kBeyondShare = 8u;

ISOPHOTE_CONST uint kQueueFree = 0u;
ISOPHOTE_CONST uint kQueueRay = 1u;
ISOPHOTE_CONST uint kQueueSurface = 2u;
ISOPHOTE_CONST uint kQueueEscaped = 3u;
ISOPHOTE_CONST uint kQueueShadow = 4u;
ISOPHOTE_CONST uint kQueueFinished = 5u;
ISOPHOTE_CONST uint kQueueMedium = 6u; // last: absent without scattering media
ISOPHOTE_CONST uint kQueueCount = 7u;

// Where each stage finds its indirect dispatch size in WaveState.dispatches.
ISOPHOTE_CONST uint kStageRegenerate = 0u;
ISOPHOTE_CONST uint kStageIntersectClosest = 1u;
ISOPHOTE_CONST uint kStageShadeEscaped = 2u;
ISOPHOTE_CONST uint kStageShadeSurface = 3u;
ISOPHOTE_CONST uint kStageIntersectShadow = 4u;
ISOPHOTE_CONST uint kStageAccumulate = 5u;
ISOPHOTE_CONST uint kStageShadeMedium = 6u;
ISOPHOTE_CONST uint kStageCount = 7u;

// Which part of the bookkeeping `prepare` does.
ISOPHOTE_CONST uint kPrepareRegenerate = 0u;
ISOPHOTE_CONST uint kPrepareIntersect = 1u;
ISOPHOTE_CONST uint kPrepareShade = 2u;
ISOPHOTE_CONST uint kPrepareShadow = 3u;
ISOPHOTE_CONST uint kPrepareMedium = 4u; // before kPrepareShade
ISOPHOTE_CONST uint kPrepareFused = 5u;
ISOPHOTE_CONST uint kPrepareAfterFused = 6u;

ISOPHOTE_CONST uint kStatusQueueOverflow = 0u;
ISOPHOTE_CONST uint kStatusStackOverflow = 1u;
ISOPHOTE_CONST uint kStatusNonFinite = 2u;
ISOPHOTE_CONST uint kStatusNegative = 3u;
ISOPHOTE_CONST uint kStatusClipped = 4u;
ISOPHOTE_CONST uint kStatusOutOfBounds = 5u;
ISOPHOTE_CONST uint kStatusMediumOverflow = 6u;
ISOPHOTE_CONST uint kStatusCount = 7u;

struct DispatchSize {
  uint x;
  uint y;
  uint z;
};

// The wavefront's only shared mutable state. Counts are written by queue pushes (atomic) and by `prepare` (alone).
struct WaveState {
  Uint64 nextWork; // work items handed out; item w is sample w / paddedPixelCount of pixel w % paddedPixelCount
  Uint64 primaryRays;
  Uint64 bounceRays;
  Uint64 shadowRays;
  DispatchSize dispatches[7]; // kStageCount
  uint counts[7];             // kQueueCount
  uint status[7];             // kStatusCount
  uint regenerateCount;       // work items that start in this wave, or may start in this dispatch of `fused`
  uint regenerateSample;      // sample index, relative to firstSample, and padded pixel of the first of them
  uint regeneratePixel;
  uint regenerateTaken; // by `fused`, of those and beyond (atomic)
};

// Fixed for one call of render.
struct RenderView {
  CameraRecord camera;
  Address filterTable; // float[kFilterTableSize]
  Address replicates;  // ReplicateSum[crop pixels * kReplicateCount]
  Address aovs;        // AovSum[crop pixels] or 0
  Address clamped;     // RemovedSum[crop pixels] or 0
  Address beyond;      // RemovedSum[crop pixels] or 0: what lies beyond maxDepth
  Address beyondPaths; // BeyondState[capacity]; with kDepthLedger only
  Address pixels;      // uint[paddedPixelCount], crop pixels row by row; with kPixelList only
  Uint64 workEnd;
  uvec2 imageSize;
  uvec2 cropOrigin;
  uvec2 cropSize;
  uvec2 tileSize; // powers of two; work walks the crop tile by tile
  uint tileColumns;
  uint paddedPixelCount;
  uint firstSample;
  uint maxDepth;
  uvec2 seed;
  float radianceScale; // fixed point per unit of radiance
  float distanceScale; // fixed point per unit of length
  float sampleLimit;   // radiance; read with kClamp only
  uint unused;         // keeps the size a multiple of 8
  MediumStack cameraMedia;
};

// The push constant of every kernel of a render.
struct KernelArgs {
  Address scene;  // SceneView
  Address render; // RenderView
  Address wave;   // WaveState
  Address queues; // uint[kQueueCount][capacity]
  Address rays;   // RayState[capacity], as the next three indexed by slot
  Address hits;
  Address paths;
  Address shadows;
  Address interiors; // InteriorState[capacity], 0 where nothing transmits
  Address receivers; // LightReceiver that sampled a light last, for the weight of what its BSDF ray finds; 0: not kept
  Address media;     // MediaState[capacity], 0 without volumes
  Address straight;  // StraightState[capacity], 0 where glass stops shadow rays
  uint capacity;
  uint activeLimit; // paths in flight (fused: whole workgroups of them), 0: no new path starts
  uint prepare;     // kPrepare*
  uint workgroupSize;
  uint steps;  // vertices that each slot goes on by in a dispatch of `fused`; 0: it marks the free slots
  uint unused; // keeps the size a multiple of 8
};

ISOPHOTE_SHARED_END

#endif
