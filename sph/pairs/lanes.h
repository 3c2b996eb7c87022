// Eight floats that are added and multiplied at once; compiles to AVX where there is AVX and to plain code elsewhere.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#ifdef __AVX__
#include <immintrin.h>
#endif

#ifndef __clang__
#pragma GCC diagnostic ignored "-Wpsabi"  // without AVX: passing vectors by value between functions, all inlined here
#endif

namespace flowskin::sph {

/// Vector type of GCC and Clang; + - * / and comparisons work lane by lane.
typedef float Float8 __attribute__((vector_size(32)));
typedef std::int32_t Int8 __attribute__((vector_size(32)));

inline Float8 broadcast(float s) { return Float8{s, s, s, s, s, s, s, s}; }

/// 1 in the lanes whose bits are set, 0 in the others.
inline Float8 lanes_of(unsigned bits) {
  Float8 lanes;
  for (int k = 0; k < 8; ++k) lanes[k] = bits >> k & 1U ? 1.0F : 0.0F;
  return lanes;
}

inline Float8 load8(const float* p) {
  Float8 r;
  std::memcpy(&r, p, sizeof r);
  return r;
}

inline Float8 max(const Float8& a, const Float8& b) {
#ifdef __AVX__
  return _mm256_max_ps(a, b);
#else
  return a > b ? a : b;
#endif
}

inline Float8 min(const Float8& a, const Float8& b) {
#ifdef __AVX__
  return _mm256_min_ps(a, b);
#else
  return a < b ? a : b;
#endif
}

inline Float8 sqrt(const Float8& a) {
#ifdef __AVX__
  return _mm256_sqrt_ps(a);
#else
  Float8 r;
  for (int k = 0; k < 8; ++k) r[k] = std::sqrt(a[k]);
  return r;
#endif
}

/// Nearest whole numbers; exact and odd (round8(-a) = -round8(a)) for |a| below 2^22.
inline Float8 round8(const Float8& a) {
#ifdef __AVX__
  return _mm256_round_ps(a, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
#else
  const Float8 shift = broadcast(12582912.0F);  // 1.5 * 2^23: what is added to it loses its fraction
  return (a + shift) - shift;
#endif
}

/// Bit k is set where lane k of a is below lane k of b.
inline unsigned less_mask(const Float8& a, const Float8& b) {
#ifdef __AVX__
  return static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LT_OQ)));
#else
  unsigned mask = 0;
  for (int k = 0; k < 8; ++k) mask |= static_cast<unsigned>(a[k] < b[k]) << k;
  return mask;
#endif
}

}  // namespace flowskin::sph
