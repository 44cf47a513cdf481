#include <stdexcept>

#include <talus/costmap/cost/cost_weights.hpp>
#include <talus/costmap/cost/travel_states.hpp>
#include <talus/costmap/cost/turn_price.hpp>

namespace talus::costmap {
std::shared_ptr<const CostGrid> reweighted(const CostGrid& map, const CostWeights& weights) {
  if (!(weights.energy >= 0 && weights.time_W >= 0 && weights.risk_J >= 0))
    throw std::invalid_argument("cost weights: energy, time_W and risk_J must be >= 0");
  std::vector<GroundCost> grounds;
  for (std::size_t i = 0; i < map.cost().states().size(); ++i) {
    const auto& states = map.cost().states()[i];
    if (!states)
      throw std::domain_error("cost weights: the map's cost holds no energy, time and risk to weigh");
    grounds.push_back(
        {states->curve(weights), states, reweighted(map.cost().turns()[i], weights.energy, weights.time_W)});
  }
  CostGrid::Content content = map.content();
  content.cost = std::make_shared<const TravelCost>(map.cost().limits(), grounds, map.cost().uncertainty());
  return std::make_shared<const CostGrid>(std::move(content));
}

}  // namespace talus::costmap
