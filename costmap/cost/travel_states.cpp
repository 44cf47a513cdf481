#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include <talus/costmap/cost/cost_model.hpp>

namespace talus::costmap {

TabulatedStates::TabulatedStates(std::vector<TravelState> states) : states_(std::move(states)) {
  if (states_.empty() || states_.size() % TravelCurve::kBins != 0)
    throw std::invalid_argument("travel states: " + std::to_string(states_.size()) +
                                " states, must be a multiple of " + std::to_string(TravelCurve::kBins));
}

TravelState TabulatedStates::at(int row, int bin) const {
  const int last = static_cast<int>(states_.size()) / TravelCurve::kBins - 1;
  return states_[static_cast<std::size_t>(std::min(row, last) * TravelCurve::kBins + bin)];
}

TravelCurve TabulatedStates::curve(const CostWeights& weights) const {
  const auto term = [](double weight, float value) {  // a quantity without a weight may be unknown
    return weight > 0.0 ? weight * static_cast<double>(value) : 0.0;
  };
  std::vector<float> costs;
  for (const TravelState& s : states_)
    costs.push_back(s.refusal == Refusal::None ? static_cast<float>(term(weights.energy, s.energy_J_per_m) +
                                                                    term(weights.time_W, s.time_s_per_m) +
                                                                    term(weights.risk_J, s.risk_per_m))
                                               : std::numeric_limits<float>::infinity());
  TravelCurve curve;
  std::copy_n(costs.begin(), TravelCurve::kBins, curve.cost_J_per_m.begin());
  if (costs.size() > TravelCurve::kBins)
    curve.crossing = std::make_shared<const std::vector<float>>(std::move(costs));
  return curve;
}

TravelForecast TabulatedStates::forecast(const terramech::Gradient& gradient) const {
  const auto place = TravelCurve::between(
                 std::clamp(gradient.along * TravelCurve::kBinsPerUnit + TravelCurve::kBins / 2, 0.0,
                            TravelCurve::kLastPlace)),
             row = TravelCurve::between(std::abs(gradient.across) * TravelCurve::kRowsPerUnit);
  const auto inRow = [&](int k) {
    const TravelState here = at(k, place.whole);
    return place.share > 0.0F ? between(here, at(k, place.whole + 1), place.share) : here;
  };
  const TravelState state =
      row.share > 0.0F ? between(inRow(row.whole), inRow(row.whole + 1), row.share) : inRow(row.whole);
  TravelForecast out;
  out.energy_J_per_m.fill(state.energy_J_per_m);
  out.time_s_per_m.fill(state.time_s_per_m);
  return out;
}

std::shared_ptr<const TravelStates> TabulatedStates::withAdded(double added_J_per_m) const {
  std::vector<TravelState> states = states_;
  for (TravelState& state : states) state.energy_J_per_m += static_cast<float>(added_J_per_m);
  return std::make_shared<const TabulatedStates>(std::move(states));
}

std::shared_ptr<const TravelStates> statedStates(
    const std::function<double(const terramech::Gradient&)>& cost_per_m, double max_across,
    std::uint8_t class_index) {
  constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
  const int rows = static_cast<int>(std::ceil(max_across * TravelCurve::kRowsPerUnit)) + 1;
  std::vector<TravelState> states;
  for (int row = 0; row < rows; ++row)
    for (int bin = 0; bin < TravelCurve::kBins; ++bin) {
      const double cost =
          cost_per_m({TravelCurve::gradient(bin), static_cast<double>(row) / TravelCurve::kRowsPerUnit});
      TravelState state{.slip = unknown,
                        .sinkage_m = unknown,
                        .torque_Nm = unknown,
                        .energy_J_per_m = static_cast<float>(cost),
                        .time_s_per_m = unknown,
                        .risk_per_m = unknown,
                        .pull_margin = unknown,
                        .refusal = std::isfinite(cost) ? Refusal::None : Refusal::Pull,
                        .class_index = class_index};
      if (row > 0) {
        const TravelState& before = states[states.size() - TravelCurve::kBins];
        state.energy_J_per_m = std::max(state.energy_J_per_m, before.energy_J_per_m);
        if (before.refusal != Refusal::None) state.refusal = before.refusal;
      }
      states.push_back(state);
    }
  return std::make_shared<const TabulatedStates>(std::move(states));
}

}  // namespace talus::costmap
