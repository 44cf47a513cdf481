#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include <talus/common/common.hpp>
#include <talus/costmap/cost/cost_model.hpp>
#include <talus/terramech/mobility/slope_equilibrium.hpp>
#include <talus/terramech/mobility/turning.hpp>

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

// Computes the state from which the cost of a metre follows. This file is separate from travel_cost.cpp,
// which does not depend on the construction of curves.

namespace {

terramech::Gradient gradientSeen(CellCode cell, Direction heading) noexcept {
  return {cell.dzDx() * heading.x + cell.dzDy() * heading.y,
          cell.dzDy() * heading.x - cell.dzDx() * heading.y};
}

TravelState refused(Refusal reason) noexcept {
  TravelState state;
  state.refusal = reason;
  return state;
}

// Interpolates between the nodes that TravelCurve::price() reads.
TravelState stateAt(const TravelStates& states, double place, double across) noexcept {
  const auto bin = TravelCurve::between(place),
             row = TravelCurve::between(std::abs(across) * TravelCurve::kRowsPerUnit);
  const auto inRow = [&](int at) {
    const TravelState here = states.at(at, bin.whole);
    return bin.share > 0.0F ? between(here, states.at(at, bin.whole + 1), bin.share) : here;
  };
  const TravelState below = inRow(row.whole);
  return row.share > 0.0F ? between(below, inRow(row.whole + 1), row.share) : below;
}

}  // namespace

TravelState TravelCost::detail(CellCode cell, Direction heading) const noexcept {
  if (cell.curve() == CellCode::kBlocked) return refused(Refusal::Blocked);
  if (cell.curve() >= curves_.size()) return refused(Refusal::Unknown);
  const terramech::Gradient d = gradientSeen(cell, heading);
  const double place = d.along * TravelCurve::kBinsPerUnit + TravelCurve::kBins / 2;
  const double inside = std::clamp(place, 0.0, TravelCurve::kBins - 1.5);
  const TravelStates* states = statesOf(cell);
  TravelState state = states ? stateAt(*states, inside, d.across) : TravelState{};
  if (std::abs(d.across) > limits_.max_across) state.refusal = Refusal::Roll;
  if (std::abs(d.along) > limits_.max_along || !(place >= 0.0 && place < TravelCurve::kLastPlace))
    state.refusal = Refusal::Pitch;
  return state;
}

SlopeHold TravelCost::hold(CellCode cell, Direction heading) const noexcept {
  const TravelStates* states = statesOf(cell);
  return states ? states->hold(gradientSeen(cell, heading)) : SlopeHold{};
}

TravelForecast TravelCost::forecast(CellCode cell, Direction heading) const noexcept {
  const TravelStates* states = statesOf(cell);
  return states ? states->forecast(gradientSeen(cell, heading)) : TravelForecast{};
}

double TravelCost::climb(CellCode cell, Direction heading) const noexcept {
  const terramech::Gradient d = gradientSeen(cell, heading);
  const TravelStates* states = statesOf(cell);
  return states ? states->climb(d) : d.along;
}

const char* toText(Refusal refusal) noexcept {
  switch (refusal) {
    case Refusal::None:
      return "allowed";
    case Refusal::Unknown:
      return "unobserved cell";
    case Refusal::Blocked:
      return "blocked for any heading";
    case Refusal::Pitch:
      return "slope along the heading above the pitch limit";
    case Refusal::Roll:
      return "slope across the heading above the roll limit";
    case Refusal::Pull:
      return "required drawbar pull above the available drawbar pull";
    case Refusal::SideForce:
      return "required side force above the available side force";
    case Refusal::Torque:
      return "required torque above the motor limit";
    case Refusal::Sinkage:
      return "sinkage above the ground clearance";
    case Refusal::Category:
      return "category at this slope excluded by the policy";
    case Refusal::Tips:
      return "tips: centre of mass past the wheels";
  }
  return "";
}

TravelState worse(const TravelState& a, const TravelState& b) noexcept {
  const auto farther = [](float x, float y) { return std::abs(x) < std::abs(y) ? y : x; };
  return {.slip = farther(a.slip, b.slip),
          .sinkage_m = std::max(a.sinkage_m, b.sinkage_m),
          .torque_Nm = farther(a.torque_Nm, b.torque_Nm),
          .energy_J_per_m = std::max(a.energy_J_per_m, b.energy_J_per_m),
          .time_s_per_m = std::max(a.time_s_per_m, b.time_s_per_m),
          .risk_per_m = std::max(a.risk_per_m, b.risk_per_m),
          .weak = std::max(a.weak, b.weak),
          .pull_margin = std::min(a.pull_margin, b.pull_margin),
          .category = std::max(a.category, b.category),
          .refusal = a.refusal != Refusal::None ? a.refusal : b.refusal,
          .class_index = a.class_index};
}

TravelState between(const TravelState& a, const TravelState& b, float share) noexcept {
  TravelState out = a;
  for (const auto number :
       {&TravelState::slip, &TravelState::sinkage_m, &TravelState::torque_Nm, &TravelState::energy_J_per_m,
        &TravelState::time_s_per_m, &TravelState::risk_per_m, &TravelState::weak, &TravelState::pull_margin})
    out.*number = a.*number + share * (b.*number - a.*number);
  out.category = std::max(a.category, b.category);
  if (out.refusal == Refusal::None || b.refusal == Refusal::Tips) out.refusal = b.refusal;
  return out;
}

}  // namespace talus::costmap
