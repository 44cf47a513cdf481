#pragma once

#include <algorithm>

#include <talus/costmap/cost/cost_model.hpp>
#include <talus/terramech/mobility/turning.hpp>

namespace talus::costmap {

/// Returns the cost of a turn: cost_J = energy * energy_J + time_W * time_s, with the weight `energy` of
/// energy [-] and the weight `time_W` of time [W].
inline TurnCost priced(const terramech::TurnEffort& effort, double energy, double time_W) noexcept {
  return {.cost_J = energy * effort.energy_J + time_W * effort.time_s,
          .energy_J = effort.energy_J,
          .time_s = effort.time_s};
}

/// Returns the turn costs with cost_J recomputed from other weights of energy [-] and time [W].
inline TurnCosts reweighted(TurnCosts turns, double energy, double time_W) noexcept {
  for (TurnCost* price : {&turns.on_arc, &turns.in_place, &turns.at_vertex})
    *price = priced({price->energy_J, price->time_s}, energy, time_W);
  return turns;
}

/// Returns turn costs of which each quantity is the maximum of that quantity in `a` and `b`.
inline TurnCosts dearer(const TurnCosts& a, const TurnCosts& b) noexcept {
  const auto of = [](const TurnCost& x, const TurnCost& y) {
    return TurnCost{std::max(x.cost_J, y.cost_J), std::max(x.energy_J, y.energy_J),
                    std::max(x.time_s, y.time_s)};
  };
  return {of(a.on_arc, b.on_arc), of(a.in_place, b.in_place), of(a.at_vertex, b.at_vertex)};
}

}  // namespace talus::costmap
