// Weights of multiple importance sampling for two techniques with one sample each.
// Source: Veach 1997, section 9.2.
#ifndef ISOPHOTE_KERNELS_MIS_GLSL
#define ISOPHOTE_KERNELS_MIS_GLSL

#include "shared/constants.glsl"

// Weight of a sample taken with density `pdf` where the other technique has density `otherPdf` (same measure, both >=
// 0, pdf > 0). The quotient form neither overflows nor divides zero by zero.
float misWeight(const float pdf, const float otherPdf) {
  const float ratio = otherPdf / pdf;
  return 1.0 / (1.0 + (kMisHeuristic == 1u ? ratio * ratio : ratio));
}

// Weight of emission found by a path whose last direction had density `pdfBsdf` (0: camera ray or delta bounce, which
// light sampling cannot produce), where light sampling has density `pdfLight`.
float emissionWeight(const float pdfBsdf, const float pdfLight) {
  if (pdfBsdf <= 0.0 || pdfLight <= 0.0 || kLightSampling == 2u) return 1.0;
  if (kLightSampling == 1u) return 0.0;
  return misWeight(pdfBsdf, pdfLight);
}

#endif
