#pragma once

#include <cstddef>

#include <talus/cli/ground/ground_options.hpp>
#include <talus/planner/grid/windowed_map.hpp>

namespace talus::cli {

/// Whether the map that the options name is a DEM of more cells than this.
bool needsWindows(const GroundOptions& options, std::size_t cells);

/// The whole ground of such a DEM in cells so large that it has some two million. @throws InputError
Ground readOverview(const GroundOptions& options, const Context& context);

/// The same ground at full resolution, to be read window by window. @throws InputError
planner::WindowedMap windowsOn(const GroundOptions& options, const Ground& overview, const Context& context);

}  // namespace talus::cli
