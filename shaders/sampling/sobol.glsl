// Pairs of Owen-scrambled Sobol points.
#ifndef ISOPHOTE_SAMPLING_SOBOL_GLSL
#define ISOPHOTE_SAMPLING_SOBOL_GLSL

/// Owen's nested uniform scrambling of bit-reversed numbers: bit k is flipped by a hash of the bits below it.
///
/// Sources: Laine and Karras 2011, "Stratified Sampling for Stochastic Transparency"; Burley 2020, "Practical
/// Hash-based Owen Scrambling", JCGT 9(4); constants from Vegdahl 2021, "Building a Better LK Hash".
/// @param seed  well mixed: both halves are used
uint owenScrambleReversed(uint x, uint seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16u) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

/// Bit-reversed second Sobol coordinate of point `index` (the first is bitfieldReverse(index)).
///
/// Its generator matrix is Pascal's triangle modulo 2, a Kronecker power, so five butterfly steps apply it.
/// Source: Ahmed 2024, "An Implementation Algorithm of 2D Sobol Sequence Fast, Elegant, and Compact", EGSR.
uint sobolSecondReversed(uint index) {
  index ^= index >> 16u;
  index ^= (index & 0xff00ff00u) >> 8u;
  index ^= (index & 0xf0f0f0f0u) >> 4u;
  index ^= (index & 0xccccccccu) >> 2u;
  index ^= (index & 0xaaaaaaaau) >> 1u;
  return index;
}

/// Point `index` of a (0,2)-sequence in base 2, Owen-scrambled, in an order that is itself Owen-scrambled: every
/// aligned block of 2^m indices is a (0,m,2)-net, and sequences with different seeds are as good as independent of each
/// other.
///
/// @param seeds  x: order, y and z: coordinates; well mixed
/// @return       both coordinates as 32-bit fractions
uvec2 owenSobol2d(uint index, uvec3 seeds) {
  const uint shuffled = bitfieldReverse(owenScrambleReversed(bitfieldReverse(index), seeds.x));
  return uvec2(bitfieldReverse(owenScrambleReversed(shuffled, seeds.y)),
               bitfieldReverse(owenScrambleReversed(sobolSecondReversed(shuffled), seeds.z)));
}

#endif
