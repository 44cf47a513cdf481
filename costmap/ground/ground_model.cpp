#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <utility>

#include <talus/costmap/cost/learned_cells.hpp>
#include <talus/costmap/ground/ground_model.hpp>
#include <talus/terramech/mobility/slope_equilibrium.hpp>
#include <talus/terramech/mobility/turning.hpp>
#include <talus/terramech/mobility/wheel_forces_table.hpp>
#include <talus/terramech/numerics/functions.hpp>

namespace talus::costmap {
namespace {

// Least thrust divided by load [-], below which the strength of ground is not defined.
constexpr double kLeastThrust = 0.02;

terramech::RefinedModel modelOf(const GroundClass& ground) {
  terramech::RefinedModel model;
  model.soil = ground.soil;
  model.effects = ground.effects;
  return model;
}

terramech::SlopeEquilibrium slopeOf(const GroundClass& ground, const terramech::Rover& rover) {
  if (ground.effects.empty()) return {ground.soil, rover};
  return {modelOf(ground), rover};
}

// Returns the class in the rut of an equal wheel: by its multipass effect if found in data, else by rutted().
GroundClass rutOf(const GroundClass& ground) {
  GroundClass rut = ground;
  if (!terramech::knowsPasses(ground.effects)) rut.soil = terramech::rutted(ground.soil);
  return rut;
}

terramech::MobilityOptions passOf(const GroundClass& rut) {
  return terramech::knowsPasses(rut.effects) ? terramech::MobilityOptions{.pass = 2}
                                             : terramech::MobilityOptions{};
}

}  // namespace

terramech::MobilityReference referenceOf(const GroundClass& ground, const terramech::Rover& rover,
                                         const terramech::MobilityOptions& options) {
  if (ground.effects.empty()) return terramech::mobilityReference(ground.soil, rover, options);
  return terramech::mobilityReference(modelOf(ground), rover, options);
}

struct GroundModel::Lazy {
  std::once_flag once, solved;
  std::optional<terramech::SlopeEquilibrium> slope;
  std::array<double, 2> most_slip{};  // fresh, in a rut
  std::shared_ptr<const SlopeLattice> lattice;
};

GroundModel::GroundModel(Parts parts) : parts_(std::move(parts)) {
  if (parts_.classes.empty())
    throw std::invalid_argument("ground model: classes is empty, must hold at least one");
  const terramech::RangeCheck check("drive policy");
  check.within("slope_margin_rad", parts_.policy.slope_margin_rad, {0.0, 0.5});
  check.within("max_immobilisation", parts_.policy.max_immobilisation, {0.0, 1.0});
  check.within("pose_error_m", parts_.policy.pose_error_m, {0.0, 100.0});
  check.atLeast("time_weight_W", parts_.policy.time_weight_W, 0.0);
  check.within("entrapment", parts_.policy.entrapment, {0.0, 1.0});
  check.within("unmonitored_entrapment", parts_.policy.unmonitored_entrapment, {0.0, 1.0});
  check.atLeast("risk_weight_J", parts_.policy.risk_weight_J, 0.0);
  check.above("correlation_length_m", parts_.policy.correlation_length_m, 0.0);
  if (parts_.stated && parts_.stated->states.size() != parts_.classes.size())
    throw std::invalid_argument("ground model: stated must hold the states of each class");
  if (parts_.stated) {  // a point
    parts_.policy.pose_error_m = parts_.policy.time_weight_W = parts_.policy.risk_weight_J = 0.0;
    parts_.rover = {.wheel = {.radius_m = 0.0, .width_m = 0.0}};
  } else {
    static_cast<void>(terramech::RoverStance(parts_.rover));  // a rover without a stance is refused here
  }
  for (const GroundClass& c : parts_.classes) {
    if (&parts_.classes[static_cast<std::size_t>(classIndex(c.number))] != &c)
      throw std::invalid_argument("ground model: class " + std::to_string(c.number) + " is declared twice");
    if (parts_.stated) {
      references_.emplace_back();
      continue;
    }
    // referenceOf() throws if a field of the class is out of range: an invalid class is refused here, not at
    // the first use of its curve.
    const GroundClass rut = rutOf(c);
    const terramech::MobilityReference fresh = costmap::referenceOf(c, parts_.rover);
    references_.push_back(
        {.fresh = fresh,
         .in_rut = costmap::referenceOf(rut, parts_.rover, passOf(rut)),
         .prior = {.pull = {fresh.drawbar_pull_over_load, std::hypot(c.pull_std, c.mean_std)},
                   .sinkage = {fresh.sinkage_over_radius, c.sinkage_std}}});
    grounds_.push_back(std::make_shared<Lazy>());
  }
  rules_ = std::make_shared<const GroundRules>(GroundRules{parts_.policy, parts_.rover});
}

const terramech::SlopeEquilibrium& GroundModel::slope(int class_index) const {
  const auto i = static_cast<std::size_t>(class_index);
  Lazy& lazy = *grounds_[i];
  std::call_once(lazy.once, [&] {
    lazy.slope.emplace(slopeOf(parts_.classes[i], parts_.rover));
    for (const bool in_rut : {false, true}) {
      double& most = lazy.most_slip[in_rut ? 1 : 0];
      const auto pull = [&](double slip) { return lazy.slope->evenWheel(slip, 0.0, in_rut).drawbar_pull_N; };
      while (most < 0.98 && pull(most + 0.02) > pull(most)) most += 0.02;
    }
  });
  return *lazy.slope;
}

double GroundModel::mostSlip(int class_index, bool in_rut) const {
  slope(class_index);
  return grounds_[static_cast<std::size_t>(class_index)]->most_slip[in_rut ? 1 : 0];
}

const std::shared_ptr<const SlopeLattice>& GroundModel::lattice(int class_index) const {
  Lazy& lazy = *grounds_[static_cast<std::size_t>(class_index)];
  std::call_once(lazy.solved, [&] {
    lazy.lattice = std::make_shared<const SlopeLattice>(slope(class_index), limits(), parts_.prices_crossing);
  });
  return lazy.lattice;
}

int GroundModel::classIndex(int number) const noexcept {
  for (std::size_t i = 0; i < parts_.classes.size(); ++i)
    if (parts_.classes[i].number == number) return static_cast<int>(i);
  return -1;
}

SteadyWheel GroundModel::steady(int class_index, const SlippingWheel& wheel) const {
  const terramech::WheelOnSlope w = slope(class_index)
                                        .evenWheel(std::min(wheel.slip, mostSlip(class_index, wheel.in_rut)),
                                                   wheel.slip_angle_rad, wheel.in_rut);
  const double radius_m = parts_.rover.wheel.radius_m;
  return {.gradient = w.drawbar_pull_N / w.load_N,
          .sinkage_over_radius = w.sinkage_m / radius_m,
          .torque_over_load_radius = w.torque_Nm / (w.load_N * radius_m),
          .hold = std::abs(w.side_force_N) / w.load_N};
}

SteadyWheel GroundModel::onSlope(int class_index, double gradient, bool in_rut) const {
  const auto at = [&](double slip) { return steady(class_index, {.slip = slip, .in_rut = in_rut}); };
  double low = -1.0, high = mostSlip(class_index, in_rut);
  for (int halving = 0; halving < 20; ++halving) {
    const double middle = 0.5 * (low + high);
    (at(middle).gradient < gradient ? low : high) = middle;
  }
  return at(high);
}

SteadyWheel GroundModel::reference(int class_index, bool in_rut) const noexcept {
  const Reference& known = referenceOf(class_index);
  const terramech::MobilityReference& at = in_rut ? known.in_rut : known.fresh;
  return {at.drawbar_pull_over_load, at.sinkage_over_radius, at.torque_over_load_radius};
}

StrengthOfClass GroundModel::strengthOf(int class_index, const GroundBelief& belief) const {
  const terramech::MobilityReference& fresh = referenceOf(class_index).fresh;
  const double thrust = std::max(fresh.torque_over_load_radius, kLeastThrust);
  const double deeper =
      fresh.sinkage_over_radius > 0.0 ? belief.sinkage.value / fresh.sinkage_over_radius : 1.0;
  return {.lattice = lattice(class_index),
          .class_index = class_index,
          .strength = {1.0 + (belief.pull.value - fresh.drawbar_pull_over_load) / thrust,
                       belief.pull.std / thrust},
          .deeper = deeper};
}

std::shared_ptr<const GroundStates> GroundModel::states(int class_index, int other_class,
                                                        const GroundBelief& belief) const {
  std::vector<StrengthOfClass> classes{strengthOf(class_index, belief)};
  if (other_class != class_index) classes.push_back(strengthOf(other_class, belief));
  return std::make_shared<const GroundStates>(rules_, std::move(classes), belief);
}

GroundCost GroundModel::ground(int class_index, int other_class, const GroundBelief& belief) const {
  if (parts_.stated) {
    const auto& states = parts_.stated->states[static_cast<std::size_t>(class_index)];
    return {.curve = states->curve({.energy = 1.0, .time_W = 0.0, .risk_J = 0.0}), .states = states};
  }
  const auto states = this->states(class_index, other_class, belief);
  GroundCost ground{
      .curve = states->curve(
          {.energy = 1.0, .time_W = parts_.policy.time_weight_W, .risk_J = parts_.policy.risk_weight_J}),
      .states = states};
  const TravelState flat = states->at(0, TravelCurve::kBins / 2);
  ground.turns = turns(class_index, flat);
  if (other_class != class_index) ground.turns = costmap::dearer(ground.turns, turns(other_class, flat));
  return ground;
}

TurnCosts GroundModel::turns(int class_index, const TravelState& flat) const {
  const terramech::Soil& soil = parts_.classes[static_cast<std::size_t>(class_index)].soil;
  const terramech::Rover& rover = parts_.rover;
  const double hotel_J_per_m = rover.hotel_power_W * static_cast<double>(flat.time_s_per_m);
  const terramech::TurnEfforts efforts = terramech::turnEfforts(
      rover, {.lateral_resistance = std::tan(soil.friction_angle_rad),
              .bulldozing_N = terramech::bulldozing_N(soil, rover, static_cast<double>(flat.sinkage_m)),
              .rolling_J_per_m = std::max(0.0, static_cast<double>(flat.energy_J_per_m) - hotel_J_per_m)});
  const double time_W = parts_.policy.time_weight_W;
  const TurnCost on_arc = costmap::priced(efforts.on_arc, 1.0, time_W),
                 in_place = costmap::priced(efforts.in_place, 1.0, time_W);
  return {on_arc, in_place, rover.turning_radius_m > 0.0 ? on_arc : in_place};
}

TravelCost::Limits GroundModel::limits() const {
  const terramech::Rover& rover = parts_.rover;
  if (const auto& stated = parts_.stated)
    return {.max_along = stated->max_along,
            .max_across = stated->max_across,
            .stated = true,
            .stance = nullptr,
            .outline = {}};
  const bool tips = rover.centre_of_mass_height_m > 0.0;
  return {.max_along = std::tan(rover.max_pitch_rad),
          .max_across = std::tan(rover.max_roll_rad),
          .stance = tips ? std::make_shared<const terramech::RoverStance>(rover) : nullptr,
          .outline = {rover.wheelbase_m, rover.track_m, rover.track_m + rover.wheel.width_m}};
}

}  // namespace talus::costmap
