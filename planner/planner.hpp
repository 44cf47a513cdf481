#pragma once

/// Umbrella header of talus::planner: planning of routes with Talus' own planners or with a planner from a
/// shared library, and a check of routes that is independent of the planners.

#include <talus/costmap/costmap.hpp>
#include <talus/planner/check/cell_judge.hpp>
#include <talus/planner/check/chassis.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/plan/planner.hpp>
#include <talus/planner/plugin/plugin_loader.hpp>
#include <talus/planner/route/kinematics.hpp>
