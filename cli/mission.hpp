#pragma once

#include <string>
#include <vector>

#include <cli/ground_options.hpp>

namespace talus::cli {

/// Everything that `talus plan` asks: on the command line or in a mission file.
struct PlanOptions {
  GroundOptions ground;
  std::string start;
  std::string goal;
  std::vector<std::string> via;
  double tolerance_m = 0.0;
  std::string planner = "field";
  double max_risk = 0.0;      ///< chance constraint on immobilisation, 0: none
  std::size_t in_memory = 40'000'000;  ///< cells; larger maps are read in windows along an overview's route
  bool whole_field = false;   ///< even on large maps
  std::string pareto;         ///< chart to draw; empty: none
  double time_limit_s = 0.0;  ///< 0: none
  std::string output;
  std::string html;  ///< page to write; empty: none
  std::string png;   ///< picture to write; empty: none
};

/// Whether the path names a mission file by its extension, .yaml or .yml.
bool isMission(const std::string& path);

/// Takes over what the mission file at options.ground.dem.path says; what the command line says holds over
/// it. Paths in it are relative to the file. @throws InputError with file and line
void readMission(PlanOptions& options);

}  // namespace talus::cli
