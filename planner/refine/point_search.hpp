#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include <talus/planner/route/heading_set.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Estimate of the cost [J] from a place to the goal.
using Rest = std::function<double(maps::Point)>;

/// Number of points on each side of a cell, and in each row and column of points inside a cell that does not
/// permit some heading.
struct PointCounts {
  int side = 3;
  int inner = 1;
};

/// Path over points of cells.
struct PointPath {
  Polyline points;                ///< ends and turns in order [m]
  std::vector<maps::Cell> cells;  ///< cells[i] contains the motion from points[i] to points[i + 1]
};

/// Moves the turns on cell sides along their sides to reduce the sum of the costs of the legs. Turns inside cells,
/// and turns that only one of the adjacent cells permits, remain; the function returns their indices. Each of the `rounds` rounds is a dynamic programme over a few
/// positions around each turn; the spacing of the positions decreases from `coarsest_cells` [cells]. The sum
/// never increases.
std::vector<std::size_t> slideTurns(const costmap::CostGrid& map, PointPath& path, double coarsest_cells,
                                    int rounds);

/// Cells that a search may enter.
class SearchRegion {
 public:
  /// All cells of a map.
  explicit SearchRegion(const maps::Grid& grid);
  /// The cells at most reach_cells(cell) columns and rows from some `cell` of the path `along`, which must lie
  /// inside the map.
  SearchRegion(const maps::Grid& grid, const Polyline& along,
               const std::function<int(maps::Cell)>& reach_cells);

  /// Returns true if the region contains the cell.
  bool contains(maps::Cell cell) const noexcept {
    return cell.column >= first_.column && cell.row >= first_.row && cell.column <= last_.column &&
           cell.row <= last_.row && (open_.empty() || open_[local(cell)] != 0);
  }
  /// Returns the index of a cell of the bounding box, or of a cell one column or row beyond it.
  std::size_t local(maps::Cell cell) const noexcept {
    return static_cast<std::size_t>(cell.row - first_.row) * columns() +
           static_cast<std::size_t>(cell.column - first_.column);
  }
  /// Number of indices.
  std::size_t size() const noexcept {
    return columns() * static_cast<std::size_t>(last_.row - first_.row + 2);
  }

 private:
  std::size_t columns() const noexcept { return static_cast<std::size_t>(last_.column - first_.column + 2); }

  maps::Cell first_, last_;
  std::vector<std::uint8_t> open_;  // empty: all
};

/// Search of the cheapest path over fixed points of cells. A leg crosses one cell, or a part of it, at its
/// exact cost; the cost of a turn at a point is that of the cheapest path to this point. Paths may tack
/// (alternate between two headings) inside a cell. A turn on a side needs only one of the adjacent cells to
/// permit each of its headings, because offSides() moves it off the side. The method is A*.
/// Immutable and safe to share between threads; the MotionCost must outlive the object.
class PointSearch {
 public:
  PointSearch(const MotionCost& cost, PointCounts counts);

  /// Ends and limits of a search.
  struct Task {
    Segment places;            ///< start and goal
    double tolerance_m = 0.0;  ///< distance from the goal at which a path may end
    double below_J;            ///< paths that cost as much or more are not searched
    Rest rest{};               ///< estimate for A*; empty: zero
    StopCheck stop{};
  };
  /// Returns true if the cell permits every heading.
  bool free(costmap::CellCode cell) const noexcept;

  /// Returns the cheapest path in the region; empty if there is none below the limit, or after a stop.
  PointPath operator()(const Task& task, const SearchRegion& region) const;

 private:
  friend class PointSearchRun;

  // A point of a cell: on a side, or inside (side kInside), in cell side lengths from the south-west corner.
  struct Spot {
    int side;
    double x, y;
  };
  // A straight leg to another spot of a cell.
  struct Leg {
    std::uint32_t number;   // of the spot among those of its side
    std::uint32_t heading;  // in headings_
    float length;           // cell sides
  };
  enum Side : int { kWest, kEast, kSouth, kNorth, kInside, kSides };

  std::uint32_t headingOf(costmap::Direction direction);

  const MotionCost& cost_;
  PointCounts counts_;
  std::vector<Spot> spots_;                                 // side by side, then those inside
  std::vector<std::array<std::vector<Leg>, kSides>> legs_;  // by spot, and side of the end
  std::vector<costmap::Direction> headings_;                // different headings of all legs
  std::vector<HeadingCost> heading_costs_;
  std::vector<double> free_up_to_;  // by cost curve: gradient below which every heading is permitted
};

}  // namespace talus::planner
