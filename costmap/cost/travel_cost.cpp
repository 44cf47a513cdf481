#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include <talus/common/constants.hpp>
#include <talus/costmap/cost/travel_cost.hpp>
#include <talus/terramech/mobility/rover_stance.hpp>
#include <talus/terramech/mobility/slope_equilibrium.hpp>

namespace talus::costmap {

std::int16_t CellCode::quantised(double gradient) noexcept {
  const double steps = std::clamp(std::round(gradient / kStep), -2048.0, 2047.0);
  return static_cast<std::int16_t>(std::isnan(steps) ? 0.0 : steps);
}

int TravelCurve::bin(double gradient) noexcept {
  return static_cast<int>(std::lround(gradient * kBinsPerUnit)) + kBins / 2;
}

namespace {

terramech::Gradient seenBy(CellCode cell, Direction heading) noexcept {
  return {cell.dzDx() * heading.x + cell.dzDy() * heading.y,
          cell.dzDy() * heading.x - cell.dzDx() * heading.y};
}

std::vector<TravelCurve> curvesOf(const std::vector<GroundCost>& grounds) {
  std::vector<TravelCurve> curves;
  for (const GroundCost& ground : grounds) curves.push_back(ground.curve);
  return curves;
}

// Gradient up to which no heading tips: tan(stability margin on level ground).
double steadyGradient(const terramech::RoverStance* stance) {
  const double margin_rad = stance ? stance->stabilityMargin_rad({}) : kInfinity;
  return margin_rad < 0.5 * std::numbers::pi ? std::tan(margin_rad) : kInfinity;
}

}  // namespace

TravelCost::TravelCost(const Limits& limits, std::vector<TravelCurve> curves)
    : limits_(limits),
      curves_(std::move(curves)),
      states_(curves_.size()),
      turns_(curves_.size()),
      steady_gradient_(steadyGradient(limits.stance.get())) {
  if (curves_.size() > CellCode::kUnknown)
    throw std::invalid_argument("DriveCost: " + std::to_string(curves_.size()) +
                                " drive curves, must be <= 65534");
}

TravelCost::TravelCost(const Limits& limits, const std::vector<GroundCost>& grounds,
                       SoilUncertainty uncertainty)
    : TravelCost(limits, curvesOf(grounds)) {
  uncertainty_ = std::move(uncertainty);
  for (std::size_t i = 0; i < grounds.size(); ++i) {
    states_[i] = grounds[i].states;
    turns_[i] = grounds[i].turns;
  }
}

float TravelCost::costPerMetre(CellCode cell, Direction heading) const noexcept {
  constexpr float blocked = std::numeric_limits<float>::infinity();
  if (cell.curve() >= curves_.size()) return blocked;
  const terramech::Gradient d = seenBy(cell, heading);
  if (std::abs(d.along) > limits_.max_along || std::abs(d.across) > limits_.max_across) return blocked;
  return curves_[cell.curve()].price(d.along, d.across);
}

bool TravelCost::tips(CellCode cell, Direction heading) const noexcept {
  return mayTip(cell) && limits_.stance->stabilityMargin_rad(demandOf(seenBy(cell, heading))) < 0.0;
}

bool TravelCost::mayTip(CellCode cell) const noexcept {
  return cell.dzDx() * cell.dzDx() + cell.dzDy() * cell.dzDy() > steady_gradient_ * steady_gradient_;
}

}  // namespace talus::costmap
