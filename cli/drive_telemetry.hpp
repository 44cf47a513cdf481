#pragma once

#include <filesystem>
#include <vector>

#include <planner/rehearsal.hpp>
#include <terramech/rover.hpp>

namespace talus::cli {

/// Writes what the wheels of a rehearsal read as a telemetry CSV, which `talus update` takes.
/// @throws InputError when the file cannot be written
void saveTelemetry(const std::filesystem::path& path, const planner::Rehearsal& drive,
                   const terramech::Rover& rover);

}  // namespace talus::cli
