#include <cstdint>
#include <vector>

#include <talus/costmap/map/map_tree.hpp>
#include <talus/costmap/map/place_beliefs.hpp>
#include <talus/costmap/surface/surface_tree.hpp>

namespace talus::costmap {
namespace {

Surface surfaceOf(const TraversabilityMap& map, const PlaceBeliefs& beliefs) {
  const SurfaceKeys& keys = map.surface().keys();
  Surface surface{map.elevation().elevation_m, keys};
  for (const auto& [cell, own] : map.evidence().floorEvidence()) {
    octomap::OcTreeKey key = keys.key(cell, keys.baseElevation_m());
    key[2] = own.level;
    const Floor floor{.cell = static_cast<std::uint32_t>(map.grid().index(cell)),
                      .height_m = static_cast<float>(keys.heightOf_m(own.level))};
    surface.floors.push_back({key, beliefs.at(cell, floor)});
  }
  return surface;
}

}  // namespace

TraversabilityTree treeOf(const TraversabilityMap& map) {
  PlaceBeliefs beliefs(map);
  return surfaceTree(surfaceOf(map, beliefs), [&](maps::Cell cell) { return beliefs.at(cell); });
}

void writeTree(const TraversabilityMap& map, std::ostream& stream) {
  PlaceBeliefs beliefs(map);
  writeSurfaceTree(
      surfaceOf(map, beliefs), [&](maps::Cell cell) { return beliefs.at(cell); }, stream);
}

}  // namespace talus::costmap
