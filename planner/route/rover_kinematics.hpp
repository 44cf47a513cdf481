#pragma once

#include <talus/costmap/ground/ground_model.hpp>
#include <talus/planner/route/kinematics.hpp>

namespace talus::planner {

/// Kinematics of a rover, turning priced by the curves of a cost function. A change of direction takes the time to drive a
/// wheel radius, a stop to turn in place twenty seconds (ours): that is what keeps a drive from turning at every cell. An
/// Ackermann rover of no stated radius is refused: std::invalid_argument.
Kinematics kinematicsOn(const costmap::GroundModel& model, const costmap::DriveCost& cost);

}  // namespace talus::planner
