#pragma once

#include <ompl/base/State.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>

#include <talus/maps/grid/grid.hpp>

namespace talus::planner {

/// OMPL state space of the map plane: R^2 in map coordinates [m], bounded by the edges of the map. The
/// projection has squares of 16 x 16 cells (the default projection of OMPL aborts in R^2).
class MapSpace : public ompl::base::RealVectorStateSpace {
 public:
  explicit MapSpace(const maps::Grid& grid);

  const maps::Grid& grid() const noexcept { return grid_; }

  /// Returns the map coordinates [m] of a state of this space.
  static maps::Point place(const ompl::base::State* state) noexcept {
    const double* values = state->as<StateType>()->values;
    return {values[0], values[1]};
  }

  /// Sets a state of this space to a map position.
  static void setPlace(ompl::base::State* state, maps::Point place) noexcept {
    double* values = state->as<StateType>()->values;
    values[0] = place.x_m;
    values[1] = place.y_m;
  }

  void registerProjections() override;

 private:
  maps::Grid grid_;
};

}  // namespace talus::planner
