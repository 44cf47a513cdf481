#pragma once

#include <cstdint>
#include <limits>
#include <memory>

#include <talus/costmap/cost/cost_grid.hpp>

namespace talus::planner {

/// What a cell is to a planner that knows no headings.
struct CellJudgement {
  enum class Kind : std::uint8_t {
    Unknown,     ///< not observed, and the map's policy does not drive there
    Refused,     ///< refused in every heading
    Restricted,  ///< refused in some headings
    Open         ///< allowed in every heading
  };
  Kind kind = Kind::Unknown;
  /// Of a metre in the dearest of 64 headings [J/m]; infinite unless Open.
  float dearest_J_per_m = std::numeric_limits<float>::infinity();
};

/// Judges cells under the drive cost of a map. Which headings are allowed is exact (allowedHeadings()). What was asked is kept by
/// code for the next cell. Not thread-safe.
class CellJudge {
 public:
  /// Throws std::invalid_argument without a cost.
  explicit CellJudge(std::shared_ptr<const costmap::DriveCost> cost);
  ~CellJudge();

  CellJudgement of(costmap::CellCode cell);

  /// Of a metre on level ground of the cheapest kind [J/m]; infinite where none may be driven.
  float level_J_per_m() const noexcept { return level_J_per_m_; }

 private:
  class Headings;
  std::shared_ptr<const costmap::DriveCost> cost_;
  std::unique_ptr<Headings> headings_;
  float level_J_per_m_;
};

}  // namespace talus::planner
