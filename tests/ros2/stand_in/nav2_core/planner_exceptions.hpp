// A stand-in of our own for tests: the names that examples/ros2 uses, and nothing else.
#pragma once

#include <stdexcept>

namespace nav2_core {
struct PlannerException : std::runtime_error {
  using std::runtime_error::runtime_error;
};
#define TALUS_STAND_IN(Name)                  \
  struct Name : PlannerException {            \
    using PlannerException::PlannerException; \
  }
TALUS_STAND_IN(StartOccupied);
TALUS_STAND_IN(GoalOccupied);
TALUS_STAND_IN(StartOutsideMapBounds);
TALUS_STAND_IN(GoalOutsideMapBounds);
TALUS_STAND_IN(NoValidPathCouldBeFound);
TALUS_STAND_IN(PlannerTimedOut);
TALUS_STAND_IN(PlannerTFError);
TALUS_STAND_IN(PlannerCancelled);
#undef TALUS_STAND_IN
}  // namespace nav2_core
