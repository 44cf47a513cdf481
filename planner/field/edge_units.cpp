#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include <talus/planner/field/cost_range.hpp>
#include <talus/planner/field/edge_units.hpp>

namespace talus::planner {
namespace {

using costmap::CellCode;
using costmap::DriveCost;
using costmap::DriveCurve;

constexpr double kDiagonal = std::numbers::sqrt2 / 2;
constexpr float kInfinite = std::numeric_limits<float>::infinity();

// Joules of a unit: fine enough that the dearest diagonal half just fits, but the cheapest straight half is
// kept between 32 and 2048 units: coarser would spoil the search, finer would overflow 32 bits along a
// route.
double unitFor(const CostRange& range, double resolution_m) {
  if (!(range.most_J_per_m > 0.0)) return 1.0;
  const double least = std::max(range.least_J_per_m, range.most_J_per_m * 1e-6);
  const double cheapest_J = 0.5 * resolution_m * least;
  const double fitting = EdgeUnits::kDearest / (std::numbers::sqrt2 * range.most_J_per_m / least);
  return cheapest_J / std::clamp(fitting, 32.0, 2048.0);
}

std::uint16_t inUnits(float cost_J_per_m, double units_per_J_per_m) {
  if (!std::isfinite(cost_J_per_m)) return EdgeUnits::kBlocked;
  const double units = std::round(static_cast<double>(cost_J_per_m) * units_per_J_per_m);
  return static_cast<std::uint16_t>(std::clamp(units, 1.0, static_cast<double>(EdgeUnits::kDearest)));
}

// Most steps whose gradient stays within the limit. A diagonal's stays clear of it by more than rounding
// does, so that what the grid allows is allowed to the exact segment too.
int stepsWithin(double limit, double per_step) {
  const int most = 2 * 2048;
  const double clear = per_step == 1.0 ? limit : limit - 1e-9;
  int steps = 0;
  while (steps < most && (steps + 1) * per_step * CellCode::kStep <= clear) ++steps;
  return steps;
}

}  // namespace

EdgeUnits::EdgeUnits(const DriveCost& cost, double resolution_m, double coarsening) {
  const CostRange range = costRange(cost);
  const auto& limits = cost.limits();
  unit_J_ = unitFor(range, resolution_m) * coarsening;
  const auto scale = [&limits](double per_step) {
    return Scale{.bins = per_step / 4.0,
                 .rows = per_step / 16.0,
                 .along = stepsWithin(limits.max_along, per_step),
                 .across = stepsWithin(limits.max_across, per_step)};
  };
  straight_ = scale(1.0);
  diagonal_ = scale(kDiagonal);
  const auto most = [](double a, double b) { return static_cast<int>(std::ceil(std::max(a, b))); };
  reach_ = most(straight_.along * straight_.bins, diagonal_.along * diagonal_.bins);
  const int rows = most(straight_.across * straight_.rows, diagonal_.across * diagonal_.rows);
  const double straight_units = 0.5 * resolution_m / unit_J_;
  std::vector<std::uint16_t> halves(static_cast<std::size_t>(2 * reach_ + 1));
  for (const auto& curve : cost.curves()) {
    first_.push_back(static_cast<std::int32_t>(pairs_.size()));
    last_row_.push_back(std::min(curve.lastRow(), rows));
    for (int row = 0; row <= last_row_.back(); ++row)
      for (const double units : {straight_units, straight_units * std::numbers::sqrt2}) {
        for (std::size_t i = 0; i < halves.size(); ++i) {
          const int bin = static_cast<int>(i) - reach_ + DriveCurve::kBins / 2;
          const bool inside = bin >= 0 && bin < DriveCurve::kBins;
          halves[i] = inUnits(inside ? curve.rows()[row * DriveCurve::kBins + bin] : kInfinite, units);
        }
        for (std::size_t i = 0; i < halves.size(); ++i)
          pairs_.push_back(halves[i] | static_cast<std::uint32_t>(halves[halves.size() - 1 - i]) << 16);
        pairs_.push_back(~std::uint32_t{0});
      }
  }
  cheapest_edge_ = std::isfinite(range.least_J_per_m)
                       ? std::max(2U, 2U * static_cast<unsigned>(inUnits(
                                               static_cast<float>(range.least_J_per_m), straight_units)))
                       : 1U;
}

void EdgeUnits::halves(const CellCode* cells, std::size_t count, Halves* out,
                       bool by_vectors) const noexcept {
  if (by_vectors) return halvesByVector(cells, count, out);
  for (std::size_t i = 0; i < count; ++i) out[i] = halves(cells[i]);
}

#if defined(__x86_64__)
namespace {

// Places of four lanes between nodes, as EdgeUnits::between().
struct Betweens {
  __m128i whole, share;
};
__attribute__((target("avx2"))) inline Betweens betweens(__m256d place, int shares) noexcept {
  const __m256d same = _mm256_set1_pd(DriveCurve::kSame);
  const __m128i whole = _mm256_cvttpd_epi32(_mm256_add_pd(place, same));
  const __m256d rest = _mm256_sub_pd(place, _mm256_cvtepi32_pd(whole));
  const __m128i nearest =
      _mm256_cvttpd_epi32(_mm256_add_pd(_mm256_mul_pd(rest, _mm256_set1_pd(shares)), _mm256_set1_pd(0.5)));
  const __m128i share = _mm_min_epi32(_mm_max_epi32(nearest, _mm_set1_epi32(1)), _mm_set1_epi32(shares - 1));
  const __m256i evens = _mm256_setr_epi32(0, 2, 4, 6, 0, 2, 4, 6);
  const __m256d off = _mm256_cmp_pd(rest, same, _CMP_GT_OQ);
  return {whole, _mm_and_si128(share, _mm256_castsi256_si128(
                                          _mm256_permutevar8x32_epi32(_mm256_castpd_si256(off), evens)))};
}

// Two weights of 16 bits in each lane, twice.
__attribute__((target("avx2"))) inline __m256i twice(__m128i first, __m128i second) noexcept {
  const __m256i both = _mm256_cvtepu32_epi64(_mm_or_si128(first, _mm_slli_epi32(second, 16)));
  return _mm256_or_si256(both, _mm256_slli_epi64(both, 32));
}

}  // namespace

// Four lanes: the headings from east to north-west, each with its opposite.
__attribute__((target("avx2"))) void EdgeUnits::halvesByVector(const CellCode* cells, std::size_t count,
                                                               Halves* out) const noexcept {
  const __m128i blocked = _mm_set1_epi32(-1), width_twice = _mm_set1_epi32(2 * width()),
                whole_share = _mm_set1_epi32(kShares), one = _mm_set1_epi32(1);
  const __m128i most_along =
                    _mm_setr_epi32(straight_.along, diagonal_.along, straight_.along, diagonal_.along),
                most_across =
                    _mm_setr_epi32(straight_.across, diagonal_.across, straight_.across, diagonal_.across);
  const __m256d bins = _mm256_setr_pd(straight_.bins, diagonal_.bins, straight_.bins, diagonal_.bins),
                rows = _mm256_setr_pd(straight_.rows, diagonal_.rows, straight_.rows, diagonal_.rows),
                reach = _mm256_set1_pd(reach_);
  const __m128i shift = _mm_setr_epi32(0, width(), 0, width());
  const __m128i headings_first = _mm_setr_epi8(0, 1, 4, 5, 8, 9, 12, 13, 2, 3, 6, 7, 10, 11, 14, 15);
  // From (ahead, back) of a node and of the next one to both ahead, both back.
  const __m256i by_direction = _mm256_setr_epi8(0, 1, 4, 5, 2, 3, 6, 7, 8, 9, 12, 13, 10, 11, 14, 15, 0, 1, 4,
                                                5, 2, 3, 6, 7, 8, 9, 12, 13, 10, 11, 14, 15);
  const __m256i none = _mm256_setzero_si256(), half = _mm256_set1_epi32(1 << (2 * kShareBits - 1));
  const auto* pairs = reinterpret_cast<const long long*>(pairs_.data());
  for (std::size_t i = 0; i < count; ++i) {
    const CellCode cell = cells[i];
    __m128i made = blocked;
    if (cell.curve() < first_.size()) {
      const int x = cell.stepsX(), y = cell.stepsY();
      const __m128i along = _mm_setr_epi32(x, x + y, y, y - x),
                    across = _mm_abs_epi32(_mm_setr_epi32(y, y - x, x, x + y));
      const __m128i refused = _mm_or_si128(_mm_cmpgt_epi32(across, most_across),
                                           _mm_cmpgt_epi32(_mm_abs_epi32(along), most_along));
      const __m256i refused_twice = _mm256_cvtepi32_epi64(refused),
                    read = _mm256_xor_si256(refused_twice, _mm256_set1_epi32(-1));
      const Betweens bin =
          betweens(_mm256_add_pd(_mm256_mul_pd(_mm256_cvtepi32_pd(along), bins), reach), kShares);
      const Betweens row = betweens(_mm256_mul_pd(_mm256_cvtepi32_pd(across), rows), kShares);
      const __m128i last = _mm_set1_epi32(last_row_[cell.curve()]);
      const __m128i base =
          _mm_add_epi32(_mm_add_epi32(bin.whole, shift), _mm_set1_epi32(first_[cell.curve()]));
      const auto nodes = [&](__m128i of_row) __attribute__((target("avx2"))) {
        const __m128i at = _mm_add_epi32(base, _mm_mullo_epi32(_mm_min_epi32(of_row, last), width_twice));
        return _mm256_shuffle_epi8(_mm256_mask_i32gather_epi64(none, pairs, at, read, 4), by_direction);
      };
      const __m256i low = nodes(row.whole), high = nodes(_mm_add_epi32(row.whole, one));
      const __m128i left = _mm_sub_epi32(whole_share, bin.share),
                    below = _mm_sub_epi32(whole_share, row.share);
      const __m256i low_weights = twice(_mm_mullo_epi32(left, below), _mm_mullo_epi32(bin.share, below)),
                    high_weights =
                        twice(_mm_mullo_epi32(left, row.share), _mm_mullo_epi32(bin.share, row.share));
      const __m256i sum = _mm256_srli_epi32(
          _mm256_add_epi32(
              _mm256_add_epi32(_mm256_madd_epi16(low, low_weights), _mm256_madd_epi16(high, high_weights)),
              half),
          2 * kShareBits);
      // kBlocked is -1; of weight 0 it counts for nothing.
      const __m256i stops = _mm256_or_si256(
          _mm256_and_si256(_mm256_cmpgt_epi16(none, low), _mm256_cmpgt_epi16(low_weights, none)),
          _mm256_and_si256(_mm256_cmpgt_epi16(none, high), _mm256_cmpgt_epi16(high_weights, none)));
      const __m256i free = _mm256_andnot_si256(refused_twice, _mm256_cmpeq_epi32(stops, none));
      const __m256i priced =
          _mm256_or_si256(_mm256_and_si256(sum, free), _mm256_andnot_si256(free, _mm256_set1_epi32(0xffff)));
      const __m256i packed = _mm256_packus_epi32(priced, priced);
      made = _mm_unpacklo_epi64(_mm256_castsi256_si128(packed), _mm256_extracti128_si256(packed, 1));
    }
    _mm_storeu_si128(reinterpret_cast<__m128i*>(out[i].data()), _mm_shuffle_epi8(made, headings_first));
  }
}
#else
void EdgeUnits::halvesByVector(const CellCode* cells, std::size_t count, Halves* out) const noexcept {
  halves(cells, count, out, false);
}
#endif

bool EdgeUnits::extends(const EdgeUnits& older) const noexcept {
  const auto begins = [](const auto& longer, const auto& shorter) {
    return longer.size() >= shorter.size() && std::equal(shorter.begin(), shorter.end(), longer.begin());
  };
  const auto same = [](const Scale& a, const Scale& b) { return a.along == b.along && a.across == b.across; };
  return unit_J_ == older.unit_J_ && reach_ == older.reach_ && cheapest_edge_ == older.cheapest_edge_ &&
         same(straight_, older.straight_) && same(diagonal_, older.diagonal_) &&
         begins(pairs_, older.pairs_) && begins(first_, older.first_) && begins(last_row_, older.last_row_);
}

}  // namespace talus::planner
