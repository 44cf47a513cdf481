#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <talus/costmap/cost/travel_states.hpp>
#include <talus/costmap/ground/category_table.hpp>

namespace talus::costmap {
namespace {

using terramech::Category;

constexpr int kJudgedHeadings =
    24;                       // headings over 180 degrees, as SlopeLattice::steepest(): left and right are
                              // symmetric
constexpr int kSteps = 2898;  // greatest gradient of CellCode in steps: 2048 sqrt(2)

// True if the reason for the refusal depends on the uncertain pull of the ground.
bool isOfSoil(Refusal refusal) {
  return refusal == Refusal::Pull || refusal == Refusal::SideForce;
}

CategoryTable::Entry entryOf(const RankedCategory& ranked) {
  // Rounded to the nearest step for dangerous ground, else down: the probability of better ground is never
  // overstated.
  const double steps = 16.0 * ranked.probability;
  const double rounded = ranked.category == Category::Dangerous ? std::round(steps) : std::floor(steps);
  return {static_cast<std::uint8_t>(ranked.category), static_cast<std::uint8_t>(rounded)};
}

// Increases `climb` until the model's category is at least `least`, and returns that category.
RankedCategory atLeast(const GroundModel& model, const GroundBelief& belief, Category least, double climb) {
  RankedCategory ranked = model.category(belief, climb);
  while (ranked.category < least && climb < 4.0)
    ranked = model.category(belief, climb += 1.0 / TravelCurve::kBinsPerUnit);
  return ranked;
}

CellCode planeOf(int step) {
  return CellCode({.dz_dx = step * CellCode::kStep, .dz_dy = 0.0, .curve = 0});
}

// State in the worst heading, with the worst category over all headings.
TravelState stateOn(const TravelCost& cost, CellCode plane) {
  TravelState state = cost.detail(plane, worstHeading(cost, plane));
  for (int k = 0; k < kJudgedHeadings; ++k) {
    const double heading = k * std::numbers::pi / kJudgedHeadings;
    state.category =
        std::max(state.category, cost.detail(plane, {std::cos(heading), std::sin(heading)}).category);
  }
  return state;
}

}  // namespace

Direction worstHeading(const TravelCost& cost, CellCode cell) noexcept {
  const double length = std::hypot(cell.dzDx(), cell.dzDy());
  if (!(length > 0.0)) return {};
  const Direction up{cell.dzDx() / length, cell.dzDy() / length};
  constexpr double kClearly = 1.0 / 32.0;  // gradient difference of two rows
  Direction found = up;
  double most = cost.climb(cell, up) + kClearly;
  for (int k = 1; k < kJudgedHeadings; ++k) {
    const double c = std::cos(k * std::numbers::pi / kJudgedHeadings),
                 s = std::sin(k * std::numbers::pi / kJudgedHeadings);
    const Direction tried{c * up.x - s * up.y, s * up.x + c * up.y};
    if (const double climb = cost.climb(cell, tried); climb > most) {
      most = climb;
      found = tried;
    }
  }
  return found;
}

RankedCategory judged(const GroundModel& model, const GroundBelief& belief, const TravelState& state,
                      double climb) {
  const RankedCategory ranked = atLeast(model, belief, state.category, climb);
  const bool driven = state.refusal == Refusal::None || state.refusal == Refusal::Category;
  if (driven || ranked.category == Category::Dangerous) return ranked;
  return {Category::Dangerous, isOfSoil(state.refusal) ? static_cast<double>(state.weak) : 1.0};
}

CategoryTable::CategoryTable(const GroundModel& model, const GroundBelief& belief, const GroundCost& ground) {
  TravelCost::Limits limits = model.limits();
  limits.stance.reset();  // only TravelCost::tips() needs the stance
  const TravelCost cost(limits, std::vector{ground});
  const auto judgedAt = [&](int step) {
    return judged(model, belief, stateOn(cost, planeOf(step)),
                  ground.states->steepest(step * CellCode::kStep));
  };
  // First step with a category at least `least`, by bisection: categories are monotone in the gradient.
  const auto boundOf = [&](Category least) {
    int from = 0;
    for (int beyond = kSteps - 1; from < beyond;) {
      const int middle = (from + beyond) / 2;
      if (judgedAt(middle).category < least)
        from = middle + 1;
      else
        beyond = middle;
    }
    return std::pair(from, judgedAt(from));
  };
  const std::array bounds{boundOf(Category::Marginal), boundOf(Category::Dangerous)};
  entries_.reserve(kSteps);
  for (int step = 0; step < kSteps; ++step) {
    RankedCategory now = model.category(belief, ground.states->steepest(step * CellCode::kStep));
    for (const auto& [from, ranked] : bounds)
      if (step >= from && now.category < ranked.category) now = ranked;
    entries_.push_back(entryOf(now));
  }
}

CategoryTable::Entry CategoryTable::at(CellCode cell) const noexcept {
  if (entries_.empty()) return {static_cast<std::uint8_t>(Category::Dangerous), 16};
  const auto x = static_cast<float>(cell.stepsX()), y = static_cast<float>(cell.stepsY());
  return entries_[static_cast<std::size_t>(std::ceil(std::sqrt(x * x + y * y)))];
}

}  // namespace talus::costmap
