#pragma once

#include <cstdint>

/// Elementary functions on double or on four doubles at once, with the same bits in each lane: the same additions and
/// multiplications in the same order, no table, no contraction. Private to the batch kernels, which inline them under
/// their own target. Arguments outside the stated range give a finite nonsense, never a trap.
namespace talus::terramech::lanes {

/// Four doubles in one vector register, where the machine has one.
using Four = double __attribute__((vector_size(32)));
using FourBits = std::uint64_t __attribute__((vector_size(32)));

template <class T>
struct Traits;
template <>
struct Traits<double> {
  using Bits = std::uint64_t;
  static constexpr int kLanes = 1;
};
template <>
struct Traits<Four> {
  using Bits = FourBits;
  static constexpr int kLanes = 4;
};

#define TALUS_LANES [[gnu::always_inline]] inline

/// Where the condition holds a, else b.
template <class Mask, class T>
TALUS_LANES T pick(Mask condition, T a, T b) {
  return condition ? a : b;
}

/// The same number in each lane.
template <class T>
TALUS_LANES T spread(double value) {
  return T{} + value;
}

/// e^x for x in [-700, 700], relative error below 3e-13: x = k ln 2 + f, e^f by its series to f^10.
template <class T>
TALUS_LANES T exponential(T x) {
  using Bits = typename Traits<T>::Bits;
  constexpr double kRound = 6755399441055744.0;  // 1.5 * 2^52: adding it rounds to a whole number in the low bits
  x = pick(x < spread<T>(-700.0), spread<T>(-700.0), x);
  const T shifted = x * 1.4426950408889634 + kRound;
  const T k = shifted - kRound;
  const T f = (x - k * 6.93147180369123816490e-01) - k * 1.90821492927058770002e-10;
  T p = f * (1.0 / 3628800.0) + 1.0 / 362880.0;
  p = p * f + 1.0 / 40320.0;
  p = p * f + 1.0 / 5040.0;
  p = p * f + 1.0 / 720.0;
  p = p * f + 1.0 / 120.0;
  p = p * f + 1.0 / 24.0;
  p = p * f + 1.0 / 6.0;
  p = p * f + 0.5;
  p = p * f + 1.0;
  p = p * f + 1.0;
  const Bits power = (__builtin_bit_cast(Bits, shifted) + 1023) << 52;  // 2^k
  return p * __builtin_bit_cast(T, power);
}

/// ln x for normal x > 0, error below 1e-14 absolute or relative: x = 2^e m with m in [1/sqrt 2, sqrt 2),
/// ln m = 2 artanh((m - 1)/(m + 1)) by its series.
template <class T>
TALUS_LANES T logarithm(T x) {
  using Bits = typename Traits<T>::Bits;
  const Bits bits = __builtin_bit_cast(Bits, x);
  T m = __builtin_bit_cast(T, Bits((bits & 0x000fffffffffffffULL) | 0x3ff0000000000000ULL));
  T e = __builtin_bit_cast(T, Bits((bits >> 52) | 0x4330000000000000ULL)) - (4503599627370496.0 + 1023.0);
  const auto large = m > spread<T>(1.4142135623730951);
  m = pick(large, m * 0.5, m);
  e = pick(large, e + 1.0, e);
  const T f = (m - 1.0) / (m + 1.0);
  const T g = f * f;
  T p = g * (1.0 / 17.0) + 1.0 / 15.0;
  p = p * g + 1.0 / 13.0;
  p = p * g + 1.0 / 11.0;
  p = p * g + 1.0 / 9.0;
  p = p * g + 1.0 / 7.0;
  p = p * g + 0.2;
  p = p * g + 1.0 / 3.0;
  p = p * g + 1.0;
  return e * 0.6931471805599453 + 2.0 * f * p;
}

/// sin x for |x| <= pi/2, error below 1e-13, by its series to x^17.
template <class T>
TALUS_LANES T sine(T x) {
  const T g = x * x;
  T p = g * (1.0 / 355687428096000.0) - 1.0 / 1307674368000.0;
  p = p * g + 1.0 / 6227020800.0;
  p = p * g - 1.0 / 39916800.0;
  p = p * g + 1.0 / 362880.0;
  p = p * g - 1.0 / 5040.0;
  p = p * g + 1.0 / 120.0;
  p = p * g - 1.0 / 6.0;
  return x + x * g * p;
}

/// 1 - cos x for |x| <= pi/2, relative error below 1e-13, by its series to x^18.
template <class T>
TALUS_LANES T versine(T x) {
  const T g = x * x;
  T p = g * (1.0 / 6402373705728000.0) - 1.0 / 20922789888000.0;
  p = p * g + 1.0 / 87178291200.0;
  p = p * g - 1.0 / 479001600.0;
  p = p * g + 1.0 / 3628800.0;
  p = p * g - 1.0 / 40320.0;
  p = p * g + 1.0 / 720.0;
  p = p * g - 1.0 / 24.0;
  p = p * g + 0.5;
  return g * p;
}

}  // namespace talus::terramech::lanes
