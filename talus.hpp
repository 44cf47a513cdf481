#pragma once

/// What every part of Talus has in common: the error of unusable input, the monitor of long work, the unit of angle that
/// people read. Programs that embed Talus include it with the entry header of the module they use.
#include <talus/common/constants.hpp>
#include <talus/common/input_error.hpp>
#include <talus/common/progress_monitor.hpp>
