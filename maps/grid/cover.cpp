#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <span>

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

template <class Map>
void addEdges(const Ring& ring, bool outer, const Map& placed, std::vector<Edge>& edges) {
  for (std::size_t i = 0; i < ring.size(); ++i)
    edges.push_back({placed(ring[i]), placed(ring[(i + 1) % ring.size()]), outer});
}

template <class Map>
std::vector<Edge> edgesOf(const Polygon& polygon, const Map& placed) {
  std::size_t positions = polygon.outer.size();
  for (const Ring& hole : polygon.holes) positions += hole.size();
  std::vector<Edge> edges;
  edges.reserve(positions);
  addEdges(polygon.outer, true, placed, edges);
  for (const Ring& hole : polygon.holes) addEdges(hole, false, placed, edges);
  return edges;
}

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

// True if the rings enclose ground at height y. `edges`: all edges, or those that reach y.
template <class Edges>
bool hasGroundAt(double y, double thinnest, const Edges& edges) {
  struct Crossing {
    double x = 0.0;
    int direction = 0;
    const Edge* edge = nullptr;
  };
  std::vector<Crossing> crossings;
  for (const Edge& edge : edges)
    if (const int direction = edge.through(y); direction != 0)
      crossings.push_back({edge.at(y), direction, &edge});
  std::ranges::sort(crossings, {}, &Crossing::x);
  Inside inside;
  for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
    inside.cross(*crossings[i].edge, crossings[i].direction);
    if (inside.ground() && crossings[i + 1].x - crossings[i].x > thinnest) return true;
  }
  return false;
}

// True if the rings enclose ground. Tests one height between each two neighbouring heights of positions.
bool hasGround(double thinnest_x, double thinnest_y, std::vector<Edge>& edges) {
  std::vector<double> heights;
  heights.reserve(edges.size());
  for (const Edge& edge : edges) heights.push_back(edge.a.y_m);
  std::ranges::sort(heights);
  std::ranges::sort(edges, {}, &Edge::least);
  std::vector<Edge> reached;
  auto next = edges.begin();
  for (std::size_t i = 0; i + 1 < heights.size(); ++i) {
    if (heights[i + 1] - heights[i] <= thinnest_y) continue;
    const double y = heights[i] + 0.5 * (heights[i + 1] - heights[i]);
    for (; next != edges.end() && next->least() <= y; ++next) reached.push_back(*next);
    std::erase_if(reached, [&](const Edge& edge) { return edge.greatest() < y; });
    if (hasGroundAt(y, thinnest_x, reached)) return true;
  }
  return false;
}

/// One row of cells: the winding at the cell centres and the cells that an edge touches. Only the cells from
/// the first to the last edge of the row are visited.
class RowCover {
 public:
  explicit RowCover(int width) : crossings_(static_cast<std::size_t>(width)), touched_(crossings_.size()) {}

  void add(const Edge& edge, int row) {
    const double low = std::max(edge.least(), static_cast<double>(row)),
                 high = std::min(edge.greatest(), row + 1.0);
    double from = edge.at(low), to = edge.at(high);
    if (edge.a.y_m == edge.b.y_m) to = edge.b.x_m;
    if (from > to) std::swap(from, to);
    const auto width = static_cast<double>(touched_.size());
    if (to >= 0.0 && from < width) {
      const auto first = static_cast<std::size_t>(std::max(0.0, std::floor(from))),
                 last = static_cast<std::size_t>(std::min(width - 1.0, std::floor(to)));
      visit(first, last);
      for (std::size_t c = first; c <= last; ++c) touched_[c] |= edge.outer ? kOuter : kHole;
    }
    const double middle = row + 0.5;
    if (const int direction = edge.through(middle); direction != 0) {
      const double first = std::max(0.0, std::ceil(edge.at(middle) - 0.5));
      const auto c = static_cast<std::size_t>(std::min(first, width - 1.0));
      visit(c, c);
      if (first < width) crossings_[c].cross(edge, direction);
    }
  }

  /// Sets the covered cells of the row, clears its edges, and returns true if any cell is covered. A cell
  /// that no outer edge touches lies entirely inside or outside the outer ring; its centre is therefore
  /// tested.
  bool close(std::uint8_t* cells) {
    Inside inside;
    bool any = false;
    for (std::size_t c = first_; c < end_; ++c) {
      inside.windings += crossings_[c].windings;
      inside.hole ^= crossings_[c].hole;
      if (inside.ground() || (touched_[c] & kOuter) != 0 || (inside.windings != 0 && touched_[c] != 0)) {
        cells[c] = 1;
        any = true;
      }
      crossings_[c] = {};
      touched_[c] = 0;
    }
    first_ = crossings_.size();
    end_ = 0;
    return any;
  }

 private:
  static constexpr std::uint8_t kOuter = 1, kHole = 2;

  void visit(std::size_t first, std::size_t last) {
    first_ = std::min(first_, first);
    end_ = std::max(end_, last + 1);
  }

  std::vector<Inside> crossings_;  // change of the winding from the centre of the previous cell
  std::vector<std::uint8_t> touched_;
  std::size_t first_ = crossings_.size(), end_ = 0;  // range of the cells that are visited
};

/// Edges grouped by the row of cells in which they begin. Edges that begin below the grid are in the first
/// row, and omitted if they also end below.
class EdgesByRow {
 public:
  EdgesByRow(const std::vector<Edge>& edges, int rows) : ends_(static_cast<std::size_t>(rows) + 1, 0) {
    const auto reaches = [rows](const Edge& edge) { return edge.greatest() >= 0.0 && edge.least() < rows; };
    for (const Edge& edge : edges)
      if (reaches(edge)) ++ends_[rowOf(edge) + 1];
    std::partial_sum(ends_.begin(), ends_.end(), ends_.begin());
    edges_.resize(ends_.back());
    for (const Edge& edge : edges)
      if (reaches(edge)) edges_[ends_[rowOf(edge)]++] = &edge;
  }

  std::span<const Edge* const> begunIn(int row) const {
    const auto at = static_cast<std::size_t>(row);
    const std::size_t first = at == 0 ? 0 : ends_[at - 1];
    return std::span(edges_).subspan(first, ends_[at] - first);
  }

  /// Returns the index of the first row in which an edge begins; the height of the grid if there is no edge.
  int firstRow() const {
    return static_cast<int>(std::ranges::find_if(ends_, [](std::size_t end) { return end > 0; }) -
                            ends_.begin());
  }

 private:
  static std::size_t rowOf(const Edge& edge) {
    return static_cast<std::size_t>(std::max(0.0, std::floor(edge.least())));
  }

  std::vector<std::size_t> ends_;  // number of edges that begin in this row and in all rows before
  std::vector<const Edge*> edges_{};
};

}  // namespace

bool enclosesGround(const Polygon& polygon) {
  if (polygon.outer.empty()) return false;
  const Point first = polygon.outer.front();
  std::vector<Edge> edges = edgesOf(polygon, [&](Point p) {
    return Point{p.x_m - first.x_m, p.y_m - first.y_m};
  });
  double west = 0.0, east = 0.0, south = 0.0, north = 0.0;
  for (const Edge& edge : edges) {
    west = std::min(west, edge.a.x_m);
    east = std::max(east, edge.a.x_m);
    south = std::min(south, edge.a.y_m);
    north = std::max(north, edge.a.y_m);
  }
  constexpr double kThinnest = 1e-9;
  const double thinnest_x = kThinnest * (east - west), thinnest_y = kThinnest * (north - south);
  // Most rings enclose ground at one of these two heights, so that no sort is needed.
  for (const double part : {0.381966, 0.618034})
    if (hasGroundAt(south + part * (north - south), thinnest_x, edges)) return true;
  return hasGround(thinnest_x, thinnest_y, edges);
}

bool cover(const Polygon& polygon, Raster<std::uint8_t>& mask) {
  const Grid& grid = mask.grid();
  const std::vector<Edge> edges = edgesOf(polygon, [&](Point p) {
    return Point{(p.x_m - grid.south_west.x_m) / grid.resolution_m,
                 (p.y_m - grid.south_west.y_m) / grid.resolution_m};
  });
  const EdgesByRow waiting(edges, grid.height);
  std::vector<const Edge*> reached;
  RowCover cells(grid.width);
  bool any = false;
  for (int row = waiting.firstRow(); row < grid.height; ++row) {
    const auto begun = waiting.begunIn(row);
    reached.insert(reached.end(), begun.begin(), begun.end());
    std::erase_if(reached, [&](const Edge* edge) { return edge->greatest() < row; });
    if (reached.empty()) continue;
    for (const Edge* edge : reached) cells.add(*edge, row);
    any |= cells.close(mask.row(row));
  }
  return any;
}

}  // namespace talus::maps
