#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <ompl/base/ProjectionEvaluator.h>

#include <talus/planner/pose/pose_space.hpp>

namespace talus::planner {
namespace {

namespace ob = ompl::base;

constexpr double kProjection_cells = 16.0;

double lastInside(double edge) {
  return std::nextafter(edge, -std::numeric_limits<double>::infinity());
}

// Projection of a pose to its position, for planners that use a grid.
class PlaceProjection : public ob::ProjectionEvaluator {
 public:
  PlaceProjection(const ob::StateSpace* space, double side_m) : ProjectionEvaluator(space) {
    cellSizes_ = {side_m, side_m};
  }
  unsigned int getDimension() const override { return 2; }
  void project(const ob::State* state, Eigen::Ref<Eigen::VectorXd> place) const override {
    const Pose pose = PoseSpace::pose(state);
    place << pose.place.x_m, pose.place.y_m;
  }
};

}  // namespace

PoseSpace::PoseSpace(const PoseCost& cost)
    : cost_(cost), radian_m_(0.5 * cost.motion().map().grid().resolution_m) {
  setName("Poses");
  const maps::Grid& grid = cost.motion().map().grid();
  ob::RealVectorBounds bounds(2);
  bounds.setLow(0, grid.south_west.x_m);
  bounds.setLow(1, grid.south_west.y_m);
  bounds.setHigh(0, lastInside(grid.south_west.x_m + grid.width * grid.resolution_m));
  bounds.setHigh(1, lastInside(grid.south_west.y_m + grid.height * grid.resolution_m));
  setBounds(bounds);
}

Pose PoseSpace::pose(const ob::State* state) noexcept {
  const auto* s = state->as<StateType>();
  return {{s->getX(), s->getY()}, s->getYaw()};
}

void PoseSpace::setPose(ob::State* state, const Pose& pose) noexcept {
  auto* s = state->as<StateType>();
  s->setXY(pose.place.x_m, pose.place.y_m);
  s->setYaw(std::remainder(pose.heading_rad, 2.0 * std::numbers::pi));
}

double PoseSpace::weight_m(const PosePath::Leg& leg) const noexcept {
  return std::abs(leg.arc.length_m) + radian_m_ * std::abs(leg.turn_rad);
}

double PoseSpace::distance(const ob::State* from, const ob::State* to) const {
  double sum = 0.0;
  for (const PosePath::Leg& leg : cost_.direct(pose(from), pose(to))) sum += weight_m(leg);
  return sum;
}

void PoseSpace::interpolate(const ob::State* from, const ob::State* to, double share,
                            ob::State* state) const {
  const auto legs = cost_.direct(pose(from), pose(to));
  double left = 0.0;
  for (const PosePath::Leg& leg : legs) left += share * weight_m(leg);
  Pose at = pose(from);
  for (const PosePath::Leg& leg : legs) {
    const double own = weight_m(leg), part = own > 0.0 ? std::clamp(left / own, 0.0, 1.0) : 0.0;
    at = after(at, PosePath::Leg{{leg.arc.length_m * part, leg.arc.curvature_1_m}, leg.turn_rad * part});
    left -= own;
    if (left <= 0.0) break;
  }
  setPose(state, at);
}

void PoseSpace::registerProjections() {
  registerDefaultProjection(
      std::make_shared<PlaceProjection>(this, kProjection_cells * cost_.motion().map().grid().resolution_m));
}

}  // namespace talus::planner
