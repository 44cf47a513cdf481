#include <cmath>

#include <talus/costmap/map/place_beliefs.hpp>
#include <talus/costmap/map/traversability_map.hpp>

namespace talus::costmap {
namespace {

void set(const GroundBelief& strength, CellBelief& belief) {
  belief.pull_mean = static_cast<float>(strength.pull.value);
  belief.pull_std = static_cast<float>(strength.pull.std);
  belief.sinkage_mean = static_cast<float>(strength.sinkage.value);
  belief.sinkage_std = static_cast<float>(strength.sinkage.std);
}

void set(const BlockEvidence& own, double samples, CellBelief& belief) {
  belief.evidence = static_cast<float>(samples);
  const float weakest = std::fmin(own.pull, own.most_pull);
  belief.evidence_pull = std::isnan(weakest) ? 0.0F : weakest;
  belief.evidence_sinkage = std::fmax(0.0F, std::fmax(own.sinkage, own.least_sinkage));
  belief.updated_s = own.updated_s;
}

}  // namespace

PlaceBeliefs::PlaceBeliefs(const TraversabilityMap& map) : map_(map), beliefs_(map.evidence()) {}

CellBelief PlaceBeliefs::at(maps::Cell cell) {
  const MapSurface& surface = map_.surface();
  CellBelief belief;
  belief.terrain_class = static_cast<std::uint8_t>(surface.classNumber(cell));
  belief.hazards = surface.hazards(cell);
  const int index = surface.classIndex(cell);
  if (index < 0) return belief;
  belief.terrain_class =
      static_cast<std::uint8_t>(map_.model().parts().classes[static_cast<std::size_t>(index)].number);
  set(beliefs_.at(cell, index).ground, belief);
  if (const BlockEvidence* own = map_.evidence().evidence(cell))
    set(*own, map_.evidence().samplesOf(cell), belief);
  if (const auto ranked = map_.costs().ranked(cell)) {
    belief.category = ranked->category;
    belief.confidence = ranked->confidence;
  } else if (!has(belief.hazards, Hazard::Unknown)) {
    belief.category = static_cast<std::uint8_t>(terramech::Category::Dangerous);
    belief.confidence = 16;
  }
  return belief;
}

std::optional<GroundBelief> PlaceBeliefs::ground(maps::Cell cell) {
  const int index = map_.surface().classIndex(cell);
  if (index < 0) return std::nullopt;
  return beliefs_.at(cell, index).ground;
}

CellBelief TraversabilityMap::belief(maps::Cell cell) const {
  return PlaceBeliefs(*this).at(cell);
}

std::optional<GroundBelief> TraversabilityMap::ground(maps::Cell cell) const {
  return PlaceBeliefs(*this).ground(cell);
}

}  // namespace talus::costmap
