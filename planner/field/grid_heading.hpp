#pragma once

#include <array>

#include <talus/maps/grid/grid.hpp>

namespace talus::planner {

/// The eight headings of a grid, anticlockwise from east.
enum GridHeading : int { kEast, kNorthEast, kNorth, kNorthWest, kWest, kSouthWest, kSouth, kSouthEast };

/// Columns and rows that a step along each heading goes.
inline constexpr std::array<maps::Cell, 8> kStep{
    {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

/// The heading the other way.
constexpr int opposite(int heading) noexcept {
  return heading ^ 4;
}

}  // namespace talus::planner
