#pragma once

/// Entry header of talus::planner: routes by Talus' planners or by a planner from a shared library, and the
/// independent check of a route.

#include <talus/costmap/costmap.hpp>
#include <talus/planner/check/cell_judge.hpp>
#include <talus/planner/check/chassis.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/plan/make_planner.hpp>
#include <talus/planner/plan/plan_route.hpp>
#include <talus/planner/plugin/plugin_loader.hpp>
#include <talus/planner/route/kinematics.hpp>
