#include <limits>
#include <stdexcept>

#include <talus/costmap/cost_weights.hpp>

namespace talus::costmap {
namespace {

float weighed(const DriveState& state, const CostWeights& weights) {
  if (state.refusal != Refusal::None) return std::numeric_limits<float>::infinity();
  return static_cast<float>(weights.energy * static_cast<double>(state.energy_J_per_m) +
                            weights.time_W * static_cast<double>(state.time_s_per_m) +
                            weights.risk_J * static_cast<double>(state.risk_per_m));
}

}  // namespace

std::shared_ptr<const CostGrid> reweighted(const CostGrid& map, const CostWeights& weights) {
  if (!(weights.energy >= 0 && weights.time_W >= 0 && weights.risk_J >= 0))
    throw std::invalid_argument("cost weights: energy, time_W and risk_J must be >= 0");
  std::vector<DriveGround> grounds;
  for (const auto& states : map.cost().states()) {
    if (!states)
      throw std::domain_error("cost weights: the map's cost holds no energy, time and risk to weigh");
    DriveGround ground{.curve = {}, .states = states};
    for (std::size_t bin = 0; bin < states->size(); ++bin)
      ground.curve.cost_J_per_m[bin] = weighed((*states)[bin], weights);
    grounds.push_back(std::move(ground));
  }
  CostGrid::Content content = map.content();
  content.cost = std::make_shared<const DriveCost>(map.cost().limits(), grounds, map.cost().doubt());
  return std::make_shared<const CostGrid>(std::move(content));
}

}  // namespace talus::costmap
