#include <talus/planner/plan/route_planner.hpp>
#include <talus/planner/plugin/plugin_export.hpp>

TALUS_EXPORT_PLANNER(talus::planner::OwnPlanner)
