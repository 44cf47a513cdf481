#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <talus/costmap/cost/cost_model.hpp>
#include <talus/planner/field/edge_layer.hpp>
#include <talus/planner/route/kernels.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {

/// The sides of a cell.
enum CellSide : int { kWestSide, kEastSide, kSouthSide, kNorthSide };

/// Point on a side of a cell, in cell side lengths from the south-west corner of the cell.
struct EdgeSpot {
  double x = 0.0;
  double y = 0.0;
};

/// Returns the point with index k of the `points` points on a side, 0 <= k < points.
EdgeSpot edgeSpot(int side, int k, int points) noexcept;

/// Table of all straight motions across a cell from a point of one side to the points of the other three
/// sides, and of their costs by TravelCost for cells of 1 m side length [J]. The TravelCost must outlive the
/// object. Immutable.
class EdgeCrossings {
 public:
  /// End point of a motion: side, and index of the point on this side.
  struct End {
    int side;
    int k;
  };

  EdgeCrossings(const costmap::TravelCost& cost, int points, Kernels kernels = Kernels::Best);

  /// Returns the number of points on each side.
  int points() const noexcept { return points_; }

  /// Returns the number of motions from one point: those to all points of the other three sides.
  int count() const noexcept { return 3 * points_; }

  /// Returns the end points of the motions from point k of a side, in the order of prices().
  const End* ends(int side, int k) const noexcept { return &ends_[first(side, k)]; }

  /// Writes to `paid` the sum of `here` and the cost of each motion from point k of a side across the cell;
  /// infinite if the heading is not allowed. `paid` needs space for count() values rounded up to a multiple
  /// of kVector.
  void prices(int side, int k, costmap::CellCode cell, float here, float* paid) const noexcept;

  static constexpr int kVector = 4;

  /// Returns true if the cell allows the heading of motion i from point k of a side.
  bool allowed(int side, int k, int i, costmap::CellCode cell) const noexcept;

  /// Returns true if the cell allows every heading.
  bool free(costmap::CellCode cell) const noexcept;

 private:
  std::size_t first(int side, int k) const noexcept {
    return static_cast<std::size_t>((side * points_ + k) * padded_);
  }

  const costmap::TravelCost& cost_;
  int points_;
  int padded_;  // count() rounded up to whole vectors
  bool vectors_;
  std::vector<End> ends_;
  std::vector<double> x_, y_;  // unit vectors of the headings times the gradient step
  std::vector<float> length_;
  std::vector<double> free_up_to_;  // by cost curve: gradient up to which every heading is allowed
};

/// Path from cell to cell, straight within each cell, with turns only on edges between cells. Coordinates are
/// in cells from the south-west corner of the map.
struct EdgePath {
  /// Point on a cell edge at which the path may turn.
  struct Turn {
    double x = 0.0;
    double y = 0.0;
    /// True: the point is on an edge between two columns, and y may vary. False: the point is on an edge
    /// between two rows, and x may vary.
    bool on_vertical = false;
  };
  std::vector<Turn> turns;        ///< turns in order; the first and the last are the fixed ends of the path
  std::vector<maps::Cell> cells;  ///< cells[i] contains the motion from turns[i] to turns[i + 1]

  bool empty() const noexcept { return turns.empty(); }
  /// Returns the turns in map coordinates [m].
  std::vector<maps::Point> points(const maps::Grid& grid) const;
};

/// Moves the turns along their edges to reduce the cost. Each of the `rounds` rounds is a dynamic programme
/// over a few positions around each turn; the spacing of the positions decreases from `coarsest_cells`
/// [cells]. The cost never increases.
void slideTurns(const costmap::CostGrid& map, EdgePath& path, double coarsest_cells, int rounds);

/// Corridor around a path: the cells within a distance of the path, copied from the map into a box with a
/// margin of two cells (a path that ends on an edge touches the next cell). The other cells of the box are
/// unknown and not drivable. Cells have local indices, row by row in the box.
class Corridor {
 public:
  /// Holder number of a cell that is not a holder.
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  /// Copies the cells within `reach_cells` of the path `along`, which must lie inside the map.
  Corridor(const costmap::CostGrid& map, const EdgeCrossings& crossings,
           const std::vector<maps::Point>& along, int reach_cells);

  /// Returns the local index of a cell.
  std::size_t local(maps::Cell c) const noexcept {
    return static_cast<std::size_t>(c.row - first_.row) * columns_ +
           static_cast<std::size_t>(c.column - first_.column);
  }
  /// Returns the cell with a local index.
  maps::Cell cell(std::size_t local) const noexcept {
    return {first_.column + static_cast<int>(local % columns_),
            first_.row + static_cast<int>(local / columns_)};
  }

  /// Returns the local index of the cell adjacent to `cell` across a side (CellSide).
  std::size_t beyond(std::size_t cell, int side) const noexcept {
    return side == kWestSide    ? cell - 1
           : side == kEastSide  ? cell + 1
           : side == kSouthSide ? cell - columns_
                                : cell + columns_;
  }

  costmap::CellCode code(std::size_t cell) const noexcept { return codes_[cell]; }

  /// Returns true if every heading is allowed in the cell.
  bool free(std::size_t cell) const noexcept { return free_[cell] != 0; }

  /// Returns the holder number of a cell. Data of edges are stored with holder cells: the west and south
  /// edges of a cell belong to this cell. The holders are the cells of the corridor and their neighbours to
  /// the east and north; they are numbered from 0.
  std::uint32_t holder(std::size_t cell) const noexcept { return holder_[cell]; }
  /// Returns the local index of the cell with a holder number.
  std::size_t held(std::uint32_t holder) const noexcept { return held_[holder]; }
  std::size_t holders() const noexcept { return held_.size(); }

  /// Assigns holder numbers to a cell and its eastern and northern neighbours. The cell must be at least one
  /// row inside the box.
  void hold(std::size_t cell);

 private:
  void open(const costmap::CostGrid& map, const EdgeCrossings& crossings, maps::Cell around, int reach_cells);

  maps::Cell first_;
  std::size_t columns_ = 0;
  std::vector<costmap::CellCode> codes_;
  std::vector<std::uint8_t> free_, open_;
  std::vector<std::uint32_t> holder_, held_;
};

/// Parameters of the search.
struct CorridorOptions {
  int reach_cells = 4;      ///< largest distance of the path from the given polyline [cells]
  int points_per_edge = 3;  ///< number of points per cell edge at which the path may cross the edge
  Kernels kernels = Kernels::Best;
};

/// Search of the cheapest path between the ends of a polyline that stays near the polyline and crosses cell
/// edges at a few fixed points. The method is Dijkstra's algorithm over these points. From a point on an edge
/// the path leads only into the other cell; therefore paths that turn back at an edge are not searched, and
/// both adjacent cells allow every turn. Immutable and safe to share between threads; the MotionCost must
/// outlive the object.
class CorridorSearch {
 public:
  explicit CorridorSearch(const MotionCost& cost, const CorridorOptions& options = {});

  /// Returns the cheapest path near the polyline `along`, which must lie inside the map; empty if no path
  /// costs less than `below_J` [J].
  EdgePath operator()(const std::vector<maps::Point>& along, double below_J) const;

 private:
  const MotionCost& cost_;
  CorridorOptions options_;
  EdgeCrossings crossings_;
  CostRange range_;
};

}  // namespace talus::planner
