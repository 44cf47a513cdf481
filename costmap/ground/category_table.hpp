#pragma once

#include <cstdint>
#include <vector>

#include <talus/costmap/cost/travel_cost.hpp>
#include <talus/costmap/ground/ground_model.hpp>

namespace talus::costmap {

/// Returns the gradient of the straight climb with the same strength reserve as the plane of a cell in a
/// heading; the gradient along for ground without a soil.
double climbAt(const TravelCost& cost, CellCode cell, const Direction& heading) noexcept;

/// Returns the heading that determines the category of a cell: straight uphill, or a heading across the slope
/// if its equivalent climb is steeper by more than 1/32.
Direction worstHeading(const TravelCost& cost, CellCode cell) noexcept;

/// Returns the category of ground in a heading, and its probability. `state` is TravelCost::detail() and
/// `climb` is climbAt() for that heading. Ground refused for a reason other than its category is dangerous.
RankedCategory judged(const GroundModel& model, const GroundBelief& belief, const TravelState& state,
                      double climb);

/// Category of one kind of ground over the gradient of its plane, in steps of CellCode: the worst category
/// over all headings; dangerous if worstHeading() is refused. The gradient of a cell is rounded up to a step.
class CategoryTable {
 public:
  /// Table entry for one gradient.
  struct Entry {
    std::uint8_t category;    ///< terramech::Category as a number
    std::uint8_t confidence;  ///< probability in steps of 1/16; dangerous: rounded to nearest, else down
  };

  /// Makes a table that is dangerous at every gradient.
  CategoryTable() = default;
  /// Table of the ground that GroundModel made from the estimate.
  CategoryTable(const GroundModel& model, const GroundBelief& belief, const GroundCost& ground);

  /// Entry for the gradient of a cell.
  Entry at(CellCode cell) const noexcept;

 private:
  std::vector<Entry> entries_;
};

}  // namespace talus::costmap
