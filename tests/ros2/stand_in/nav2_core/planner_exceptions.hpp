// A stand-in of our own for tests: the names that examples/ros2 uses, declared as declarations_test.cpp lists them.
#pragma once

#include <stdexcept>
#include <string>

namespace nav2_core {
class PlannerException : public std::runtime_error {
 public:
  explicit PlannerException(const std::string& description) : std::runtime_error(description) {}
};
#define TALUS_STAND_IN(Name)                                                         \
  class Name : public PlannerException {                                             \
   public:                                                                           \
    explicit Name(const std::string& description) : PlannerException(description) {} \
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
