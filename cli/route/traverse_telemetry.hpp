#pragma once

#include <filesystem>
#include <vector>

#include <talus/planner/simulation/drive/traverse_simulation.hpp>
#include <talus/terramech/contact/rover.hpp>

namespace talus::cli {

/// Writes the wheel telemetry of a traverse simulation as CSV, which `talus update` can read. @throws
/// InputError if the file cannot be written
void saveTelemetry(const std::filesystem::path& path, const planner::TraverseSimulation& drive,
                   const terramech::Rover& rover);

}  // namespace talus::cli
