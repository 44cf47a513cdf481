#pragma once

#include <cstdint>
#include <limits>
#include <memory>

#include <talus/costmap/cost/cost_grid.hpp>

namespace talus::planner {

/// Summary of a cell for a planner without headings.
struct CellJudgement {
  /// Restriction of the allowed headings.
  enum class Kind : std::uint8_t {
    Unknown,     ///< not observed, and not drivable under the map's policy
    Refused,     ///< no heading is allowed
    Restricted,  ///< some headings are not allowed
    Open         ///< every heading is allowed
  };
  Kind kind = Kind::Unknown;
  /// Highest cost per metre of 64 headings [J/m]; infinite unless Open.
  float highest_J_per_m = std::numeric_limits<float>::infinity();
};

/// Summarises cells under the drive cost of a map. The allowed headings are exact (allowedHeadings()) and
/// cached by cell code. Not thread-safe.
class CellJudge {
 public:
  /// Throws std::invalid_argument if the cost is null.
  explicit CellJudge(std::shared_ptr<const costmap::TravelCost> cost);
  ~CellJudge();

  /// Restriction and cost of a cell.
  CellJudgement of(costmap::CellCode cell);

  /// Lowest cost per metre on level ground over all curves [J/m]; infinite if level driving is not allowed.
  float level_J_per_m() const noexcept { return level_J_per_m_; }

 private:
  class Headings;
  std::shared_ptr<const costmap::TravelCost> cost_;
  std::unique_ptr<Headings> headings_;
  float level_J_per_m_;
};

}  // namespace talus::planner
