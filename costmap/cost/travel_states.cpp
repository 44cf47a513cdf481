#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include <talus/costmap/cost/travel_states.hpp>

namespace talus::costmap {

TabulatedStates::TabulatedStates(std::vector<TravelState> states) : states_(std::move(states)) {
  if (states_.size() != TravelCurve::kBins)
    throw std::invalid_argument("travel states: " + std::to_string(states_.size()) + " states, must be " +
                                std::to_string(TravelCurve::kBins));
}

TravelState TabulatedStates::at(int, int bin) const {
  return states_[static_cast<std::size_t>(bin)];
}

TravelCurve TabulatedStates::curve(const CostWeights& weights) const {
  TravelCurve curve;
  for (std::size_t bin = 0; bin < states_.size(); ++bin) {
    const TravelState& s = states_[bin];
    curve.cost_J_per_m[bin] =
        s.refusal == Refusal::None
            ? static_cast<float>(weights.energy * static_cast<double>(s.energy_J_per_m) +
                                 weights.time_W * static_cast<double>(s.time_s_per_m) +
                                 weights.risk_J * static_cast<double>(s.risk_per_m))
            : std::numeric_limits<float>::infinity();
  }
  return curve;
}

TravelForecast TabulatedStates::forecast(const terramech::Gradient& gradient) const {
  const auto place = TravelCurve::between(std::clamp(
      gradient.along * TravelCurve::kBinsPerUnit + TravelCurve::kBins / 2, 0.0, TravelCurve::kLastPlace));
  const TravelState here = at(0, place.whole),
                    state = place.share > 0.0F ? between(here, at(0, place.whole + 1), place.share) : here;
  TravelForecast out;
  out.energy_J_per_m.fill(state.energy_J_per_m);
  out.time_s_per_m.fill(state.time_s_per_m);
  return out;
}

}  // namespace talus::costmap
