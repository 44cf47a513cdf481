#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <talus/costmap/evidence/block_evidence.hpp>
#include <talus/maps/grid/grid.hpp>

namespace talus::costmap {

/// A level of a block and a class of ground on it: columns and rows of blocks count from the map's south-west.
struct BlockLevel {
  int column = 0, row = 0;
  std::uint16_t level = BlockEvidence::kTop;
  std::uint8_t terrain_class = 0;  ///< its number
};

/// The evidence of a map: bricks of 8x8 blocks, each with a sorted list of those that wheels spoke for and one
/// of what each of them heard, so that a block costs 44 bytes and 12 for each distinct reading of a drive, and one where
/// nobody drove less than one. (A leaf of an OctoMap tree costs 64 with its allocation, and its parents as much
/// again.) Not thread-safe while changed; pointers hold until the next change.
class EvidenceBricks {
 public:
  EvidenceBricks(int block_columns, int block_rows);

  /// Evidence of a class on a level of a block; null where there is none or the block lies outside.
  const BlockEvidence* find(const BlockLevel& block) const noexcept;
  /// The same for change, made where there is none; the block must lie inside.
  BlockEvidence& at(const BlockLevel& block);
  /// What it heard, kind by kind, values ascending, of each drive by itself; empty where there is none.
  std::vector<ReadingCount> counts(const BlockLevel& block) const;
  /// Adds so many readings of a kind and value to a block that at() made.
  void count(const BlockLevel& block, const ReadingCount& reading);
  /// Takes them off a block that at() made; nothing where there are none. A count that stopped at 65535 stays.
  void uncount(const BlockLevel& block, const ReadingCount& reading);

  using Visit = std::function<void(const BlockLevel&, const BlockEvidence&)>;

  /// Visits all levels and classes of a block, lowest first and the top last.
  void visitLevels(int column, int row, const Visit& visit) const;
  /// A rectangle of blocks, both corners included; it may reach outside.
  struct Box {
    int west, south, east, north;
  };
  /// Visits the evidence on top within a box, brick by brick.
  void visitTop(const Box& box, const Visit& visit) const;
  /// Visits all of it, in a fixed order.
  void visitAll(const Visit& visit) const;

 private:
  struct BlockReadings {
    std::uint32_t block = 0;  // as sorted: place, level, class
    ReadingCount reading;
  };
  struct Brick {
    std::vector<BlockEvidence> blocks;
    std::vector<BlockReadings> heard;
  };

  bool contains(int column, int row) const noexcept {
    return column >= 0 && row >= 0 && column < columns_ && row < rows_;
  }
  std::size_t brickOf(int column, int row) const noexcept;
  static std::uint64_t orderOf(const BlockReadings& heard) noexcept;
  static std::vector<BlockReadings>::iterator placeOf(std::vector<BlockReadings>& heard,
                                                      const BlockReadings& one);

  int columns_, rows_;
  int brick_columns_;
  std::vector<Brick> bricks_;
};

}  // namespace talus::costmap
