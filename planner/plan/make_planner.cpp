#include <talus/planner/plan/make_planner.hpp>
#include <talus/planner/plan/own_planner.hpp>

namespace talus::planner {

std::unique_ptr<GlobalPlanner> makePlanner(const std::string& name) {
  auto planner = std::make_unique<OwnPlanner>();
  planner->configure({.planner = name});
  return planner;
}

}  // namespace talus::planner
