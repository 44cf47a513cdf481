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

EdgeUnits::EdgeUnits(const DriveCost& cost, double resolution_m, double coarsening)
    : curves_(cost.curves().size()) {
  const CostRange range = costRange(cost);
  unit_J_ = unitFor(range, resolution_m) * coarsening;
  across_straight_ = stepsWithin(cost.limits().max_across, 1.0);
  across_diagonal_ = stepsWithin(cost.limits().max_across, kDiagonal);
  const int straight_reach = stepsWithin(cost.limits().max_along, 1.0);
  reach_ = stepsWithin(cost.limits().max_along, kDiagonal);
  const double straight_units = 0.5 * resolution_m / unit_J_,
               diagonal_units = straight_units * std::numbers::sqrt2;
  for (const auto& curve : cost.curves())
    for (int steps = -reach_; steps <= reach_; ++steps) {
      const auto at = [&](double per_step) {
        const long bin =
            std::lround(steps * per_step * CellCode::kStep * 256.0) + costmap::DriveCurve::kBins / 2;
        return bin >= 0 && bin < costmap::DriveCurve::kBins
                   ? curve.cost_J_per_m[static_cast<std::size_t>(bin)]
                   : kInfinite;
      };
      straight_.push_back(inUnits(std::abs(steps) <= straight_reach ? at(1.0) : kInfinite, straight_units));
      diagonal_.push_back(inUnits(at(kDiagonal), diagonal_units));
    }
  const auto append_pairs = [this](const std::vector<std::uint16_t>& halves) {
    const auto row = static_cast<std::size_t>(2 * reach_ + 1);
    for (std::size_t i = 0; i < halves.size(); ++i) {
      const std::size_t opposite = i / row * row + (row - 1 - i % row);
      pairs_.push_back(halves[i] | static_cast<std::uint32_t>(halves[opposite]) << 16);
    }
  };
  append_pairs(straight_);
  append_pairs(diagonal_);
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
  const int row = 2 * reach_ + 1, diagonals = static_cast<int>(straight_.size());
  const __m128i blocked = _mm_set1_epi32(-1), reach = _mm_set1_epi32(reach_);
  const __m128i across_limit =
      _mm_setr_epi32(across_straight_, across_diagonal_, across_straight_, across_diagonal_);
  const __m128i level = _mm_setr_epi32(0, diagonals, 0, diagonals);
  const __m128i headings_first = _mm_setr_epi8(0, 1, 4, 5, 8, 9, 12, 13, 2, 3, 6, 7, 10, 11, 14, 15);
  const int* pairs = reinterpret_cast<const int*>(pairs_.data());
  for (std::size_t i = 0; i < count; ++i) {
    const CellCode cell = cells[i];
    __m128i made = blocked;
    if (cell.curve() < curves_) {
      const int x = cell.stepsX(), y = cell.stepsY();
      const __m128i along = _mm_setr_epi32(x, x + y, y, y - x), across = _mm_setr_epi32(y, y - x, x, x + y);
      const __m128i refused = _mm_or_si128(_mm_cmpgt_epi32(_mm_abs_epi32(across), across_limit),
                                           _mm_cmpgt_epi32(_mm_abs_epi32(along), reach));
      const __m128i at =
          _mm_add_epi32(_mm_add_epi32(along, level), _mm_set1_epi32(cell.curve() * row + reach_));
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
  const auto begins = [](const std::vector<std::uint16_t>& longer,
                         const std::vector<std::uint16_t>& shorter) {
    return longer.size() >= shorter.size() && std::equal(shorter.begin(), shorter.end(), longer.begin());
  };
  return unit_J_ == older.unit_J_ && reach_ == older.reach_ && across_straight_ == older.across_straight_ &&
         across_diagonal_ == older.across_diagonal_ && cheapest_edge_ == older.cheapest_edge_ &&
         begins(straight_, older.straight_) && begins(diagonal_, older.diagonal_);
}

}  // namespace talus::planner
