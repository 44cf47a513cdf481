#pragma once

#include <cstddef>

#include <talus/cli/ground/ground_options.hpp>
#include <talus/planner/planner.hpp>

namespace talus::cli {

/// Returns true if the options state an elevation map (DEM) with more than `cells` cells; false for built
/// maps and OctoMaps.
bool needsWindows(const GroundOptions& options, std::size_t cells);

/// Returns the whole ground of the DEM, resampled to about two million cells. @throws InputError
Ground readOverview(const GroundOptions& options, const Context& context);

/// Returns the ground at full resolution as a map that is read window by window. `overview` is the result of
/// readOverview(). @throws InputError
planner::WindowedMap windowsOn(const GroundOptions& options, const Ground& overview, const Context& context);

}  // namespace talus::cli
