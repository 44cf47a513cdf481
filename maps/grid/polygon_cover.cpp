#include <algorithm>
#include <cmath>
#include <cstddef>

#include <talus/maps/grid/polygon_cover.hpp>

namespace talus::maps {
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
  std::vector<Edge> edges;
  addEdges(polygon.outer, true, placed, edges);
  for (const Ring& hole : polygon.holes) addEdges(hole, false, placed, edges);
  std::ranges::sort(edges, {}, &Edge::least);
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

bool hasGroundAt(double y, double thinnest, const std::vector<Edge>& edges) {
  struct Crossing {
    double x = 0.0;
    const Edge* edge = nullptr;
  };
  std::vector<Crossing> crossings;
  for (const Edge& edge : edges) {
    if (edge.least() > y) break;
    if (edge.through(y) != 0) crossings.push_back({edge.at(y), &edge});
  }
  std::ranges::sort(crossings, {}, &Crossing::x);
  Inside inside;
  for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
    inside.cross(*crossings[i].edge, crossings[i].edge->through(y));
    if (inside.ground() && crossings[i + 1].x - crossings[i].x > thinnest) return true;
  }
  return false;
}

/// One row of cells: the winding at the cell centres and the cells that an edge touches.
class RowCover {
 public:
  explicit RowCover(int width) : crossings_(static_cast<std::size_t>(width)), touched_(crossings_.size()) {}

  void begin() {
    std::ranges::fill(crossings_, Inside{});
    std::ranges::fill(touched_, 0);
  }

  void add(const Edge& edge, int row) {
    const double low = std::max(edge.least(), static_cast<double>(row)),
                 high = std::min(edge.greatest(), row + 1.0);
    double from = edge.at(low), to = edge.at(high);
    if (edge.a.y_m == edge.b.y_m) to = edge.b.x_m;
    if (from > to) std::swap(from, to);
    const auto width = static_cast<double>(touched_.size());
    if (to >= 0.0 && from < width)
      for (auto c = static_cast<std::size_t>(std::max(0.0, std::floor(from))),
                last = static_cast<std::size_t>(std::min(width - 1.0, std::floor(to)));
           c <= last; ++c)
        touched_[c] |= edge.outer ? kOuter : kHole;
    const double middle = row + 0.5;
    if (const int direction = edge.through(middle); direction != 0) {
      const double first = std::max(0.0, std::ceil(edge.at(middle) - 0.5));
      if (first < width) crossings_[static_cast<std::size_t>(first)].cross(edge, direction);
    }
  }

  /// Sets the covered cells of the row; returns whether there is any. A cell that no outer edge touches lies
  /// entirely inside or outside the outer ring, so its centre decides.
  bool close(std::uint8_t* cells) const {
    Inside inside;
    bool any = false;
    for (std::size_t c = 0; c < touched_.size(); ++c) {
      inside.windings += crossings_[c].windings;
      inside.hole ^= crossings_[c].hole;
      if (inside.ground() || (touched_[c] & kOuter) != 0 || (inside.windings != 0 && touched_[c] != 0)) {
        cells[c] = 1;
        any = true;
      }
    }
    return any;
  }

 private:
  static constexpr std::uint8_t kOuter = 1, kHole = 2;
  std::vector<Inside> crossings_;  // change of the winding from the centre of the previous cell
  std::vector<std::uint8_t> touched_;
};

}  // namespace

bool enclosesGround(const Polygon& polygon) {
  if (polygon.outer.empty()) return false;
  const Point first = polygon.outer.front();
  const std::vector<Edge> edges = edgesOf(polygon, [&](Point p) {
    return Point{p.x_m - first.x_m, p.y_m - first.y_m};
  });
  std::vector<double> heights;
  heights.reserve(edges.size());
  double west = 0.0, east = 0.0;
  for (const Edge& edge : edges) {
    heights.push_back(edge.a.y_m);
    west = std::min(west, edge.a.x_m);
    east = std::max(east, edge.a.x_m);
  }
  std::ranges::sort(heights);
  constexpr double kThinnest = 1e-9;
  const double thinnest_x = kThinnest * (east - west),
               thinnest_y = kThinnest * (heights.back() - heights.front());
  for (std::size_t i = 0; i + 1 < heights.size(); ++i)
    if (heights[i + 1] - heights[i] > thinnest_y &&
        hasGroundAt(heights[i] + 0.5 * (heights[i + 1] - heights[i]), thinnest_x, edges))
      return true;
  return false;
}

bool cover(const Polygon& polygon, Raster<std::uint8_t>& mask) {
  const Grid& grid = mask.grid();
  const std::vector<Edge> edges = edgesOf(polygon, [&](Point p) {
    return Point{(p.x_m - grid.south_west.x_m) / grid.resolution_m,
                 (p.y_m - grid.south_west.y_m) / grid.resolution_m};
  });
  std::vector<const Edge*> reached;
  RowCover cells(grid.width);
  bool any = false;
  auto next = edges.begin();
  for (int row = 0; row < grid.height; ++row) {
    for (; next != edges.end() && next->least() < row + 1.0; ++next) reached.push_back(&*next);
    std::erase_if(reached, [&](const Edge* edge) { return edge->greatest() < row; });
    if (reached.empty()) continue;
    cells.begin();
    for (const Edge* edge : reached) cells.add(*edge, row);
    any |= cells.close(mask.row(row));
  }
  return any;
}

}  // namespace talus::maps
