#include <algorithm>
#include <limits>

#include <talus/costmap/evidence/evidence_bricks.hpp>

namespace talus::costmap {
namespace {

constexpr int kShift = 3;  // log2 of the side of a brick in blocks
constexpr int kMask = (1 << kShift) - 1;

// Sort key within a brick: place, class.
std::uint32_t keyOf(const BlockOfClass& block) noexcept {
  const auto place = static_cast<std::uint32_t>((block.row & kMask) << kShift | (block.column & kMask));
  return place << 8 | block.terrain_class;
}
std::uint32_t keyOf(const BlockEvidence& e) noexcept {
  return static_cast<std::uint32_t>(e.place_in_brick) << 8 | e.terrain_class;
}

bool before(const BlockEvidence& e, std::uint32_t key) noexcept {
  return keyOf(e) < key;
}

// Grows the capacity by 1/8: doubling would leave up to half of the memory of a large map unused.
template <typename T>
void makeRoom(std::vector<T>& list) {
  if (list.size() == list.capacity()) list.reserve(list.size() + 4 + list.size() / 8);
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

const BlockEvidence* EvidenceBricks::find(const BlockOfClass& block) const noexcept {
  if (!contains(block.column, block.row)) return nullptr;
  const auto& blocks = bricks_[brickOf(block.column, block.row)].blocks;
  const std::uint32_t key = keyOf(block);
  const auto found = std::lower_bound(blocks.begin(), blocks.end(), key, before);
  return found != blocks.end() && keyOf(*found) == key ? &*found : nullptr;
}

BlockEvidence& EvidenceBricks::at(const BlockOfClass& block) {
  auto& blocks = bricks_[brickOf(block.column, block.row)].blocks;
  const std::uint32_t key = keyOf(block);
  auto found = std::lower_bound(blocks.begin(), blocks.end(), key, before);
  if (found != blocks.end() && keyOf(*found) == key) return *found;
  const auto place = found - blocks.begin();
  makeRoom(blocks);
  return *blocks.insert(blocks.begin() + place, {.terrain_class = block.terrain_class,
                                                 .place_in_brick = static_cast<std::uint8_t>(key >> 8)});
}

void EvidenceBricks::erase(const BlockOfClass& block) {
  std::erase_if(bricks_[brickOf(block.column, block.row)].blocks,
                [key = keyOf(block)](const BlockEvidence& e) { return keyOf(e) == key; });
}

std::vector<ReadingCount> EvidenceBricks::counts(const BlockOfClass& block) const {
  std::vector<ReadingCount> out;
  if (!contains(block.column, block.row)) return out;
  const auto& readings = bricks_[brickOf(block.column, block.row)].readings;
  const std::uint32_t key = keyOf(block);
  const auto first = std::lower_bound(readings.begin(), readings.end(), key,
                                      [](const BlockReadings& h, std::uint32_t k) { return h.block < k; });
  for (auto at = first; at != readings.end() && at->block == key; ++at) out.push_back(at->reading);
  return out;
}

std::uint64_t EvidenceBricks::orderOf(const BlockReadings& readings) noexcept {
  return static_cast<std::uint64_t>(readings.block) << 32 |
         static_cast<std::uint64_t>(readings.reading.kind) << 24 |
         static_cast<std::uint64_t>(readings.reading.step) << 16 | readings.reading.drive;
}

// Position of a count in the sorted list, or the position at which to insert the count.
std::vector<EvidenceBricks::BlockReadings>::iterator EvidenceBricks::placeOf(
    std::vector<BlockReadings>& readings, const BlockReadings& one) {
  return std::lower_bound(readings.begin(), readings.end(), orderOf(one),
                          [](const BlockReadings& h, std::uint64_t key) { return orderOf(h) < key; });
}

void EvidenceBricks::uncount(const BlockOfClass& block, const ReadingCount& reading) {
  auto& readings = bricks_[brickOf(block.column, block.row)].readings;
  const BlockReadings taken{keyOf(block), reading};
  const auto found = placeOf(readings, taken);
  if (found == readings.end() || orderOf(*found) != orderOf(taken)) return;
  std::uint16_t& count = found->reading.count;
  if (count == std::numeric_limits<std::uint16_t>::max() && reading.count < count) return;
  count = static_cast<std::uint16_t>(count - std::min(count, reading.count));
  if (count == 0) readings.erase(found);
}

void EvidenceBricks::count(const BlockOfClass& block, const ReadingCount& reading) {
  auto& readings = bricks_[brickOf(block.column, block.row)].readings;
  const BlockReadings added{keyOf(block), reading};
  const auto found = placeOf(readings, added);
  if (found != readings.end() && orderOf(*found) == orderOf(added)) {
    const unsigned sum = found->reading.count + static_cast<unsigned>(reading.count);
    found->reading.count =
        static_cast<std::uint16_t>(std::min<unsigned>(sum, std::numeric_limits<std::uint16_t>::max()));
    return;
  }
  const auto at = found - readings.begin();
  makeRoom(readings);
  readings.insert(readings.begin() + at, added);
}

void EvidenceBricks::visit(const Box& box, const Visit& visit) const {
  const int west = std::max(box.west, 0), east = std::min(box.east, columns_ - 1);
  const int south = std::max(box.south, 0), north = std::min(box.north, rows_ - 1);
  for (int y = south >> kShift; y <= north >> kShift; ++y)
    for (int x = west >> kShift; x <= east >> kShift; ++x)
      for (const BlockEvidence& e : bricks_[brickOf(x << kShift, y << kShift)].blocks) {
        const int column = (x << kShift) + (e.place_in_brick & kMask);
        const int row = (y << kShift) + (e.place_in_brick >> kShift);
        if (column >= west && column <= east && row >= south && row <= north)
          visit({column, row, e.terrain_class}, e);
      }
}

void EvidenceBricks::visitAll(const Visit& visit) const {
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column) this->visit({column, row, column, row}, visit);
}

}  // namespace talus::costmap
