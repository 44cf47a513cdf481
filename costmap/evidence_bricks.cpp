#include <algorithm>
#include <tuple>

#include <talus/costmap/evidence_bricks.hpp>

namespace talus::costmap {
namespace {

constexpr int kShift = 3;  // 8x8 blocks a brick
constexpr int kMask = (1 << kShift) - 1;

std::uint8_t placeOf(int column, int row) noexcept {
  return static_cast<std::uint8_t>((row & kMask) << kShift | (column & kMask));
}

// Order within a brick; `place` alone stands before all its levels.
bool before(const BlockEvidence& a, const std::tuple<std::uint8_t, std::uint16_t>& b) noexcept {
  return std::tuple(a.place_in_brick, a.level) < b;
}

int bricksAcross(int blocks) noexcept {
  return (blocks + kMask) >> kShift;
}

}  // namespace

EvidenceBricks::EvidenceBricks(int block_columns, int block_rows)
    : columns_(block_columns),
      rows_(block_rows),
      brick_columns_(bricksAcross(block_columns)),
      bricks_(static_cast<std::size_t>(brick_columns_) * static_cast<std::size_t>(bricksAcross(block_rows))) {
}

std::size_t EvidenceBricks::brickOf(int column, int row) const noexcept {
  return static_cast<std::size_t>(row >> kShift) * static_cast<std::size_t>(brick_columns_) +
         static_cast<std::size_t>(column >> kShift);
}

const BlockEvidence* EvidenceBricks::find(const BlockLevel& block) const noexcept {
  if (!contains(block.column, block.row)) return nullptr;
  const Brick& brick = bricks_[brickOf(block.column, block.row)];
  const std::tuple key(placeOf(block.column, block.row), block.level);
  const auto found = std::lower_bound(brick.begin(), brick.end(), key, before);
  return found != brick.end() && std::tuple(found->place_in_brick, found->level) == key ? &*found : nullptr;
}

BlockEvidence& EvidenceBricks::at(const BlockLevel& block) {
  Brick& brick = bricks_[brickOf(block.column, block.row)];
  const std::tuple key(placeOf(block.column, block.row), block.level);
  auto found = std::lower_bound(brick.begin(), brick.end(), key, before);
  if (found == brick.end() || std::tuple(found->place_in_brick, found->level) != key)
    found = brick.insert(found, {.level = block.level, .place_in_brick = std::get<0>(key)});
  return *found;
}

std::vector<const BlockEvidence*> EvidenceBricks::levels(int column, int row) const {
  std::vector<const BlockEvidence*> out;
  if (!contains(column, row)) return out;
  const Brick& brick = bricks_[brickOf(column, row)];
  const std::uint8_t place = placeOf(column, row);
  for (auto at = std::lower_bound(brick.begin(), brick.end(), std::tuple(place, std::uint16_t{0}), before);
       at != brick.end() && at->place_in_brick == place; ++at)
    out.push_back(&*at);
  return out;
}

void EvidenceBricks::visitTop(
    const Box& box, const std::function<void(const BlockLevel&, const BlockEvidence&)>& visit) const {
  const int west = std::max(box.west, 0), east = std::min(box.east, columns_ - 1);
  const int south = std::max(box.south, 0), north = std::min(box.north, rows_ - 1);
  for (int y = south >> kShift; y <= north >> kShift; ++y)
    for (int x = west >> kShift; x <= east >> kShift; ++x)
      for (const BlockEvidence& e : bricks_[brickOf(x << kShift, y << kShift)]) {
        const int column = (x << kShift) + (e.place_in_brick & kMask);
        const int row = (y << kShift) + (e.place_in_brick >> kShift);
        if (e.level == BlockEvidence::kTop && column >= west && column <= east && row >= south &&
            row <= north)
          visit({column, row, e.level}, e);
      }
}

}  // namespace talus::costmap
