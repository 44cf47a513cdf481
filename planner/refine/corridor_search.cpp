#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <talus/common/common.hpp>
#include <talus/planner/refine/corridor_search.hpp>
#include <talus/planner/route/heading_set.hpp>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace talus::planner {
namespace {

using costmap::CellCode;
using costmap::TravelCost;
using costmap::TravelCurve;

constexpr float kNoCost = std::numeric_limits<float>::infinity();
constexpr int kBinBits = 9;
static_assert(TravelCurve::kBins == 1 << kBinBits);

// Headings and lengths of consecutive motions.
struct Motions {
  const double *x, *y;
  const float* length;
};

void pricesByScalar(const TravelCost& cost, CellCode cell, float here, const Motions& motions, int count,
                    float* paid) noexcept {
  for (int i = 0; i < count; ++i)
    paid[i] = here + HeadingCost(cost, motions.x[i], motions.y[i])(cell) * motions.length[i];
}

#if defined(__x86_64__)
// The lower 32 bits of each 64-bit mask.
__attribute__((target("avx2"))) inline __m128i lanes(__m256d mask) noexcept {
  const __m256i evens = _mm256_setr_epi32(0, 2, 4, 6, 0, 2, 4, 6);
  return _mm256_castsi256_si128(_mm256_permutevar8x32_epi32(_mm256_castpd_si256(mask), evens));
}

// TravelCurve::between(): the previous node, whether the coordinate differs from the node (-1), and the
// weight of the next node.
struct Betweens {
  __m128i whole, off;
  __m128 share;
};
__attribute__((target("avx2"))) inline Betweens betweens(__m256d place) noexcept {
  const __m256d same = _mm256_set1_pd(TravelCurve::kSame);
  const __m128i whole = _mm256_cvttpd_epi32(_mm256_add_pd(place, same));
  const __m256d rest = _mm256_sub_pd(place, _mm256_cvtepi32_pd(whole));
  const __m128i off = lanes(_mm256_cmp_pd(rest, same, _CMP_GT_OQ));
  return {whole, off, _mm_and_ps(_mm256_cvtpd_ps(rest), _mm_castsi128_ps(off))};
}

struct Prices {
  __m128 here, next;
};

// Returns the costs `prices` at four node indices `at` and at the indices after them. Lanes without a set
// sign bit in `off` have their coordinate on the node and get the cost of the node twice.
__attribute__((target("avx2"))) inline Prices pairsAt(const float* prices, __m128i at, __m128i off) noexcept {
  alignas(16) std::array<std::int32_t, 4> lane;
  _mm_store_si128(reinterpret_cast<__m128i*>(lane.data()), at);
  const auto pair = [&](std::size_t k) __attribute__((target("avx2"))) {
    return _mm_castsi128_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(prices + lane[k])));
  };
  const __m128 first = _mm_unpacklo_ps(pair(0), pair(1)), second = _mm_unpacklo_ps(pair(2), pair(3));
  const __m128 here = _mm_movelh_ps(first, second), next = _mm_movehl_ps(second, first);
  return {here, _mm_blendv_ps(here, next, _mm_castsi128_ps(off))};
}

// The operations of HeadingCost for four motions at a time.
__attribute__((target("avx2"))) void pricesByVector(const TravelCost& cost, CellCode cell, float here,
                                                    const Motions& motions, int count, float* paid) noexcept {
  const __m256d steps_x = _mm256_set1_pd(cell.stepsX()), steps_y = _mm256_set1_pd(cell.stepsY());
  const __m256d most_along = _mm256_set1_pd(cost.limits().max_along),
                most_across = _mm256_set1_pd(cost.limits().max_across);
  const __m256d no_sign = _mm256_castsi256_pd(_mm256_set1_epi64x(0x7fffffffffffffff));
  const TravelCurve& curve = cost.curves()[cell.curve()];
  const float* prices = curve.rows();
  const __m128i last_row = _mm_set1_epi32(curve.lastRow());
  const __m256d bins_per_unit = _mm256_set1_pd(TravelCurve::kBinsPerUnit),
                rows_per_unit = _mm256_set1_pd(TravelCurve::kRowsPerUnit),
                middle = _mm256_set1_pd(TravelCurve::kBins / 2),
                last_place = _mm256_set1_pd(TravelCurve::kLastPlace);
  const __m128 no_cost = _mm_set1_ps(kNoCost);
  for (int i = 0; i < count; i += EdgeCrossings::kVector) {
    const __m256d x = _mm256_loadu_pd(motions.x + i), y = _mm256_loadu_pd(motions.y + i);
    const __m256d along = _mm256_add_pd(_mm256_mul_pd(steps_x, x), _mm256_mul_pd(steps_y, y));
    const __m256d across =
        _mm256_and_pd(_mm256_sub_pd(_mm256_mul_pd(steps_y, x), _mm256_mul_pd(steps_x, y)), no_sign);
    const __m256d place = _mm256_add_pd(_mm256_mul_pd(along, bins_per_unit), middle);
    const __m256d allowed =
        _mm256_and_pd(_mm256_and_pd(_mm256_cmp_pd(_mm256_and_pd(along, no_sign), most_along, _CMP_LE_OQ),
                                    _mm256_cmp_pd(across, most_across, _CMP_LE_OQ)),
                      _mm256_and_pd(_mm256_cmp_pd(place, _mm256_setzero_pd(), _CMP_GE_OQ),
                                    _mm256_cmp_pd(place, last_place, _CMP_LT_OQ)));
    const __m128i known = lanes(allowed);
    const Betweens bin = betweens(place), row = betweens(_mm256_mul_pd(across, rows_per_unit));
    const auto nodes = [&](__m128i of_row) __attribute__((target("avx2"))) {
      const __m128i at = _mm_add_epi32(bin.whole, _mm_slli_epi32(_mm_min_epi32(of_row, last_row), kBinBits));
      return pairsAt(prices, _mm_and_si128(at, known), bin.off);
    };
    const auto [a, b] = nodes(row.whole);
    const auto [c, d] = nodes(_mm_sub_epi32(row.whole, row.off));
    const __m128 free = _mm_and_ps(_mm_and_ps(_mm_cmplt_ps(a, no_cost), _mm_cmplt_ps(b, no_cost)),
                                   _mm_and_ps(_mm_cmplt_ps(c, no_cost), _mm_cmplt_ps(d, no_cost)));
    const __m128 allowed_ps = _mm_and_ps(free, _mm_castsi128_ps(known));
    const __m128 below = _mm_add_ps(a, _mm_mul_ps(bin.share, _mm_sub_ps(b, a))),
                 above = _mm_add_ps(c, _mm_mul_ps(bin.share, _mm_sub_ps(d, c)));
    const __m128 price = _mm_blendv_ps(
        no_cost, _mm_add_ps(below, _mm_mul_ps(row.share, _mm_sub_ps(above, below))), allowed_ps);
    _mm_storeu_ps(paid + i,
                  _mm_add_ps(_mm_set1_ps(here), _mm_mul_ps(price, _mm_loadu_ps(motions.length + i))));
  }
}
#else
constexpr auto pricesByVector = pricesByScalar;
#endif

// Largest steepness up to which the curve and the limits allow every heading.
double freeUpTo(const TravelCost& cost, const TravelCurve& curve) noexcept {
  double reach = std::min(
      {cost.limits().max_along, cost.limits().max_across, TravelCurve::gradient(TravelCurve::kBins - 1)});
  for (int row = 0; row <= curve.lastRow(); ++row)
    for (int bin = 0; bin < TravelCurve::kBins; ++bin) {
      if (curve.rows()[row * TravelCurve::kBins + bin] < kNoCost) continue;
      // The smallest gradient that reads this node, or slightly less.
      const double along = (std::abs(bin - TravelCurve::kBins / 2) - 1) / 256.0;
      const double across = (row - 1.0) / TravelCurve::kRowsPerUnit;
      reach = std::min(reach, row > 0 ? std::hypot(std::max(along, 0.0), across) : along);
    }
  return reach;
}

}  // namespace

EdgeSpot edgeSpot(int side, int k, int points) noexcept {
  const double t = (k + 0.5) / points;
  switch (side) {
    case kWestSide:
      return {0.0, t};
    case kEastSide:
      return {1.0, t};
    case kSouthSide:
      return {t, 0.0};
    default:
      return {t, 1.0};
  }
}

EdgeCrossings::EdgeCrossings(const TravelCost& cost, int points, Kernels kernels)
    : cost_(cost),
      points_(points),
      padded_((3 * points + kVector - 1) / kVector * kVector),
      vectors_(vectorsRun(kernels)) {
  for (const TravelCurve& curve : cost.curves()) free_up_to_.push_back(freeUpTo(cost, curve));
  const auto add = [this](End end, double x, double y, double length) {
    ends_.push_back(end);
    x_.push_back(x * CellCode::kStep);
    y_.push_back(y * CellCode::kStep);
    length_.push_back(static_cast<float>(length));
  };
  for (int side = 0; side < 4; ++side)
    for (int k = 0; k < points; ++k) {
      const EdgeSpot a = edgeSpot(side, k, points);
      for (int to = 0; to < 4; ++to)
        for (int l = 0; l < points && to != side; ++l) {
          const EdgeSpot b = edgeSpot(to, l, points);
          const double dx = b.x - a.x, dy = b.y - a.y, length = std::sqrt(dx * dx + dy * dy);
          add({to, l}, dx / length, dy / length, length);
        }
      for (int idle = count(); idle < padded_; ++idle) add({side, k}, 1.0, 0.0, 1.0);
    }
}

void EdgeCrossings::prices(int side, int k, CellCode cell, float here, float* paid) const noexcept {
  const std::size_t at = first(side, k);
  const Motions motions{&x_[at], &y_[at], &length_[at]};
  (vectors_ ? pricesByVector : pricesByScalar)(cost_, cell, here, motions, count(), paid);
}

bool EdgeCrossings::allowed(int side, int k, int i, CellCode cell) const noexcept {
  const std::size_t at = first(side, k) + static_cast<std::size_t>(i);
  return HeadingCost(cost_, x_[at], y_[at])(cell) < kNoCost;
}

bool EdgeCrossings::free(CellCode cell) const noexcept {
  if (cell.curve() >= cost_.curves().size()) return false;
  const double x = cell.dzDx(), y = cell.dzDy(), reach = free_up_to_[cell.curve()];
  return x * x + y * y <= reach * reach;
}

}  // namespace talus::planner
namespace talus::planner {

namespace {

constexpr int kReach = 1;       // positions to each side of a turn
constexpr double kFiner = 0.7;  // factor of the spacing of positions from round to round
constexpr int kPlaces = 2 * kReach + 1;
constexpr double kClear = 1.0 / 64;  // [cells] smallest distance of turns from corners

constexpr double kEnd = 2.0;  // [cells] a step that leaves the ends of a path only their own position

using Turn = EdgePath::Turn;

// Points to which a turn may move; the first of `places` is the present point of the turn.
struct Choice {
  std::array<Turn, kPlaces> places;
  std::array<double, kPlaces> best{};
  std::array<int, kPlaces> next{};
  int count = 0;
};

Choice choiceAround(Turn turn, double step) {
  Choice choice;
  choice.places[static_cast<std::size_t>(choice.count++)] = turn;
  const double at = turn.on_vertical ? turn.y : turn.x, cell = std::floor(at);
  for (int k = 1; k <= kReach; ++k)
    for (const double moved : {at + k * step, at - k * step}) {
      if (moved < cell + kClear || moved > cell + 1.0 - kClear) continue;
      Turn place = turn;
      (turn.on_vertical ? place.y : place.x) = moved;
      choice.places[static_cast<std::size_t>(choice.count++)] = place;
    }
  return choice;
}

// The cell of a motion, and the cells before and after it. A turn on an edge touches both adjacent cells, so
// these must allow the heading, too.
struct Passage {
  costmap::CellCode cell, before, after;
};

// Straight motion between two positions within a cell.
struct Straight {
  HeadingCost cost;
  double length;

  Straight(const costmap::TravelCost& drive, double dx, double dy) noexcept
      : Straight(drive, dx, dy, std::sqrt(dx * dx + dy * dy)) {}
  Straight(const costmap::TravelCost& drive, double dx, double dy, double far) noexcept
      : cost(drive, far > 0.0 ? costmap::Direction{dx / far, dy / far} : costmap::Direction{1.0, 0.0}),
        length(far) {}

  double within(costmap::CellCode cell) const noexcept {
    return length > 0.0 ? length * static_cast<double>(cost(cell)) : 0.0;
  }
  bool mayTurn(const Passage& passage) const noexcept {
    return !(length > 0.0) || (std::isfinite(cost(passage.before)) && std::isfinite(cost(passage.after)));
  }
};

void choose(const costmap::TravelCost& drive, const Passage& passage, Choice& from, const Choice& to) {
  for (std::size_t a = 0; a < static_cast<std::size_t>(from.count); ++a) {
    from.best[a] = kInfinity;
    for (std::size_t b = 0; b < static_cast<std::size_t>(to.count); ++b) {
      const Straight motion(drive, to.places[b].x - from.places[a].x, to.places[b].y - from.places[a].y);
      const double through = motion.within(passage.cell) + to.best[b];
      if (!(through < from.best[a]) || !motion.mayTurn(passage)) continue;
      from.best[a] = through;
      from.next[a] = static_cast<int>(b);
    }
  }
}

std::vector<Passage> passagesOf(const costmap::CostGrid& map, const EdgePath& path) {
  std::vector<Passage> passages;
  const std::size_t n = path.cells.size();
  const auto at = [&](std::size_t k) { return map.at(path.cells[k]); };
  for (std::size_t i = 0; i < n; ++i)
    passages.push_back({at(i), at(i > 0 ? i - 1 : i), at(i + 1 < n ? i + 1 : i)});
  return passages;
}

void slideOnce(const costmap::TravelCost& drive, const std::vector<Passage>& passages, double step,
               std::vector<Choice>& choices, EdgePath& path) {
  const std::size_t n = path.turns.size();
  choices[n - 1] = choiceAround(path.turns[n - 1], kEnd);
  for (std::size_t i = n - 1; i-- > 0;) {
    choices[i] = choiceAround(path.turns[i], i == 0 ? kEnd : step);
    choose(drive, passages[i], choices[i], choices[i + 1]);
  }
  for (std::size_t i = 0, a = 0; i < n; ++i) {
    path.turns[i] = choices[i].places[a];
    a = static_cast<std::size_t>(choices[i].next[a]);
  }
}

using maps::Cell;
using maps::Point;

// Returns the cells along a path, sampled at steps of less than a cell.
std::vector<Cell> cellsOf(const maps::Grid& grid, const std::vector<Point>& along) {
  std::vector<Cell> on;
  const auto add = [&](double x, double y) {
    const Cell c{std::clamp(static_cast<int>(x), 0, grid.width - 1),
                 std::clamp(static_cast<int>(y), 0, grid.height - 1)};
    if (on.empty() || !(on.back() == c)) on.push_back(c);
  };
  const auto inCells = [&](Point p) {
    return EdgeSpot{(p.x_m - grid.south_west.x_m) / grid.resolution_m,
                    (p.y_m - grid.south_west.y_m) / grid.resolution_m};
  };
  EdgeSpot before = inCells(along.front());
  for (const Point p : along) {
    const EdgeSpot here = inCells(p);
    const int steps =
        1 + static_cast<int>(std::max(std::abs(here.x - before.x), std::abs(here.y - before.y)));
    for (int k = 1; k <= steps; ++k)
      add(before.x + (here.x - before.x) * k / steps, before.y + (here.y - before.y) * k / steps);
    before = here;
  }
  return on;
}

using costmap::CellCode;

constexpr float kFar = std::numeric_limits<float>::infinity();
constexpr std::uint32_t kNone = Corridor::kNone;

// Bucket queue of node indices ordered by labels; within a bucket in order of insertion.
class LabelQueue {
 public:
  // `reach` is the largest difference of labels queued at the same time.
  LabelQueue(float width, float reach)
      : per_bucket_(1.0F / width), ring_(std::bit_ceil(static_cast<std::size_t>(reach * per_bucket_) + 2)) {}

  std::size_t bucketOf(float label) const noexcept { return static_cast<std::size_t>(label * per_bucket_); }

  void push(float label, std::uint32_t number) {
    Bucket& bucket = ring_[bucketOf(label) & (ring_.size() - 1)];
    const auto entry = static_cast<std::uint32_t>(entries_.size());
    (bucket.last == kNone ? bucket.first : entries_[bucket.last].next) = entry;
    bucket.last = entry;
    entries_.push_back({number, kNone});
  }

  // Returns true if both labels belong to the same bucket and that bucket was not taken yet.
  bool together(float label, float other) const noexcept {
    return bucketOf(label) == bucketOf(other) && bucketOf(label) > current_;
  }

  // Calls take(node) for every queued node index, including those queued by take(). Entries whose current
  // label(node) belongs to another bucket are skipped.
  template <typename Label, typename Take>
  void run(Label label, Take take) {
    for (std::size_t taken = 0; taken < entries_.size(); ++current_) {
      Bucket& bucket = ring_[current_ & (ring_.size() - 1)];
      for (std::uint32_t e = bucket.first; e != kNone; e = entries_[e].next, ++taken)
        if (bucketOf(label(entries_[e].number)) == current_) take(entries_[e].number);
      bucket = {};
    }
  }

 private:
  struct Bucket {
    std::uint32_t first = kNone, last = kNone;
  };
  struct Entry {
    std::uint32_t number, next;
  };

  float per_bucket_;
  std::size_t current_ = 0;
  std::vector<Bucket> ring_;
  std::vector<Entry> entries_;
};

// Bucket width: at most the cheapest motion between two points, but at least a thousandth of the reach.
LabelQueue queueFor(const CostRange& range, int points) {
  const auto highest = static_cast<float>(range.most_J_per_m * 1.5);  // across a cell
  const auto cheapest = static_cast<float>(range.least_J_per_m * 0.7 / points);
  return {std::max(cheapest, highest / 1000.0F), highest};
}

class EdgePointSearch {
 public:
  EdgePointSearch(const MotionCost& cost, const EdgeCrossings& crossings, Corridor& corridor,
                  LabelQueue queue)
      : cost_(cost),
        grid_(cost.map().grid()),
        points_(crossings.points()),
        shift_(static_cast<int>(std::bit_width(static_cast<unsigned>(2 * points_ - 1)))),
        crossings_(crossings),
        corridor_(corridor),
        paid_(static_cast<std::size_t>(crossings_.count() + EdgeCrossings::kVector)),
        queue_(std::move(queue)) {}

  EdgePath run(const Segment& ends, double below_J);

 private:
  // A point on the edge of a cell of the corridor: index of its node, cells on both sides, map coordinates,
  // and cost [J per metre of cell size] of the first or last motion of the route, which ends at the point.
  struct EdgePoint {
    std::uint32_t node;
    std::size_t cell, beyond;
    Point place;
    float price = kFar;
  };

  // First node of a cell's side; the nodes of a side are consecutive.
  std::uint32_t firstNode(std::size_t cell, int side) const noexcept {
    const std::size_t holder = side == kEastSide || side == kNorthSide ? corridor_.beyond(cell, side) : cell;
    return (corridor_.holder(holder) << shift_) +
           (side >= kSouthSide ? static_cast<std::uint32_t>(points_) : 0U);
  }
  std::vector<EdgePoint> around(Point place);
  EdgePath::Turn turnAt(Point p) const noexcept;
  EdgePath::Turn turnAt(std::uint32_t node) const noexcept;
  float priceOfEnd(const Segment& motion, const EdgePoint& turn) const noexcept;
  void reach(std::uint32_t node, float label, std::uint32_t from, std::size_t cell);
  void settle(std::uint32_t node);
  void cross(std::uint32_t node, std::size_t cell, int side, int k);
  EdgePath pathTo(std::uint32_t node, std::size_t last_cell, const Segment& ends) const;

  const MotionCost& cost_;
  const maps::Grid& grid_;
  int points_;
  int shift_;  // nodes are numbered by holder: 2^shift_ per holder, of which 2 * points_ are used
  const EdgeCrossings& crossings_;
  Corridor& corridor_;
  std::vector<float> paid_;
  LabelQueue queue_;
  std::vector<float> label_, last_;       // by node: cost from the start; cost to the end
  std::vector<std::uint32_t> from_, in_;  // previous node (kNone: the start); local cell crossed
  float below_ = kFar;
};

// The edge points of every cell that the place touches.
std::vector<EdgePointSearch::EdgePoint> EdgePointSearch::around(Point place) {
  std::vector<EdgePoint> found;
  const double x = (place.x_m - grid_.south_west.x_m) / grid_.resolution_m,
               y = (place.y_m - grid_.south_west.y_m) / grid_.resolution_m;
  constexpr double kTouch = 1e-6;
  const auto cellBelow = [](double at) { return static_cast<int>(std::floor(at - kTouch)); };
  const auto cellAbove = [](double at) { return static_cast<int>(std::floor(at + kTouch)); };
  for (int row = cellBelow(y); row <= cellAbove(y); ++row)
    for (int column = cellBelow(x); column <= cellAbove(x); ++column) {
      if (!grid_.contains({column, row})) continue;
      const std::size_t cell = corridor_.local({column, row});
      corridor_.hold(cell);
      for (int side = 0; side < 4; ++side)
        for (int k = 0; k < points_; ++k) {
          const EdgeSpot in = edgeSpot(side, k, points_);
          found.push_back({firstNode(cell, side) + static_cast<std::uint32_t>(k),
                           cell,
                           corridor_.beyond(cell, side),
                           {grid_.south_west.x_m + (column + in.x) * grid_.resolution_m,
                            grid_.south_west.y_m + (row + in.y) * grid_.resolution_m}});
        }
    }
  return found;
}

EdgePath::Turn EdgePointSearch::turnAt(Point p) const noexcept {
  return {(p.x_m - grid_.south_west.x_m) / grid_.resolution_m,
          (p.y_m - grid_.south_west.y_m) / grid_.resolution_m, false};
}

EdgePath::Turn EdgePointSearch::turnAt(std::uint32_t node) const noexcept {
  const Cell c = corridor_.cell(corridor_.held(node >> shift_));
  const int k = static_cast<int>(node & ((1U << shift_) - 1));
  const bool vertical = k < points_;
  const EdgeSpot in = edgeSpot(vertical ? kWestSide : kSouthSide, k % points_, points_);
  return {c.column + in.x, c.row + in.y, vertical};
}

// Returns the cost [J] of the first or last motion divided by the cell size [m]; infinite if the cell beyond
// the edge does not allow the heading.
float EdgePointSearch::priceOfEnd(const Segment& motion, const EdgePoint& turn) const noexcept {
  const double dx = motion.to.x_m - motion.from.x_m, dy = motion.to.y_m - motion.from.y_m;
  const double length = std::hypot(dx, dy);
  if (length > 0.0 &&
      std::isinf(cost_.map().cost().costPerMetre(corridor_.code(turn.beyond), {dx / length, dy / length})))
    return kFar;
  return static_cast<float>(cost_(motion) / grid_.resolution_m);
}

void EdgePointSearch::reach(std::uint32_t node, float label, std::uint32_t from, std::size_t cell) {
  const float before = label_[node];
  if (!(label < before)) return;
  label_[node] = label;
  from_[node] = from;
  in_[node] = static_cast<std::uint32_t>(cell);
  if (before == kFar || !queue_.together(label, before)) queue_.push(label, node);
}

void EdgePointSearch::cross(std::uint32_t node, std::size_t cell, int side, int k) {
  const CellCode code = corridor_.code(cell);
  if (code.curve() >= cost_.map().cost().curves().size()) return;
  crossings_.prices(side, k, code, label_[node], paid_.data());
  // A turn on an edge touches both adjacent cells, so the cells beyond both ends must allow the heading, too.
  const std::size_t before = corridor_.beyond(cell, side);
  const bool before_free = corridor_.free(before);
  for (int to = 0, i = 0; to < 4; ++to) {
    if (to == side) continue;
    const std::size_t after = corridor_.beyond(cell, to);
    const bool both_free = before_free && corridor_.free(after);
    const std::uint32_t first = firstNode(cell, to);
    for (std::uint32_t l = 0; l < static_cast<std::uint32_t>(points_); ++l, ++i) {
      const float through = paid_[static_cast<std::size_t>(i)];
      if (!(through < below_ && through < label_[first + l])) continue;
      if (both_free || (crossings_.allowed(side, k, i, corridor_.code(before)) &&
                        crossings_.allowed(side, k, i, corridor_.code(after))))
        reach(first + l, through, node, cell);
    }
  }
}

void EdgePointSearch::settle(std::uint32_t node) {
  const std::size_t holder = corridor_.held(node >> shift_);
  const int k = static_cast<int>(node & ((1U << shift_) - 1));
  const bool vertical = k < points_;
  const std::size_t before = corridor_.beyond(holder, vertical ? kWestSide : kSouthSide);
  if (in_[node] != holder) cross(node, holder, vertical ? kWestSide : kSouthSide, k % points_);
  if (in_[node] != before) cross(node, before, vertical ? kEastSide : kNorthSide, k % points_);
}

EdgePath EdgePointSearch::pathTo(std::uint32_t node, std::size_t last_cell, const Segment& ends) const {
  EdgePath path;
  path.turns.push_back(turnAt(ends.to));
  path.cells.push_back(corridor_.cell(last_cell));
  for (std::uint32_t at = node; at != kNone; at = from_[at]) {
    path.turns.push_back(turnAt(at));
    path.cells.push_back(corridor_.cell(in_[at]));
  }
  path.turns.push_back(turnAt(ends.from));
  std::reverse(path.turns.begin(), path.turns.end());
  std::reverse(path.cells.begin(), path.cells.end());
  return path;
}

EdgePath EdgePointSearch::run(const Segment& ends, double below_J) {
  const auto firsts = around(ends.from);
  auto lasts = around(ends.to);
  const std::size_t nodes = corridor_.holders() << shift_;
  label_.assign(nodes, kFar);
  last_.assign(nodes, kFar);
  from_.resize(nodes);
  in_.resize(nodes);
  below_ = static_cast<float>(below_J / grid_.resolution_m);
  for (EdgePoint& at : lasts) {
    at.price = priceOfEnd({at.place, ends.to}, at);
    last_[at.node] = std::min(last_[at.node], at.price);
  }
  for (const EdgePoint& at : firsts) {
    const float first = priceOfEnd({ends.from, at.place}, at);
    if (first < below_) reach(at.node, first, kNone, at.cell);
  }
  std::uint32_t best = kNone;
  queue_.run([&](std::uint32_t node) { return label_[node]; },
             [&](std::uint32_t node) {
               if (label_[node] + last_[node] < below_) below_ = label_[node] + last_[node], best = node;
               settle(node);
             });
  if (best == kNone) return {};
  const auto ending = std::ranges::find_if(
      lasts, [&](const EdgePoint& at) { return at.node == best && at.price == last_[best]; });
  return pathTo(best, ending->cell, ends);
}

}  // namespace

std::vector<maps::Point> EdgePath::points(const maps::Grid& grid) const {
  std::vector<maps::Point> points;
  for (const Turn& turn : turns)
    points.push_back(
        {grid.south_west.x_m + turn.x * grid.resolution_m, grid.south_west.y_m + turn.y * grid.resolution_m});
  return points;
}

void slideTurns(const costmap::CostGrid& map, EdgePath& path, double coarsest_cells, int rounds) {
  if (path.turns.size() < 3) return;
  const auto passages = passagesOf(map, path);
  std::vector<Choice> choices(path.turns.size());
  double step = coarsest_cells;
  for (int k = 0; k < rounds; ++k, step *= kFiner) slideOnce(map.cost(), passages, step, choices, path);
}

Corridor::Corridor(const costmap::CostGrid& map, const EdgeCrossings& crossings,
                   const std::vector<Point>& along, int reach_cells)
    : first_{map.grid().width, map.grid().height} {
  const auto on = cellsOf(map.grid(), along);
  Cell last{-1, -1};
  for (const Cell c : on) {
    first_ = {std::min(first_.column, c.column), std::min(first_.row, c.row)};
    last = {std::max(last.column, c.column), std::max(last.row, c.row)};
  }
  const int margin = reach_cells + 2;
  first_ = {first_.column - margin, first_.row - margin};
  columns_ = static_cast<std::size_t>(last.column + margin - first_.column + 1);
  const std::size_t cells = columns_ * static_cast<std::size_t>(last.row + margin - first_.row + 1);
  codes_.assign(cells, costmap::CellCode());
  free_.assign(cells, 0);
  open_.assign(cells, 0);
  holder_.assign(cells, kNone);
  for (const Cell c : on) open(map, crossings, c, reach_cells);
}

void Corridor::open(const costmap::CostGrid& map, const EdgeCrossings& crossings, Cell around,
                    int reach_cells) {
  const int last_row = std::min(around.row + reach_cells, map.grid().height - 1),
            last_column = std::min(around.column + reach_cells, map.grid().width - 1);
  for (int row = std::max(around.row - reach_cells, 0); row <= last_row; ++row)
    for (int column = std::max(around.column - reach_cells, 0); column <= last_column; ++column) {
      const std::size_t at = local({column, row});
      if (open_[at] != 0) continue;
      open_[at] = 1;
      codes_[at] = map.at({column, row});
      free_[at] = crossings.free(codes_[at]) ? 1 : 0;
      hold(at);
    }
}

void Corridor::hold(std::size_t cell) {
  for (const std::size_t each : {cell, cell + 1, cell + columns_}) {
    if (holder_[each] != kNone) continue;
    holder_[each] = static_cast<std::uint32_t>(held_.size());
    held_.push_back(static_cast<std::uint32_t>(each));
  }
}

CorridorSearch::CorridorSearch(const MotionCost& cost, const CorridorOptions& options)
    : cost_(cost),
      options_(options),
      crossings_(cost.map().cost(), options.points_per_edge, options.kernels),
      range_(costRange(cost.map().cost())) {}

EdgePath CorridorSearch::operator()(const std::vector<Point>& along, double below_J) const {
  if (!(range_.most_J_per_m > 0.0)) return {};
  Corridor corridor(cost_.map(), crossings_, along, options_.reach_cells);
  return EdgePointSearch(cost_, crossings_, corridor, queueFor(range_, options_.points_per_edge))
      .run({along.front(), along.back()}, below_J);
}

}  // namespace talus::planner
