#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <talus/maps/grid/cover.hpp>

namespace talus::maps {
namespace {

constexpr double kTouch = 1e-3;  // smaller overlaps are ignored [cells]

using Corners = std::array<Point, 4>;

// True if a side of the pixel separates the pixel from the cell; coordinates in cells.
bool apart(const Corners& pixel, double turn, Cell cell) {
  for (std::size_t i = 0; i < pixel.size(); ++i) {
    const Point a = pixel[i], b = pixel[(i + 1) % pixel.size()];
    const double dx = b.x_m - a.x_m, dy = b.y_m - a.y_m, length = std::hypot(dx, dy);
    if (!(length > 0.0)) continue;
    double inward = -std::numeric_limits<double>::infinity();
    for (const int column : {cell.column, cell.column + 1})
      for (const int row : {cell.row, cell.row + 1})
        inward = std::max(inward, turn * (dx * (row - a.y_m) - dy * (column - a.x_m)) / length);
    if (inward <= kTouch) return true;
  }
  return false;
}

// 1 for corners in counter-clockwise order, -1 for clockwise.
double turnOf(const Corners& p) {
  double area = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Point a = p[i], b = p[(i + 1) % p.size()];
    area += a.x_m * b.y_m - b.x_m * a.y_m;
  }
  return area >= 0.0 ? 1.0 : -1.0;
}

struct Span {
  int first = 0, last = -1;
};

// Indices of the cells that contain a point of the interval [least, most]; coordinates in cells.
Span cellsIn(double least, double most, int cells) {
  if (!(least < cells) || !(most >= 0.0)) return {};
  return {static_cast<int>(std::max(0.0, std::floor(least))),
          static_cast<int>(std::min(cells - 1.0, std::floor(most)))};
}

// Indices of the cells that the interval [least, most] overlaps; coordinates in cells.
Span span(double least, double most, int cells) {
  if (!(least < cells) || !(most > 0.0)) return {};
  return {std::max(0, static_cast<int>(std::floor(std::max(least, 0.0) + kTouch))),
          std::min(cells - 1, static_cast<int>(std::ceil(std::min(most, 1.0 * cells) - kTouch)) - 1)};
}

}  // namespace

PixelCover::PixelCover(const Grid& grid) : values_(grid, std::numeric_limits<float>::quiet_NaN()) {}

void PixelCover::add(const std::array<Point, 4>& corners, float value) {
  if (std::isnan(value)) return;
  const Grid& grid = values_.grid();
  Corners pixel = corners;
  Point least = {1e300, 1e300}, most = {-1e300, -1e300};
  for (Point& p : pixel) {
    if (!std::isfinite(p.x_m) || !std::isfinite(p.y_m)) return;
    p = {p.x_m / grid.resolution_m, p.y_m / grid.resolution_m};
    least = {std::min(least.x_m, p.x_m), std::min(least.y_m, p.y_m)};
    most = {std::max(most.x_m, p.x_m), std::max(most.y_m, p.y_m)};
  }
  const Span columns = span(least.x_m, most.x_m, grid.width), rows = span(least.y_m, most.y_m, grid.height);
  const double turn = turnOf(pixel);
  for (int row = rows.first; row <= rows.last; ++row)
    for (int column = columns.first; column <= columns.last; ++column) {
      float& greatest = values_[{column, row}];
      if (value <= greatest || apart(pixel, turn, {column, row})) continue;
      greatest = value;
    }
}

namespace {

/// Edge from a to b, in cells from the grid corner (cover) or in metres from the first vertex
/// (enclosesGround).
struct Edge {
  Point a, b;
  bool outer = true;

  double least() const { return std::min(a.y_m, b.y_m); }
  double greatest() const { return std::max(a.y_m, b.y_m); }

  /// x of the edge at height y, which must lie within the edge; a.x of a horizontal edge.
  double at(double y) const {
    if (a.y_m == b.y_m) return a.x_m;
    const double x = a.x_m + (y - a.y_m) * ((b.x_m - a.x_m) / (b.y_m - a.y_m));
    return std::clamp(x, std::min(a.x_m, b.x_m), std::max(a.x_m, b.x_m));
  }

  /// +1 if the edge crosses height y upwards, -1 downwards, else 0. Of two edges that meet at height y,
  /// exactly one crosses if the boundary crosses.
  int through(double y) const {
    if ((a.y_m <= y) == (b.y_m <= y)) return 0;
    return a.y_m <= y ? 1 : -1;
  }
};

// Edges of all rings, relative to a point and in units of `size_m`.
std::vector<Edge> edgesOf(const Polygon& polygon, Point from, double size_m) {
  std::vector<Edge> edges;
  const auto add = [&](const Ring& ring, bool outer) {
    const auto placed = [&](std::size_t i) {
      const Point p = ring[i % ring.size()];
      return Point{(p.x_m - from.x_m) / size_m, (p.y_m - from.y_m) / size_m};
    };
    for (std::size_t i = 0; i < ring.size(); ++i) edges.push_back({placed(i), placed(i + 1), outer});
  };
  add(polygon.outer, true);
  for (const Ring& hole : polygon.holes) add(hole, false);
  return edges;
}

/// The edges that reach a band of heights; bands must rise.
class Sweep {
 public:
  explicit Sweep(std::vector<Edge> edges) : edges_(std::move(edges)) {
    std::ranges::sort(edges_, {}, &Edge::least);
  }

  const std::vector<Edge>& at(double low, double high) {
    for (; next_ < edges_.size() && edges_[next_].least() <= high; ++next_) reached_.push_back(edges_[next_]);
    std::erase_if(reached_, [&](const Edge& edge) { return edge.greatest() < low; });
    return reached_;
  }

 private:
  std::vector<Edge> edges_, reached_{};
  std::size_t next_ = 0;
};

/// Winding number of the outer ring at a point, and whether the point lies inside an odd number of holes.
struct Inside {
  int windings = 0;
  bool hole = false;

  void cross(const Edge& edge, int direction) {
    if (edge.outer)
      windings += direction;
    else
      hole = !hole;
  }
  bool ground() const { return windings != 0 && !hole; }
};

// True if the rings enclose ground at height y.
bool hasGroundAt(double y, double thinnest, const std::vector<Edge>& edges) {
  std::vector<std::pair<double, const Edge*>> crossings;
  for (const Edge& edge : edges)
    if (edge.through(y) != 0) crossings.emplace_back(edge.at(y), &edge);
  std::ranges::sort(crossings);
  Inside inside;
  for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
    inside.cross(*crossings[i].second, crossings[i].second->through(y));
    if (inside.ground() && crossings[i + 1].first - crossings[i].first > thinnest) return true;
  }
  return false;
}

}  // namespace

bool enclosesGround(const Polygon& polygon) {
  if (polygon.outer.empty()) return false;
  const std::vector<Edge> edges = edgesOf(polygon, polygon.outer.front(), 1.0);
  std::vector<double> heights;
  double west = 0.0, east = 0.0;
  for (const Edge& edge : edges) {
    west = std::min(west, edge.a.x_m);
    east = std::max(east, edge.a.x_m);
    heights.push_back(edge.a.y_m);
  }
  std::ranges::sort(heights);
  constexpr double kThinnest = 1e-9;
  Sweep sweep(edges);
  for (std::size_t i = 0; i + 1 < heights.size(); ++i) {
    const double y = heights[i] + 0.5 * (heights[i + 1] - heights[i]);
    if (heights[i + 1] - heights[i] > kThinnest * (heights.back() - heights.front()) &&
        hasGroundAt(y, kThinnest * (east - west), sweep.at(y, y)))
      return true;
  }
  return false;
}

bool cover(const Polygon& polygon, Raster<std::uint8_t>& mask) {
  const Grid& grid = mask.grid();
  const std::vector<Edge> edges = edgesOf(polygon, grid.south_west, grid.resolution_m);
  double west = grid.width, east = -1.0, south = grid.height, north = -1.0;
  for (const Edge& edge : edges) {
    west = std::min(west, edge.a.x_m);
    east = std::max(east, edge.a.x_m);
    south = std::min(south, edge.a.y_m);
    north = std::max(north, edge.a.y_m);
  }
  const Span columns = cellsIn(west, east, grid.width), rows = cellsIn(south, north, grid.height);
  // Of each cell of a row: the change of the winding from the centre of the previous cell, and the rings whose edges
  // touch the cell.
  struct Mark {
    Inside change;
    bool outer = false, hole = false;
  };
  std::vector<Mark> marks(static_cast<std::size_t>(columns.last + 1 - columns.first));
  const auto mark = [&](int column) -> Mark& {
    return marks[static_cast<std::size_t>(column - columns.first)];
  };
  Sweep sweep(edges);
  bool any = false;
  for (int row = rows.first; row <= rows.last; ++row) {
    std::ranges::fill(marks, Mark{});
    const double middle = row + 0.5;
    // An edge on the border of two rows belongs to the northern one.
    for (const Edge& edge : sweep.at(row, std::nextafter(row + 1.0, middle))) {
      const double a = edge.at(std::max(edge.least(), row + 0.0)),
                   b = edge.a.y_m == edge.b.y_m ? edge.b.x_m : edge.at(std::min(edge.greatest(), row + 1.0));
      const Span touched = cellsIn(std::min(a, b), std::max(a, b), grid.width);
      for (int column = touched.first; column <= touched.last; ++column)
        (edge.outer ? mark(column).outer : mark(column).hole) = true;
      if (edge.through(middle) == 0) continue;
      const double next = std::max(columns.first + 0.0, std::ceil(edge.at(middle) - 0.5));
      if (next <= columns.last) mark(static_cast<int>(next)).change.cross(edge, edge.through(middle));
    }
    // A cell that no outer edge touches lies entirely inside or outside the outer ring: its centre is tested.
    Inside inside;
    for (int column = columns.first; column <= columns.last; ++column) {
      const Mark& here = mark(column);
      inside.windings += here.change.windings;
      inside.hole ^= here.change.hole;
      if (!inside.ground() && !here.outer && (inside.windings == 0 || !here.hole)) continue;
      mask[{column, row}] = 1;
      any = true;
    }
  }
  return any;
}

}  // namespace talus::maps
