#pragma once

#include <array>

#include <talus/maps/grid/grid.hpp>

namespace talus::planner {

/// The eight headings of a grid, counter-clockwise from east.
enum GridHeading : int { kEast, kNorthEast, kNorth, kNorthWest, kWest, kSouthWest, kSouth, kSouthEast };

/// Column and row offset of a step along each heading.
inline constexpr std::array<maps::Cell, 8> kStep{
    {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

/// Returns the opposite heading.
constexpr int opposite(int heading) noexcept {
  return heading ^ 4;
}

}  // namespace talus::planner
