#pragma once

#include <cstdint>
#include <vector>

#include <talus/costmap/cost/drive_cost.hpp>
#include <talus/costmap/ground/ground_model.hpp>

namespace talus::costmap {

/// The category of one kind of ground over the steepness of its plane: that of the worst heading, which climbs
/// straight up or crosses (CrossSlope::steepest). Tabulated in CellCode's own steps, so it is exact for coded gradients rounded to 1/1024.
class CategoryTable {
 public:
  /// A row of the table.
  struct Entry {
    std::uint8_t category;    ///< terramech::Category as a number
    std::uint8_t confidence;  ///< probability in steps of 1/16, rounded down unless it is of danger
  };

  /// Dangerous at every gradient.
  CategoryTable() = default;
  CategoryTable(const GroundModel& model, const GroundBelief& belief, const CrossSlope& crossing);

  /// The entry for the gradient of a cell.
  Entry at(CellCode cell) const noexcept;

 private:
  std::vector<Entry> entries_;
};

}  // namespace talus::costmap
