#pragma once

#include <cstdint>
#include <vector>

#include <talus/costmap/cost/drive_cost.hpp>
#include <talus/costmap/ground/ground_model.hpp>

namespace talus::costmap {

/// The gradient straight up that leaves as little as a cell's plane does in a heading; that along where its ground has no soil.
double climbAt(const DriveCost& cost, CellCode cell, const Direction& heading) noexcept;

/// The heading that a cell is judged by where none is asked for: straight up its plane, or that across which clearly
/// leaves less.
Direction worstHeading(const DriveCost& cost, CellCode cell) noexcept;

/// Category of ground in a heading as planners read it, and its probability: `state` is DriveCost::detail() there, `climb`
/// climbAt(). What is refused for another reason than its category is dangerous.
Ranked judged(const GroundModel& model, const GroundBelief& belief, const DriveState& state, double climb);

/// The category of one kind of ground over the steepness of its plane, in CellCode's own steps: the worst that planners read
/// of any heading, and dangerous where worstHeading() is refused. A cell has that of the next whole step.
class CategoryTable {
 public:
  /// A row of the table.
  struct Entry {
    std::uint8_t category;    ///< terramech::Category as a number
    std::uint8_t confidence;  ///< probability in steps of 1/16, rounded down unless it is of danger
  };

  /// Dangerous at every gradient.
  CategoryTable() = default;
  /// Of ground that was made from the belief.
  CategoryTable(const GroundModel& model, const GroundBelief& belief, const DriveGround& ground);

  /// The entry for the gradient of a cell.
  Entry at(CellCode cell) const noexcept;

 private:
  std::vector<Entry> entries_;
};

}  // namespace talus::costmap
