#include <cmath>
#include <stdexcept>
#include <utility>

#include <talus/costmap/costmap.hpp>
#include <talus/planner/planner.hpp>

namespace talus {

using costmap::TraversabilityMap;

TraversabilityMap traversabilityMap(Site site, const ProgressMonitor& watch) {
  return {std::move(site.layers), std::make_shared<const costmap::GroundModel>(std::move(site.ground)),
          site.options, watch};
}

Map::Map(Site site, const ProgressMonitor& watch) : Map(traversabilityMap(std::move(site), watch)) {}
Map::Map(TraversabilityMap map)
    : map_(std::make_unique<TraversabilityMap>(std::move(map))),
      intake_(
          std::make_unique<costmap::DriveIntake>(*map_, nullptr, costmap::IntakeOptions{.settles = true})) {}
Map::Map(Map&&) noexcept = default;
Map& Map::operator=(Map&&) noexcept = default;
Map::~Map() = default;

Map Map::read(const std::string& path, int threads, const ProgressMonitor& watch) {
  return Map(costmap::readMap(path, threads, watch));
}

void Map::save(const std::string& path) const {
  costmap::writeMap(*map_, path);
}

LearnReport Map::learn(const Telemetry& drive) {
  return costmap::addDrive(*map_, drive);
}

std::size_t Map::learnPart(const Telemetry& part) {
  const std::size_t before = intake_->report().used;
  intake_->add(part);
  map_->publish();
  return intake_->report().used - before;
}

LearnReport Map::settle() {
  intake_->settle();
  map_->publish();
  return intake_->report();
}

void Map::patch(const costmap::SurfacePatch& seen) {
  map_->patch(seen);
}

Map Map::moved(maps::Cell tiles) const {
  return Map(map_->moved(tiles));
}

costmap::Explanation Map::explain(maps::Point place, std::optional<double> heading_rad) const {
  const auto cell = map_->grid().cellAt(place);
  if (!cell) throw std::invalid_argument("explain: the place lies outside the map");
  if (!heading_rad) return costmap::explain(*map_, *cell);
  return costmap::explain(*map_, *cell, costmap::Direction{std::cos(*heading_rad), std::sin(*heading_rad)});
}

}  // namespace talus
