#pragma once

#include <memory>
#include <utility>
#include <vector>

#include <ompl/base/ScopedState.h>
#include <ompl/base/SpaceInformation.h>

#include <talus/planner/sampling/map_space.hpp>

namespace talus::planner::testing {

/// A map as an OMPL problem: space, validity, objective, start and goal.
struct OmplGround {
  std::shared_ptr<const MeteredCost> cost;
  std::shared_ptr<const ImprovableRegion> region;
  ompl::base::SpaceInformationPtr space;
  std::shared_ptr<MapMotionValidator> motions;
  std::shared_ptr<TravelObjective> objective;
  ompl::base::ProblemDefinitionPtr definition;

  OmplGround(const std::shared_ptr<const costmap::CostGrid>& map, const Segment& ends)
      : cost(std::make_shared<MeteredCost>(map, ends)),
        region(std::make_shared<ImprovableRegion>(
            ImprovableRegion::Parts{.map = map, .start = ends.from, .goal = ends.to, .known_route = {}})),
        space(std::make_shared<ompl::base::SpaceInformation>(std::make_shared<MapSpace>(map->grid()))),
        motions(std::make_shared<MapMotionValidator>(space, cost)),
        objective(std::make_shared<TravelObjective>(space,
                                                    TravelObjective::Parts{.cost = cost, .region = region})) {
    space->setStateValidityChecker(std::make_shared<MapValidityChecker>(space, cost));
    space->setMotionValidator(motions);
    space->setup();
    definition = std::make_shared<ompl::base::ProblemDefinition>(space);
    definition->setStartAndGoalStates(at(ends.from), at(ends.to), 1e-9);
    definition->setOptimizationObjective(objective);
  }

  ompl::base::ScopedState<MapSpace> at(maps::Point place) const {
    ompl::base::ScopedState<MapSpace> state(space->getStateSpace());
    MapSpace::setPlace(state.get(), place);
    return state;
  }
};

}  // namespace talus::planner::testing
