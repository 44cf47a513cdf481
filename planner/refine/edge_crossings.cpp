#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include <talus/planner/refine/edge_crossings.hpp>
#include <talus/planner/route/heading_cost.hpp>

namespace talus::planner {
namespace {

using costmap::CellCode;
using costmap::TravelCost;
using costmap::TravelCurve;

constexpr float kNoCost = std::numeric_limits<float>::infinity();
constexpr int kBinBits = 9;
static_assert(TravelCurve::kBins == 1 << kBinBits);

// Headings and lengths of consecutive motions.
struct Motions {
  const double *x, *y;
  const float* length;
};

void pricesByScalar(const TravelCost& cost, CellCode cell, float here, const Motions& motions, int count,
                    float* paid) noexcept {
  for (int i = 0; i < count; ++i)
    paid[i] = here + HeadingCost(cost, motions.x[i], motions.y[i])(cell) * motions.length[i];
}

#if defined(__x86_64__)
// The lower 32 bits of each 64-bit mask.
__attribute__((target("avx2"))) inline __m128i lanes(__m256d mask) noexcept {
  const __m256i evens = _mm256_setr_epi32(0, 2, 4, 6, 0, 2, 4, 6);
  return _mm256_castsi256_si128(_mm256_permutevar8x32_epi32(_mm256_castpd_si256(mask), evens));
}

// TravelCurve::between(): the previous node, whether the coordinate differs from the node (-1), and the
// weight of the next node.
struct Betweens {
  __m128i whole, off;
  __m128 share;
};
__attribute__((target("avx2"))) inline Betweens betweens(__m256d place) noexcept {
  const __m256d same = _mm256_set1_pd(TravelCurve::kSame);
  const __m128i whole = _mm256_cvttpd_epi32(_mm256_add_pd(place, same));
  const __m256d rest = _mm256_sub_pd(place, _mm256_cvtepi32_pd(whole));
  const __m128i off = lanes(_mm256_cmp_pd(rest, same, _CMP_GT_OQ));
  return {whole, off, _mm_and_ps(_mm256_cvtpd_ps(rest), _mm_castsi128_ps(off))};
}

struct Prices {
  __m128 here, next;
};

// Returns the costs `prices` at four node indices `at` and at the indices after them. Lanes without a set
// sign bit in `off` have their coordinate on the node and get the cost of the node twice.
__attribute__((target("avx2"))) inline Prices pairsAt(const float* prices, __m128i at, __m128i off) noexcept {
  alignas(16) std::array<std::int32_t, 4> lane;
  _mm_store_si128(reinterpret_cast<__m128i*>(lane.data()), at);
  const auto pair = [&](std::size_t k) __attribute__((target("avx2"))) {
    return _mm_castsi128_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(prices + lane[k])));
  };
  const __m128 first = _mm_unpacklo_ps(pair(0), pair(1)), second = _mm_unpacklo_ps(pair(2), pair(3));
  const __m128 here = _mm_movelh_ps(first, second), next = _mm_movehl_ps(second, first);
  return {here, _mm_blendv_ps(here, next, _mm_castsi128_ps(off))};
}

// The operations of HeadingCost for four motions at a time.
__attribute__((target("avx2"))) void pricesByVector(const TravelCost& cost, CellCode cell, float here,
                                                    const Motions& motions, int count, float* paid) noexcept {
  const __m256d steps_x = _mm256_set1_pd(cell.stepsX()), steps_y = _mm256_set1_pd(cell.stepsY());
  const __m256d most_along = _mm256_set1_pd(cost.limits().max_along),
                most_across = _mm256_set1_pd(cost.limits().max_across);
  const __m256d no_sign = _mm256_castsi256_pd(_mm256_set1_epi64x(0x7fffffffffffffff));
  const TravelCurve& curve = cost.curves()[cell.curve()];
  const float* prices = curve.rows();
  const __m128i last_row = _mm_set1_epi32(curve.lastRow());
  const __m256d bins_per_unit = _mm256_set1_pd(TravelCurve::kBinsPerUnit),
                rows_per_unit = _mm256_set1_pd(TravelCurve::kRowsPerUnit),
                middle = _mm256_set1_pd(TravelCurve::kBins / 2),
                last_place = _mm256_set1_pd(TravelCurve::kLastPlace);
  const __m128 no_cost = _mm_set1_ps(kNoCost);
  for (int i = 0; i < count; i += EdgeCrossings::kVector) {
    const __m256d x = _mm256_loadu_pd(motions.x + i), y = _mm256_loadu_pd(motions.y + i);
    const __m256d along = _mm256_add_pd(_mm256_mul_pd(steps_x, x), _mm256_mul_pd(steps_y, y));
    const __m256d across =
        _mm256_and_pd(_mm256_sub_pd(_mm256_mul_pd(steps_y, x), _mm256_mul_pd(steps_x, y)), no_sign);
    const __m256d place = _mm256_add_pd(_mm256_mul_pd(along, bins_per_unit), middle);
    const __m256d allowed =
        _mm256_and_pd(_mm256_and_pd(_mm256_cmp_pd(_mm256_and_pd(along, no_sign), most_along, _CMP_LE_OQ),
                                    _mm256_cmp_pd(across, most_across, _CMP_LE_OQ)),
                      _mm256_and_pd(_mm256_cmp_pd(place, _mm256_setzero_pd(), _CMP_GE_OQ),
                                    _mm256_cmp_pd(place, last_place, _CMP_LT_OQ)));
    const __m128i known = lanes(allowed);
    const Betweens bin = betweens(place), row = betweens(_mm256_mul_pd(across, rows_per_unit));
    const auto nodes = [&](__m128i of_row) __attribute__((target("avx2"))) {
      const __m128i at = _mm_add_epi32(bin.whole, _mm_slli_epi32(_mm_min_epi32(of_row, last_row), kBinBits));
      return pairsAt(prices, _mm_and_si128(at, known), bin.off);
    };
    const auto [a, b] = nodes(row.whole);
    const auto [c, d] = nodes(_mm_sub_epi32(row.whole, row.off));
    const __m128 free = _mm_and_ps(_mm_and_ps(_mm_cmplt_ps(a, no_cost), _mm_cmplt_ps(b, no_cost)),
                                   _mm_and_ps(_mm_cmplt_ps(c, no_cost), _mm_cmplt_ps(d, no_cost)));
    const __m128 allowed_ps = _mm_and_ps(free, _mm_castsi128_ps(known));
    const __m128 below = _mm_add_ps(a, _mm_mul_ps(bin.share, _mm_sub_ps(b, a))),
                 above = _mm_add_ps(c, _mm_mul_ps(bin.share, _mm_sub_ps(d, c)));
    const __m128 price = _mm_blendv_ps(
        no_cost, _mm_add_ps(below, _mm_mul_ps(row.share, _mm_sub_ps(above, below))), allowed_ps);
    _mm_storeu_ps(paid + i,
                  _mm_add_ps(_mm_set1_ps(here), _mm_mul_ps(price, _mm_loadu_ps(motions.length + i))));
  }
}
#else
constexpr auto pricesByVector = pricesByScalar;
#endif

// Largest steepness up to which the curve and the limits allow every heading.
double freeUpTo(const TravelCost& cost, const TravelCurve& curve) noexcept {
  double reach = std::min(
      {cost.limits().max_along, cost.limits().max_across, TravelCurve::gradient(TravelCurve::kBins - 1)});
  for (int row = 0; row <= curve.lastRow(); ++row)
    for (int bin = 0; bin < TravelCurve::kBins; ++bin) {
      if (curve.rows()[row * TravelCurve::kBins + bin] < kNoCost) continue;
      // The smallest gradient that reads this node, or slightly less.
      const double along = (std::abs(bin - TravelCurve::kBins / 2) - 1) / 256.0;
      const double across = (row - 1.0) / TravelCurve::kRowsPerUnit;
      reach = std::min(reach, row > 0 ? std::hypot(std::max(along, 0.0), across) : along);
    }
  return reach;
}

}  // namespace

EdgeSpot edgeSpot(int side, int k, int points) noexcept {
  const double t = (k + 0.5) / points;
  switch (side) {
    case kWestSide:
      return {0.0, t};
    case kEastSide:
      return {1.0, t};
    case kSouthSide:
      return {t, 0.0};
    default:
      return {t, 1.0};
  }
}

EdgeCrossings::EdgeCrossings(const TravelCost& cost, int points, Kernels kernels)
    : cost_(cost),
      points_(points),
      padded_((3 * points + kVector - 1) / kVector * kVector),
      vectors_(vectorsRun(kernels)) {
  for (const TravelCurve& curve : cost.curves()) free_up_to_.push_back(freeUpTo(cost, curve));
  const auto add = [this](End end, double x, double y, double length) {
    ends_.push_back(end);
    x_.push_back(x * CellCode::kStep);
    y_.push_back(y * CellCode::kStep);
    length_.push_back(static_cast<float>(length));
  };
  for (int side = 0; side < 4; ++side)
    for (int k = 0; k < points; ++k) {
      const EdgeSpot a = edgeSpot(side, k, points);
      for (int to = 0; to < 4; ++to)
        for (int l = 0; l < points && to != side; ++l) {
          const EdgeSpot b = edgeSpot(to, l, points);
          const double dx = b.x - a.x, dy = b.y - a.y, length = std::sqrt(dx * dx + dy * dy);
          add({to, l}, dx / length, dy / length, length);
        }
      for (int idle = count(); idle < padded_; ++idle) add({side, k}, 1.0, 0.0, 1.0);
    }
}

void EdgeCrossings::prices(int side, int k, CellCode cell, float here, float* paid) const noexcept {
  const std::size_t at = first(side, k);
  const Motions motions{&x_[at], &y_[at], &length_[at]};
  (vectors_ ? pricesByVector : pricesByScalar)(cost_, cell, here, motions, count(), paid);
}

bool EdgeCrossings::allowed(int side, int k, int i, CellCode cell) const noexcept {
  const std::size_t at = first(side, k) + static_cast<std::size_t>(i);
  return HeadingCost(cost_, x_[at], y_[at])(cell) < kNoCost;
}

bool EdgeCrossings::free(CellCode cell) const noexcept {
  if (cell.curve() >= cost_.curves().size()) return false;
  const double x = cell.dzDx(), y = cell.dzDy(), reach = free_up_to_[cell.curve()];
  return x * x + y * y <= reach * reach;
}

}  // namespace talus::planner
