#include <numbers>
#include <utility>

#include <talus/common/parallel_for.hpp>
#include <talus/planner/field/edge_layer.hpp>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace talus::planner {
namespace {

using costmap::CellCode;
using costmap::TravelCost;
using costmap::TravelCurve;

constexpr double kDiagonal = std::numbers::sqrt2 / 2;
constexpr float kInfinite = std::numeric_limits<float>::infinity();

// Joules per unit. The unit is chosen such that the costliest diagonal half step just fits; the cheapest
// straight half step is kept between 32 and 2048 units. A coarser unit would impair the search, a finer unit
// would overflow 32 bits along a route.
double unitFor(const CostRange& range, double resolution_m) {
  if (!(range.most_J_per_m > 0.0)) return 1.0;
  const double least = std::max(range.least_J_per_m, range.most_J_per_m * 1e-6);
  const double cheapest_J = 0.5 * resolution_m * least;
  const double fitting = EdgeUnits::kHighest / (std::numbers::sqrt2 * range.most_J_per_m / least);
  return cheapest_J / std::clamp(fitting, 32.0, 2048.0);
}

std::uint16_t inUnits(float cost_J_per_m, double units_per_J_per_m) {
  if (!std::isfinite(cost_J_per_m)) return EdgeUnits::kBlocked;
  const double units = std::round(static_cast<double>(cost_J_per_m) * units_per_J_per_m);
  return static_cast<std::uint16_t>(std::clamp(units, 1.0, static_cast<double>(EdgeUnits::kHighest)));
}

// Returns the largest number of gradient steps within the limit. A diagonal's gradient stays below the limit
// by more than the rounding error, so that a step allowed on the grid is also allowed as an exact segment.
int stepsWithin(double limit, double per_step) {
  const int most = 2 * 2048;
  const double clear = per_step == 1.0 ? limit : limit - 1e-9;
  int steps = 0;
  while (steps < most && (steps + 1) * per_step * CellCode::kStep <= clear) ++steps;
  return steps;
}

// Packs a node coordinate >= 0 as an offset and a 16-bit interpolation weight.
std::uint64_t placed(double place, int stride, int shift) {
  const TravelCurve::Between at = TravelCurve::between(place);
  constexpr int kShares = 128;
  const int share = std::clamp(static_cast<int>(std::lround(at.share * kShares)), 1, kShares - 1);
  return static_cast<std::uint64_t>(at.whole * stride) |
         static_cast<std::uint64_t>(at.share > 0.0F ? share : 0) << shift;
}

}  // namespace

CostRange costRange(const costmap::TravelCost& cost) {
  CostRange range;
  constexpr int kBins = costmap::TravelCurve::kBins;
  for (const auto& curve : cost.curves())
    for (int i = 0; i < (curve.lastRow() + 1) * kBins; ++i) {
      const auto value = static_cast<double>(curve.rows()[i]);
      const double gradient = costmap::TravelCurve::gradient(i % kBins);
      // The node just beyond the limit is included, because costs between the last node within the limit and
      // that node are interpolated.
      if (!std::isfinite(value) || std::abs(gradient) >= cost.limits().max_along + 1.0 / 256) continue;
      range.least_J_per_m = std::min(range.least_J_per_m, value);
      range.most_J_per_m = std::max(range.most_J_per_m, value);
    }
  return range;
}

EdgeUnits::Places EdgeUnits::places(const TravelCost::Limits& limits, double per_step, int shift) const {
  const int most = per_step == 1.0 ? 2048 : 4096;  // range of CellCode's steps
  const int along = stepsWithin(limits.max_along, per_step),
            across = stepsWithin(limits.max_across, per_step);
  Places all{.along = {}, .across = {}, .middle = most};
  for (int steps = -most; steps <= most; ++steps) {
    const double bin = steps * per_step / 4.0 + reach_, row = std::abs(steps) * per_step / 16.0;
    const auto offset = static_cast<Place>(shift);
    all.along.push_back(std::abs(steps) <= along ? offset + placed(bin, 1, 32) : offset | kRefusedAlong);
    all.across.push_back(std::abs(steps) <= across ? placed(row, 2 * width(), 48) : kRefusedAcross);
  }
  return all;
}

EdgeUnits::EdgeUnits(const TravelCost& cost, double resolution_m, double coarsening) {
  const CostRange range = costRange(cost);
  const auto& limits = cost.limits();
  unit_J_ = unitFor(range, resolution_m) * coarsening;
  const auto most = [](double limit, double per_unit) {
    return static_cast<int>(std::ceil(std::min(limit, 2.0) * per_unit));
  };
  reach_ = most(limits.max_along, TravelCurve::kBinsPerUnit);
  straight_ = places(limits, 1.0, 0);
  diagonal_ = places(limits, kDiagonal, width());
  const int rows = most(limits.max_across, TravelCurve::kRowsPerUnit) + 1;
  const double straight_units = 0.5 * resolution_m / unit_J_;
  std::vector<std::uint16_t> halves(static_cast<std::size_t>(2 * reach_ + 1));
  for (const auto& curve : cost.curves()) {
    first_.push_back(static_cast<std::uint32_t>(pairs_.size()));
    for (int row = 0; row <= rows; ++row) {
      if (row > curve.lastRow()) {  // equal to the last row
        const auto stride = static_cast<std::ptrdiff_t>(2 * width());
        pairs_.resize(pairs_.size() + static_cast<std::size_t>(stride));
        std::copy_n(pairs_.end() - 2 * stride, stride, pairs_.end() - stride);
        continue;
      }
      for (const double units : {straight_units, straight_units * std::numbers::sqrt2}) {
        for (std::size_t i = 0; i < halves.size(); ++i) {
          const int bin = static_cast<int>(i) - reach_ + TravelCurve::kBins / 2;
          const bool inside = bin >= 0 && bin < TravelCurve::kBins;
          halves[i] = inUnits(inside ? curve.rows()[row * TravelCurve::kBins + bin] : kInfinite, units);
        }
        for (std::size_t i = 0; i < halves.size(); ++i)
          pairs_.push_back(halves[i] | static_cast<std::uint32_t>(halves[halves.size() - 1 - i]) << 16);
        pairs_.push_back(~std::uint32_t{0});
      }
    }
  }
  cheapest_edge_ = std::isfinite(range.least_J_per_m)
                       ? std::max(2U, 2U * static_cast<unsigned>(inUnits(
                                               static_cast<float>(range.least_J_per_m), straight_units)))
                       : 1U;
}

void EdgeUnits::halves(const CellCode* cells, std::size_t count, Halves* out,
                       bool by_vectors) const noexcept {
  if (by_vectors) return halvesByVector(cells, count, out);
  for (std::size_t i = 0; i < count; ++i) out[i] = halves(cells[i]);
}

#if defined(__x86_64__)
// Four 64-bit lanes of 16-bit numbers: the headings from east to north-west, each with its opposite.
__attribute__((target("avx2"))) void EdgeUnits::halvesByVector(const CellCode* cells, std::size_t count,
                                                               Halves* out) const noexcept {
  const __m128i blocked = _mm_set1_epi32(-1);
  const __m128i headings_first = _mm_setr_epi8(0, 1, 4, 5, 8, 9, 12, 13, 2, 3, 6, 7, 10, 11, 14, 15);
  // Arranges (ahead, back) of two nodes as (ahead, ahead, back, back); repeats the weights four times.
  const __m256i by_direction = _mm256_broadcastsi128_si256(
                    _mm_setr_epi8(0, 1, 4, 5, 2, 3, 6, 7, 8, 9, 12, 13, 10, 11, 14, 15)),
                of_bin = _mm256_broadcastsi128_si256(
                    _mm_setr_epi8(4, 5, 4, 5, 4, 5, 4, 5, 12, 13, 12, 13, 12, 13, 12, 13)),
                of_row = _mm256_broadcastsi128_si256(
                    _mm_setr_epi8(6, 7, 6, 7, 6, 7, 6, 7, 14, 15, 14, 15, 14, 15, 14, 15));
  const __m256i none = _mm256_setzero_si256(), all = _mm256_set1_epi16(kShares),
                here = _mm256_set1_epi32(kShares), to_next = _mm256_set1_epi32(0x0001ffff),
                half = _mm256_set1_epi32(1 << (2 * kShareBits - 1)), stopped = _mm256_set1_epi32(0xffff);
  const std::size_t next_row = 2 * static_cast<std::size_t>(width());
  for (std::size_t i = 0; i < count; ++i) {
    const CellCode cell = cells[i];
    __m128i made = blocked;
    if (cell.curve() < first_.size()) {
      const std::uint32_t* curve = pairs_.data() + first_[cell.curve()];
      const std::array<Place, 4> places = placesOf(cell);
      const auto nodes = [&](std::size_t row) __attribute__((target("avx2"))) {
        const auto two = [&](std::size_t k) __attribute__((target("avx2"))) {
          const auto at = [&](std::size_t lane) __attribute__((target("avx2"))) {
            return _mm_loadl_epi64(
                reinterpret_cast<const __m128i*>(curve + static_cast<std::uint32_t>(places[lane]) + row));
          };
          return _mm_unpacklo_epi64(at(k), at(k + 1));
        };
        return _mm256_shuffle_epi8(_mm256_inserti128_si256(_mm256_castsi128_si256(two(0)), two(2), 1),
                                   by_direction);
      };
      const __m256i low = nodes(0), high = nodes(next_row);
      const auto two = [&](std::size_t k)
          __attribute__((target("avx2"))) {  // built from registers: a load would wait for both stores
        return _mm_unpacklo_epi64(_mm_cvtsi64_si128(static_cast<long long>(places[k])),
                                  _mm_cvtsi64_si128(static_cast<long long>(places[k + 1])));
      };
      const __m256i place = _mm256_inserti128_si256(_mm256_castsi128_si256(two(0)), two(2), 1);
      const __m256i bin = _mm256_shuffle_epi8(place, of_bin), row = _mm256_shuffle_epi8(place, of_row);
      // Weights of this node and the next node, twice.
      const __m256i bins = _mm256_add_epi16(here, _mm256_sign_epi16(bin, to_next));
      const __m256i low_weights = _mm256_mullo_epi16(bins, _mm256_sub_epi16(all, row)),
                    high_weights = _mm256_mullo_epi16(bins, row);
      const __m256i sum = _mm256_srli_epi32(
          _mm256_add_epi32(
              _mm256_add_epi32(_mm256_madd_epi16(low, low_weights), _mm256_madd_epi16(high, high_weights)),
              half),
          2 * kShareBits);
      // kBlocked is -1 as a signed number; a blocked node of weight 0 is ignored.
      const __m256i stops = _mm256_or_si256(
          _mm256_and_si256(_mm256_cmpgt_epi16(none, low), _mm256_cmpgt_epi16(low_weights, none)),
          _mm256_and_si256(_mm256_cmpgt_epi16(none, high), _mm256_cmpgt_epi16(high_weights, none)));
      const __m256i refused = _mm256_srai_epi16(_mm256_or_si256(bin, row), 15);
      const __m256i free = _mm256_cmpeq_epi32(_mm256_or_si256(stops, refused), none);
      const __m256i priced = _mm256_blendv_epi8(stopped, sum, free);
      const __m256i packed = _mm256_packus_epi32(priced, priced);
      made = _mm_unpacklo_epi64(_mm256_castsi256_si128(packed), _mm256_extracti128_si256(packed, 1));
    }
    _mm_storeu_si128(reinterpret_cast<__m128i*>(out[i].data()), _mm_shuffle_epi8(made, headings_first));
  }
}
#else
void EdgeUnits::halvesByVector(const CellCode* cells, std::size_t count, Halves* out) const noexcept {
  halves(cells, count, out, false);
}
#endif

bool EdgeUnits::extends(const EdgeUnits& older) const noexcept {
  const auto begins = [](const auto& longer, const auto& shorter) {
    return longer.size() >= shorter.size() && std::equal(shorter.begin(), shorter.end(), longer.begin());
  };
  return unit_J_ == older.unit_J_ && reach_ == older.reach_ && cheapest_edge_ == older.cheapest_edge_ &&
         straight_.along == older.straight_.along && straight_.across == older.straight_.across &&
         begins(pairs_, older.pairs_) && begins(first_, older.first_);
}

}  // namespace talus::planner

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace talus::planner {
namespace {

using Halves = EdgeUnits::Halves;

constexpr Halves allBlocked() noexcept {
  Halves halves{};
  halves.fill(EdgeUnits::kBlocked);
  return halves;
}

// First of the contiguous cells of a tile's row, beginning at cell c.
const costmap::CellCode& cellAt(const costmap::CostGrid& map, maps::Cell c) noexcept {
  const auto tile = static_cast<std::size_t>((c.row >> 6) * map.tileColumns() + (c.column >> 6));
  return map.content().tiles.tile(tile).cells[static_cast<std::size_t>((c.row & 63) << 6 | (c.column & 63))];
}

// Half-step costs of one row, from column first - 1 to last + 1; blocked outside the map.
void fillRow(const costmap::CostGrid& map, const EdgeUnits& units, int row, CellBox box, bool by_vectors,
             std::vector<Halves>& halves) {
  const int width = map.grid().width, first = box.first.column - 1, last = box.last.column + 1;
  if (row < 0 || row >= map.grid().height) return std::fill(halves.begin(), halves.end(), allBlocked());
  if (first < 0) halves.front() = allBlocked();
  if (last >= width) halves.back() = allBlocked();
  for (int column = std::max(first, 0); column <= std::min(last, width - 1);) {
    const int tile_end = std::min({(column | (costmap::CostTile::kSide - 1)) + 1, last + 1, width});
    units.halves(&cellAt(map, {column, row}), static_cast<std::size_t>(tile_end - column),
                 &halves[static_cast<std::size_t>(column - first)], by_vectors);
    column = tile_end;
  }
}

std::uint16_t sum(std::uint16_t a, std::uint16_t b) noexcept {
  return a == EdgeUnits::kBlocked || b == EdgeUnits::kBlocked ? EdgeUnits::kBlocked
                                                              : static_cast<std::uint16_t>(a + b);
}

using ThreeRows = std::array<const Halves*, 3>;

// The eight steps into the middle cell of three rows of half-step costs.
void stepsInto(const ThreeRows& rows, std::uint16_t* into) noexcept {
  const auto at = [&](maps::Cell step) -> const Halves& {
    return rows[static_cast<std::size_t>(step.row + 1)][step.column];
  };
  for (std::size_t k = 0; k < 8; ++k) {
    const auto heading = static_cast<std::size_t>(opposite(static_cast<int>(k)));
    const maps::Cell step = kStep[k];
    into[k] = sum(at({0, 0})[heading], at(step)[heading]);
    const bool beside_blocked = at({step.column, 0})[heading] == EdgeUnits::kBlocked ||
                                at({0, step.row})[heading] == EdgeUnits::kBlocked;
    if (beside_blocked) into[k] = EdgeUnits::kBlocked;
  }
}

// The steps into `count` consecutive cells.
void rowInto(ThreeRows rows, std::size_t count, std::uint16_t* into) noexcept {
  for (; count-- > 0; into += 8, ++rows[0], ++rows[1], ++rows[2]) stepsInto(rows, into);
}

#if defined(__x86_64__)
// The steps into one cell with SSE4.1. Lane k holds heading k; the final shuffle reorders lanes from the
// heading of the step to the direction of the neighbour.
__attribute__((target("sse4.1"))) void stepsIntoByVector(const ThreeRows& rows,
                                                         std::uint16_t* into) noexcept {
  const auto at = [&rows](int row, int column) __attribute__((target("sse4.1"))) {
    return _mm_loadu_si128(
        reinterpret_cast<const __m128i*>(rows[static_cast<std::size_t>(row + 1)] + column));
  };
  const __m128i east = at(0, 1), north = at(1, 0), west = at(0, -1), south = at(-1, 0);
  __m128i from = _mm_blend_epi16(west, at(-1, -1), 1 << kNorthEast);
  from = _mm_blend_epi16(from, south, 1 << kNorth);
  from = _mm_blend_epi16(from, at(-1, 1), 1 << kNorthWest);
  from = _mm_blend_epi16(from, east, 1 << kWest);
  from = _mm_blend_epi16(from, at(1, 1), 1 << kSouthWest);
  from = _mm_blend_epi16(from, north, 1 << kSouth);
  from = _mm_blend_epi16(from, at(1, -1), 1 << kSouthEast);
  const __m128i blocked = _mm_set1_epi16(-1);
  const __m128i beside_x = _mm_blend_epi16(west, east, 1 << kNorthWest | 1 << kSouthWest);
  const __m128i beside_y = _mm_blend_epi16(south, north, 1 << kSouthWest | 1 << kSouthEast);
  const __m128i diagonals = _mm_set1_epi32(-0x10000);
  const __m128i cut = _mm_and_si128(
      diagonals, _mm_or_si128(_mm_cmpeq_epi16(beside_x, blocked), _mm_cmpeq_epi16(beside_y, blocked)));
  const __m128i steps =
      _mm_or_si128(cut, _mm_adds_epu16(at(0, 0), from));  // saturating: blocked plus any cost stays blocked
  _mm_storeu_si128(reinterpret_cast<__m128i*>(into), _mm_shuffle_epi32(steps, _MM_SHUFFLE(1, 0, 3, 2)));
}

__attribute__((target("sse4.1"))) void rowIntoByVector(ThreeRows rows, std::size_t count,
                                                       std::uint16_t* into) noexcept {
  for (; count-- > 0; into += 8, ++rows[0], ++rows[1], ++rows[2]) stepsIntoByVector(rows, into);
}
#else
constexpr auto rowIntoByVector = rowInto;
#endif

}  // namespace

EdgeLayer::EdgeLayer(std::shared_ptr<const costmap::CostGrid> map, const EdgeUnits& units, int threads,
                     const StopCheck& stop, Kernels kernels)
    : map_(std::move(map)),
      units_(units),
      padded_{map_->grid().width, map_->grid().height},
      edges_(makeLargeArray<std::uint16_t>(8 * padded_.size())),
      vectors_(vectorsRun(kernels)) {
  blockBorder();
  constexpr int kBlock = 64;
  const auto blocks = static_cast<std::size_t>((padded_.height + kBlock - 1) / kBlock);
  parallelFor(blocks, threads, [&](std::size_t k) {
    const int row = kBlock * static_cast<int>(k);
    if (!stop()) buildRows({{0, row}, {padded_.width - 1, std::min(row + kBlock, padded_.height) - 1}});
  });
  complete_ = !stop();
}

EdgeLayer::EdgeLayer(std::shared_ptr<const costmap::CostGrid> map, const EdgeUnits& units, Unfilled points)
    : map_(std::move(map)),
      units_(units),
      padded_{points.width, points.height},
      edges_(makeLargeArray<std::uint16_t>(8 * padded_.size())),
      complete_(true) {
  blockBorder();
}

void EdgeLayer::blockBorder() {
  const auto block = [this](maps::Cell c) { std::fill_n(edges_.get() + 8 * padded_.index(c), 8, kBlocked); };
  for (int column = -1; column <= padded_.width; ++column)
    block({column, -1}), block({column, padded_.height});
  for (int row = 0; row < padded_.height; ++row) block({-1, row}), block({padded_.width, row});
}

void EdgeLayer::buildRows(CellBox box) {
  const auto width = static_cast<std::size_t>(box.last.column - box.first.column + 3);
  std::array<std::vector<Halves>, 3> rows{std::vector<Halves>(width), std::vector<Halves>(width),
                                          std::vector<Halves>(width)};
  const auto combine = vectors_ ? rowIntoByVector : rowInto;
  fillRow(*map_, units_, box.first.row - 1, box, vectors_, rows[0]);
  fillRow(*map_, units_, box.first.row, box, vectors_, rows[1]);
  for (int row = box.first.row; row <= box.last.row; ++row) {
    fillRow(*map_, units_, row + 1, box, vectors_, rows[2]);
    combine({&rows[0][1], &rows[1][1], &rows[2][1]}, width - 2,
            edges_.get() + 8 * padded_.index({box.first.column, row}));
    std::rotate(rows.begin(), rows.begin() + 1, rows.end());
  }
}

void EdgeLayer::update(std::shared_ptr<const costmap::CostGrid> newer, const EdgeUnits& units,
                       CellBox changed) {
  map_ = std::move(newer);
  units_ = units;
  buildRows(grown(changed, 1, padded_));
}

std::optional<CellBox> changedCells(const costmap::CostGrid& old, const costmap::CostGrid& newer) {
  constexpr int kSide = costmap::CostTile::kSide;
  const maps::Grid& grid = old.grid();
  CellBox box{{grid.width, grid.height}, {-1, -1}};
  for (std::size_t t = 0; t < old.content().tiles.size(); ++t) {
    if (old.content().tiles[t] == newer.content().tiles[t]) continue;
    const int row0 = static_cast<int>(t) / old.tileColumns() * kSide,
              column0 = static_cast<int>(t) % old.tileColumns() * kSide;
    for (int row = row0; row < std::min(row0 + kSide, grid.height); ++row)
      for (int column = column0; column < std::min(column0 + kSide, grid.width); ++column) {
        if (old.at({column, row}) == newer.at({column, row})) continue;
        box.first = {std::min(box.first.column, column), std::min(box.first.row, row)};
        box.last = {std::max(box.last.column, column), std::max(box.last.row, row)};
      }
  }
  if (box.last.column < 0) return std::nullopt;
  return box;
}

}  // namespace talus::planner
