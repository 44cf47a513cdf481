#include <talus/costmap/map/map_tree.hpp>
#include <talus/costmap/map/place_beliefs.hpp>
#include <talus/costmap/surface/surface_tree.hpp>

namespace talus::costmap {
namespace {

Surface surfaceOf(const TraversabilityMap& map) {
  return {map.elevation().elevation_m, map.surface().keys()};
}

}  // namespace

TraversabilityTree treeOf(const TraversabilityMap& map) {
  PlaceBeliefs beliefs(map);
  return surfaceTree(surfaceOf(map), [&](maps::Cell cell) { return beliefs.at(cell); });
}

void writeTree(const TraversabilityMap& map, std::ostream& stream) {
  PlaceBeliefs beliefs(map);
  writeSurfaceTree(
      surfaceOf(map), [&](maps::Cell cell) { return beliefs.at(cell); }, stream);
}

}  // namespace talus::costmap
