#pragma once

#include <cstddef>
#include <optional>

#include <talus/maps/grid.hpp>

namespace talus::planner {

/// What a mission may do without, or change, to open a way.
enum class Constraint {
  Pitch,    ///< slope along the heading, the rover's limit
  Roll,     ///< slope across the heading, the rover's limit
  Soil,     ///< what the soil, the motors or the policy give at a slope
  Hazard,   ///< hazards, keep-out areas and the clearance around them
  Unknown,  ///< unobserved ground
};

/// A constraint as files and JSON spell it: "pitch", "roll", "soil", "hazard", "unknown".
const char* name(Constraint constraint) noexcept;

/// Why nothing connects two places.
struct Obstruction {
  std::size_t cells_from_start = 0;  ///< that some drive from the start may enter
  std::size_t cells_to_goal = 0;     ///< from which some drive may get to the goal
  maps::Point last{};                ///< where the two sets come closest: middle of a cell reached from the start
  maps::Point first{};               ///< and of one that leads to the goal
  bool tried = false;                ///< whether constraints were lifted one by one
  std::optional<Constraint> lifting{};  ///< the first of them without which a way is open; none if no single one is enough
};

}  // namespace talus::planner
