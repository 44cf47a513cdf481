#pragma once

#include <cstddef>

#include <talus/cli/ground/ground_options.hpp>
#include <talus/planner/grid/windowed_map.hpp>

namespace talus::cli {

/// Returns true if the options name a DEM with more than `cells` cells; false for built maps and OctoMaps.
bool needsWindows(const GroundOptions& options, std::size_t cells);

/// The whole ground of the DEM, resampled to about two million cells. @throws InputError
Ground readOverview(const GroundOptions& options, const Context& context);

/// The ground at full resolution, read window by window. @throws InputError
planner::WindowedMap windowsOn(const GroundOptions& options, const Ground& overview, const Context& context);

}  // namespace talus::cli
