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
  reach_ = std::max(bin(straight_, straight_.along), bin(diagonal_, diagonal_.along));
  const double straight_units = 0.5 * resolution_m / unit_J_;
  const int width = 2 * reach_ + 1;
  std::vector<std::uint16_t> halves(static_cast<std::size_t>(width));
  for (const auto& curve : cost.curves()) {
    first_.push_back(static_cast<std::int32_t>(pairs_.size()));
    last_row_.push_back(std::min(curve.lastRow(), row(straight_, straight_.across)));
    for (int row = 0; row <= last_row_.back(); ++row)
      for (const double units : {straight_units, straight_units * std::numbers::sqrt2}) {
        for (int i = 0; i < width; ++i) {
          const int bin = i - reach_ + DriveCurve::kBins / 2;
          const bool inside = bin >= 0 && bin < DriveCurve::kBins;
          halves[static_cast<std::size_t>(i)] =
              inUnits(inside ? curve.rows()[row * DriveCurve::kBins + bin] : kInfinite, units);
        }
        for (std::size_t i = 0; i < halves.size(); ++i)
          pairs_.push_back(halves[i] | static_cast<std::uint32_t>(halves[halves.size() - 1 - i]) << 16);
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
// Four lanes: the headings from east to north-west, each with its opposite.
__attribute__((target("avx2"))) void EdgeUnits::halvesByVector(const CellCode* cells, std::size_t count,
                                                               Halves* out) const noexcept {
  const int width = 2 * reach_ + 1;
  const __m128i blocked = _mm_set1_epi32(-1), width_twice = _mm_set1_epi32(2 * width);
  const __m128i most_along =
                    _mm_setr_epi32(straight_.along, diagonal_.along, straight_.along, diagonal_.along),
                most_across =
                    _mm_setr_epi32(straight_.across, diagonal_.across, straight_.across, diagonal_.across);
  const __m256d bins = _mm256_setr_pd(straight_.bins, diagonal_.bins, straight_.bins, diagonal_.bins),
                rows = _mm256_setr_pd(straight_.rows, diagonal_.rows, straight_.rows, diagonal_.rows),
                half = _mm256_set1_pd(0.5), same = _mm256_set1_pd(DriveCurve::kSame);
  const __m128i shift = _mm_setr_epi32(reach_, reach_ + width, reach_, reach_ + width);
  const __m128i headings_first = _mm_setr_epi8(0, 1, 4, 5, 8, 9, 12, 13, 2, 3, 6, 7, 10, 11, 14, 15);
  const int* pairs = reinterpret_cast<const int*>(pairs_.data());
  for (std::size_t i = 0; i < count; ++i) {
    const CellCode cell = cells[i];
    __m128i made = blocked;
    if (cell.curve() < first_.size()) {
      const int x = cell.stepsX(), y = cell.stepsY();
      const __m128i along = _mm_setr_epi32(x, x + y, y, y - x),
                    across = _mm_abs_epi32(_mm_setr_epi32(y, y - x, x, x + y)), size = _mm_abs_epi32(along);
      const __m128i refused =
          _mm_or_si128(_mm_cmpgt_epi32(across, most_across), _mm_cmpgt_epi32(size, most_along));
      const __m128i bin = _mm_sign_epi32(
          _mm256_cvttpd_epi32(_mm256_add_pd(_mm256_mul_pd(_mm256_cvtepi32_pd(size), bins), half)), along);
      const __m128i row = _mm_min_epi32(_mm256_cvttpd_epi32(_mm256_ceil_pd(_mm256_sub_pd(
                                            _mm256_mul_pd(_mm256_cvtepi32_pd(across), rows), same))),
                                        _mm_set1_epi32(last_row_[cell.curve()]));
      const __m128i at = _mm_add_epi32(
          _mm_add_epi32(bin, shift),
          _mm_add_epi32(_mm_mullo_epi32(row, width_twice), _mm_set1_epi32(first_[cell.curve()])));
      made = _mm_mask_i32gather_epi32(blocked, pairs, at, _mm_andnot_si128(refused, blocked), 4);
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
