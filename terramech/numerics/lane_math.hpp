#pragma once

#include <cstdint>

/// Elementary functions of one double, or of four doubles (lanes) at once. The results of all lanes are
/// bit-identical to those of a single double, because every lane executes the same additions and
/// multiplications in the same order, without tables and without contraction. Private to the batch kernels,
/// which inline the functions for their own processor. The accuracy suffices for wheel forces to 1e-7, but is
/// below double precision. Results for arguments outside the stated range are finite and undefined; no
/// argument traps.
namespace talus::terramech::lanes {

/// Four doubles, in one vector register if the processor supports this.
using Four = double __attribute__((vector_size(32)));
using FourBits = std::uint64_t __attribute__((vector_size(32)));

/// Integer type and number of lanes of a lane type.
template <class T>
struct Traits;
template <>
struct Traits<double> {
  using Bits = std::uint64_t;  ///< unsigned integer of the same size
  static constexpr int kLanes = 1;
};
template <>
struct Traits<Four> {
  using Bits = FourBits;
  static constexpr int kLanes = 4;
};

#define TALUS_LANES [[gnu::always_inline]] inline

/// Returns a in the lanes where the condition is true, and b in the other lanes.
template <class Mask, class T>
TALUS_LANES T pick(Mask condition, T a, T b) {
  return condition ? a : b;
}

/// Returns a vector with `value` in each lane.
template <class T>
TALUS_LANES T spread(double value) {
  return T{} + value;
}

/// Returns e^max(x, -700) for x <= 700, with a relative error below 2e-12. With x = k ln 2 + f, e^f is
/// evaluated as a Chebyshev polynomial.
template <class T>
TALUS_LANES T exponential(T x) {
  using Bits = typename Traits<T>::Bits;
  constexpr double kRound =
      6755399441055744.0;  // 1.5 * 2^52: the addition rounds to an integer in the low bits
  x = pick(x < spread<T>(-700.0), spread<T>(-700.0), x);
  const T shifted = x * 1.4426950408889634 + kRound;
  const T k = shifted - kRound;
  const T f = (x - k * 6.93147180369123816490e-01) - k * 1.90821492927058770002e-10;
  T p = f * 2.487648831079502e-05 + 0.0001991588383383438;
  p = p * f + 0.0013888820950714424;
  p = p * f + 0.008333266065891581;
  p = p * f + 0.04166666689586567;
  p = p * f + 0.16666666891219123;
  p = p * f + 0.49999999999788103;
  p = p * f + 0.9999999999797613;
  p = p * f + 1.0000000000000002;
  const Bits power = (__builtin_bit_cast(Bits, shifted) + 1023) << 52;  // 2^k
  return p * __builtin_bit_cast(T, power);
}

/// Returns ln x for normal x > 0, with an error below 2e-12. With x = 2^e m and m in [1/sqrt 2, sqrt 2), ln m
/// = 2 artanh((m - 1)/(m + 1)) is evaluated as a Chebyshev polynomial.
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
  T p = g * 0.11808492478190863 + 0.14267509407813553;
  p = p * g + 0.20000192590108157;
  p = p * g + 0.3333333262249838;
  p = p * g + 1.0000000000041889;
  return e * 0.6931471805599453 + 2.0 * f * p;
}

/// Returns 1 / sqrt x for normal x > 0, with a relative error below 1e-15. The initial value follows by
/// halving the exponent of x; then four Newton steps are made.
template <class T>
TALUS_LANES T inverseRoot(T x) {
  using Bits = typename Traits<T>::Bits;
  T y = __builtin_bit_cast(T, Bits(0x5fe6eb50c7b537a9ULL - (__builtin_bit_cast(Bits, x) >> 1)));
  const T half = 0.5 * x;
  for (int step = 0; step < 4; ++step) y = y * (1.5 - half * y * y);
  return y;
}

/// Returns sin x for |x| <= pi/2, with a relative error below 3e-11, by a Chebyshev polynomial in x^2.
template <class T>
TALUS_LANES T sine(T x) {
  const T g = x * x;
  T p = g * -2.388899174917653e-08 + 2.7525257264877756e-06;
  p = p * g - 0.00019840860938567066;
  p = p * g + 0.00833333097235194;
  p = p * g - 0.16666666616766518;
  p = p * g + 0.9999999999828987;
  return x * p;
}

/// Returns 1 - cos x for |x| <= pi/2, with a relative error below 4e-12, by a Chebyshev polynomial in x^2.
template <class T>
TALUS_LANES T versine(T x) {
  const T g = x * x;
  T p = g * -2.0043685449115407e-09 + 2.7534334726393917e-07;
  p = p * g - 2.480129404899244e-05;
  p = p * g + 0.0013888887195327446;
  p = p * g - 0.04166666663086995;
  p = p * g + 0.4999999999987732;
  return g * p;
}

}  // namespace talus::terramech::lanes
