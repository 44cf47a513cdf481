#include <algorithm>
#include <cmath>

#include <talus/costmap/cost/travel_states.hpp>

// Computes the state from which the cost of a metre follows. This file is separate from travel_cost.cpp,
// which does not depend on the construction of curves.
namespace talus::costmap {
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

}  // namespace talus::costmap
