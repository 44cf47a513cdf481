#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <talus/costmap/evidence/block_evidence.hpp>
#include <talus/maps/grid/grid.hpp>

namespace talus::costmap {

/// Key of evidence: one terrain class of one block. A block is a square of cells. Columns and rows of blocks
/// count from the map's south-west corner.
struct BlockOfClass {
  int column = 0, row = 0;
  std::uint8_t terrain_class = 0;  ///< number of the terrain class
};

/// The evidence of a map, stored in bricks of 8x8 blocks. Each brick has a sorted list of its blocks with
/// evidence and a sorted list of their readings. A block takes 44 bytes, and 12 bytes for each distinct
/// reading of a drive; a block without evidence takes less than one byte. (For comparison: a leaf of an
/// OctoMap tree takes 64 bytes with its allocation, and its parents another 64.) Not thread-safe while
/// changed; pointers are valid until the next change.
class EvidenceBricks {
 public:
  /// Makes an empty store for a map with this number of block columns and rows.
  EvidenceBricks(int block_columns, int block_rows);

  /// Returns the evidence of a class in a block; null if there is no evidence or the block lies outside the map.
  const BlockEvidence* find(const BlockOfClass& block) const noexcept;
  /// Returns the evidence of find() for modification; creates the evidence if absent. The block must lie
  /// inside the map.
  BlockEvidence& at(const BlockOfClass& block);
  /// Removes evidence that at() created; its readings must have been removed.
  void erase(const BlockOfClass& block);
  /// Returns the readings of a class in a block, sorted by kind, value and drive; empty without readings.
  std::vector<ReadingCount> counts(const BlockOfClass& block) const;
  /// Adds reading.count readings of one kind, value and drive to evidence that at() created; the count
  /// saturates at 65535.
  void count(const BlockOfClass& block, const ReadingCount& reading);
  /// Removes reading.count readings from evidence that at() created. A saturated count (65535) is removed only
  /// by a saturated one; evidence without such readings is not changed.
  void uncount(const BlockOfClass& block, const ReadingCount& reading);

  /// Callback with a key and its evidence.
  using Visit = std::function<void(const BlockOfClass&, const BlockEvidence&)>;

  /// A rectangle of blocks, given by columns and rows, both corners included. The rectangle may extend beyond
  /// the map.
  struct Box {
    int west, south, east, north;
  };
  /// Calls `visit` for the evidence within a box, brick by brick.
  void visit(const Box& box, const Visit& visit) const;
  /// Calls `visit` for all evidence, by ascending row, column and class.
  void visitAll(const Visit& visit) const;

 private:
  struct BlockReadings {
    std::uint32_t block = 0;  // sort key: place in the brick, class
    ReadingCount reading;
  };
  struct Brick {
    std::vector<BlockEvidence> blocks;
    std::vector<BlockReadings> readings;
  };

  bool contains(int column, int row) const noexcept {
    return column >= 0 && row >= 0 && column < columns_ && row < rows_;
  }
  std::size_t brickOf(int column, int row) const noexcept;
  static std::uint64_t orderOf(const BlockReadings& readings) noexcept;
  static std::vector<BlockReadings>::iterator placeOf(std::vector<BlockReadings>& readings,
                                                      const BlockReadings& one);

  int columns_, rows_;
  int brick_columns_;
  std::vector<Brick> bricks_;
};

}  // namespace talus::costmap
