// Whether two images differ by more than their own noise.
#pragma once

#include "isophote/compare.hpp"

namespace isophote::estimate {

/// Tests the hypothesis that both images have the same expectation, at family-wise significance 0.001.
///
/// Every pixel-channel gives Welch's t = (a - b) / sqrt(sa^2 + sb^2), and so do the means of blocks of 4x4, 16x16, …
/// pixels up to the whole image: a pixel test alone cannot see a small bias everywhere, nor one confined to a few
/// pixels. A pixel has the degrees of freedom of the image with fewer replicates, which bounds the tail from above
/// (Mickey and Brown 1966, "Bounds on the Distribution Functions of the Behrens-Fisher Statistic"); Welch's estimate
/// exceeded its level 2.6 times out where thousands of tests look. A block has those of Satterthwaite (1946). The
/// significance of one test is Sidak's (1967) for all of them. The images are the same where 99.9% of the
/// pixel-channels pass and every block does. A pixel whose error is unknown (fewer than two replicates, or not finite)
/// is inconclusive: it does not pass. Differences below 1e-5 of the value are rounding and count as none.
/// @return nothing where an image has no stderr channels
[[nodiscard]] std::optional<Verdict> compareStatistically(const Image& a, const Image& b);

} // namespace isophote::estimate
