// Rays through a scene, and what they meet.
#ifndef ISOPHOTE_TEST_TRAVERSAL_CASE_H
#define ISOPHOTE_TEST_TRAVERSAL_CASE_H

#include "shared/glsl_compat.h"

ISOPHOTE_SHARED_BEGIN

struct TraversalCase {
  vec3 origin;
  float tMin;
  vec3 direction;
  float tMax;
  uint pixel;
  uint sampleIndex;
  uint vertex;
};

struct TraversalResult {
  float t;
  uint instance;
  uint triangle;
  vec2 barycentrics;
  uint found;
  uint occluded; // the answer of traceOccluded to the same ray
  uint stackOverflow;
  uint geometry; // of the triangle hit
  uint primitiveIndex;
};

// Rays from a point inside a surface through it, then on from there.
struct StepResult {
  uint first;  // geometry met first, or kInvalidIndex
  uint second; // geometry met by the ray that continues beyond it
  uint back;   // geometry met by the ray that turns back
  float secondT;
  float backT;
};

// What a ray cost, first for its closest hit, then for the question whether it is occluded.
struct StepCountResult {
  uint turns[2]; // of the loop
  uint nodes[2];
  uint triangles[2];
  uint instances[2];
};

ISOPHOTE_SHARED_END

#endif
