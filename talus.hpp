#pragma once

/// Common parts of all modules: InputError, ProgressMonitor and angle constants. Programs that embed Talus
/// include this header with the entry header of the module.
#include <talus/common/constants.hpp>
#include <talus/common/input_error.hpp>
#include <talus/common/progress_monitor.hpp>
