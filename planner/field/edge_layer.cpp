#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include <talus/common/parallel_for.hpp>
#include <talus/planner/field/edge_layer.hpp>

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
