#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include <talus/planner/check/route_check.hpp>
#include <talus/planner/route/heading_set.hpp>

namespace talus::planner {

class CellJudge::Headings {
 public:
  explicit Headings(const costmap::TravelCost& cost) : allowed(cost) {
    constexpr int kHeadings = 64;
    for (int k = 0; k < kHeadings; ++k) {
      const double heading_rad = k * HeadingSet::kTurn / kHeadings;
      costs.emplace_back(cost, costmap::Direction{std::cos(heading_rad), std::sin(heading_rad)});
    }
  }

  HeadingSets allowed;
  std::vector<HeadingCost> costs;
};

CellJudge::CellJudge(std::shared_ptr<const costmap::TravelCost> cost)
    : cost_(std::move(cost)), level_J_per_m_(std::numeric_limits<float>::infinity()) {
  if (!cost_) throw std::invalid_argument("CellJudge: needs a drive cost");
  for (const costmap::TravelCurve& curve : cost_->curves())
    level_J_per_m_ = std::min(level_J_per_m_, curve.price(0.0, 0.0));
  headings_ = std::make_unique<Headings>(*cost_);
}

CellJudge::~CellJudge() = default;

CellJudgement CellJudge::of(costmap::CellCode cell) {
  using Kind = CellJudgement::Kind;
  if (cell.curve() == costmap::CellCode::kUnknown) return {.kind = Kind::Unknown};
  const HeadingSet& allowed = headings_->allowed.of(cell);
  if (allowed.empty()) return {.kind = Kind::Refused};
  if (!allowed.all()) return {.kind = Kind::Restricted};
  float highest = 0.0F;
  for (const HeadingCost& cost : headings_->costs) highest = std::max(highest, cost(cell));
  // A single refused heading, within the rounding by which allowed arcs are widened.
  if (!std::isfinite(highest)) return {.kind = Kind::Restricted};
  return {.kind = Kind::Open, .highest_J_per_m = highest};
}

}  // namespace talus::planner
