#pragma once

#include <cstdint>
#include <vector>

#include <talus/costmap/cost/travel_cost.hpp>
#include <talus/costmap/ground/ground_model.hpp>

namespace talus::costmap {

/// Returns the heading that determines the category of a cell: straight uphill, or a heading across the slope
/// if its equivalent climb is steeper by more than 1/32.
Direction worstHeading(const TravelCost& cost, CellCode cell) noexcept;

/// Returns the category of ground with the estimate `belief` in one heading, and its probability. `state` is
/// the result of TravelCost::detail() and `climb` the result of TravelCost::climb() for that heading. Ground that is
/// refused (has infinite cost) for a reason other than its category is dangerous.
RankedCategory judged(const GroundModel& model, const GroundBelief& belief, const TravelState& state,
                      double climb);

/// Category of ground of one estimated strength, tabulated over the gradient of the plane of a cell in steps
/// of CellCode. The category is the worst over all headings, and dangerous if worstHeading() is refused. The
/// gradient of a cell is rounded up to a step.
class CategoryTable {
 public:
  /// Table entry for one gradient.
  struct Entry {
    std::uint8_t category;  ///< terramech::Category as a number
    /// Probability of the category in steps of 1/16, rounded to nearest if dangerous and down otherwise.
    std::uint8_t confidence;
  };

  /// Makes a table with the category dangerous at every gradient.
  CategoryTable() = default;
  /// Makes the table of ground with the estimate `belief`; `ground` is the result of GroundModel::ground()
  /// for it.
  CategoryTable(const GroundModel& model, const GroundBelief& belief, const GroundCost& ground);

  /// Returns the entry for the gradient of a cell.
  Entry at(CellCode cell) const noexcept;

 private:
  std::vector<Entry> entries_;
};

}  // namespace talus::costmap
