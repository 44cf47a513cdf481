#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <talus/maps/grid.hpp>

namespace talus::costmap {

/// What the wheels told of one block of ground on one level.
struct BlockEvidence {
  static constexpr std::uint16_t kTop = 0xffff;  ///< the level that a map's elevation shows

  float weight = 0.0F;              ///< samples, each weighed by its certainty [-]
  float pull = 0.0F;                ///< their weighed mean of drawbar pull over load [-]
  float sinkage = 0.0F;             ///< their weighed mean of sinkage over radius [-]
  std::uint32_t updated_s = 0;      ///< telemetry time of the newest sample, rounded down [s]
  std::uint16_t level = kTop;       ///< kTop, or the octree's height key of a floor beneath it
  std::uint8_t terrain_class = 0;   ///< number of the class that it speaks for
  std::uint8_t place_in_brick = 0;  ///< the store's own
};
static_assert(sizeof(BlockEvidence) == 20);

/// A level of a block: columns and rows of blocks count from the map's south-west.
struct BlockLevel {
  int column = 0, row = 0;
  std::uint16_t level = BlockEvidence::kTop;
};

/// The evidence of a map: bricks of 8x8 blocks, each a sorted list of those that wheels spoke for, so that a
/// block costs 20 bytes and one where nobody drove an eighth of one. (A leaf of an OctoMap tree costs 64 with
/// its allocation, and its parents as much again.) Not thread-safe while changed; pointers hold until at().
class EvidenceBricks {
 public:
  EvidenceBricks(int block_columns, int block_rows);

  /// Evidence of a block on a level; null where there is none or the block lies outside.
  const BlockEvidence* find(const BlockLevel& block) const noexcept;
  /// The same for change, made where there is none; the block must lie inside.
  BlockEvidence& at(const BlockLevel& block);
  /// All levels of a block, lowest first and the top last.
  std::vector<const BlockEvidence*> levels(int column, int row) const;
  /// A rectangle of blocks, both corners included; it may reach outside.
  struct Box {
    int west, south, east, north;
  };
  /// Visits the evidence on top within a box, brick by brick.
  void visitTop(const Box& box,
                const std::function<void(const BlockLevel&, const BlockEvidence&)>& visit) const;

 private:
  using Brick = std::vector<BlockEvidence>;

  bool contains(int column, int row) const noexcept {
    return column >= 0 && row >= 0 && column < columns_ && row < rows_;
  }
  std::size_t brickOf(int column, int row) const noexcept;

  int columns_, rows_;
  int brick_columns_;
  std::vector<Brick> bricks_;
};

}  // namespace talus::costmap
