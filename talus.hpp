#pragma once

/// Umbrella header of the parts that all modules share: InputError, ProgressMonitor and angle constants. A
/// program that embeds Talus includes this header and the umbrella header of each module that it uses.
#include <talus/common/constants.hpp>
#include <talus/common/input_error.hpp>
#include <talus/common/progress_monitor.hpp>
