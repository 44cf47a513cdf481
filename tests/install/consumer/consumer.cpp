#include <cstdio>
#include <exception>

#include <talus/planner/plugin/plugin_loader.hpp>
#include <talus/terramech/contact/soil.hpp>

// Uses the installed headers and libraries alone: a room's function, and the installed plugin.
int main(int argc, char** argv) try {
  const talus::terramech::Soil soil{.cohesive_modulus = 1000.0, .frictional_modulus = 10000.0};
  if (talus::terramech::sinkageModulus(soil, 0.1) != 20000.0) return 1;
  const auto planner = talus::planner::loadPlugin(argc > 1 ? argv[1] : "");
  std::printf("%s: %zu planners\n", planner->capabilities().name.c_str(),
              planner->capabilities().planners.size());
  return planner->capabilities().planners.empty() ? 1 : 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
