#pragma once

#include <cstdint>
#include <limits>
#include <memory>

#include <talus/costmap/cost/cost_grid.hpp>

namespace talus::planner {

/// Summary of a cost-grid cell over all headings, for planners without headings.
struct CellJudgement {
  /// Restriction of the headings on which the rover may cross the cell.
  enum class Kind : std::uint8_t {
    Unknown,     ///< the cell was not observed, and the policy of the map does not permit unknown ground
    Refused,     ///< no heading is allowed
    Restricted,  ///< some headings are allowed
    Open         ///< every heading is allowed
  };
  Kind kind = Kind::Unknown;
  /// Highest cost per metre over 64 equally spaced headings [J/m]; infinite unless `kind` is Open.
  float highest_J_per_m = std::numeric_limits<float>::infinity();
};

/// Computes the summaries of cells for the cost function of a map. The allowed headings are exact
/// (allowedHeadings()) and are kept by cell code, which contains the gradient of a cell and the index of its
/// cost curve (cost per metre on one kind of ground). Not thread-safe.
class CellJudge {
 public:
  /// Throws std::invalid_argument if the cost is null.
  explicit CellJudge(std::shared_ptr<const costmap::TravelCost> cost);
  ~CellJudge();

  /// Returns the restriction and the highest cost of a cell with the given code.
  CellJudgement of(costmap::CellCode cell);

  /// Returns the lowest cost per metre on level ground of all cost curves [J/m]; infinite if the rover may
  /// not drive on level ground.
  float level_J_per_m() const noexcept { return level_J_per_m_; }

 private:
  class Headings;
  std::shared_ptr<const costmap::TravelCost> cost_;
  std::unique_ptr<Headings> headings_;
  float level_J_per_m_;
};

}  // namespace talus::planner
