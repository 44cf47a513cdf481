#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <utility>

#include <talus/costmap/ground/ground_model.hpp>
#include <talus/terramech/mobility/slope_equilibrium.hpp>
#include <talus/terramech/mobility/turning.hpp>
#include <talus/terramech/mobility/wheel_forces_table.hpp>
#include <talus/terramech/numerics/functions.hpp>

namespace talus::costmap {
namespace {

// Least thrust divided by load [-], below which the strength of ground is not defined.
constexpr double kLeastThrust = 0.02;

}  // namespace

terramech::RefinedModel modelOf(const GroundClass& ground) {
  terramech::RefinedModel model = terramech::onSoil(ground.soil);
  model.effects = ground.effects;
  return model;
}

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
    const auto& ground = grounds_.emplace_back(std::make_shared<Ground>());
    if (parts_.stated) continue;
    // mobilityReference() throws if a field of the class is out of range: an invalid class is refused here, not
    // at the first use of its curve.
    const terramech::RefinedModel model = modelOf(c);
    ground->reference = {terramech::mobilityReference(model, parts_.rover),
                         terramech::mobilityReference(terramech::rutted(model), parts_.rover, 2)};
    const SteadyWheel& fresh = ground->reference[0];
    ground->prior = {.pull = {fresh.drawbar_pull_over_load, std::hypot(c.pull_std, c.mean_std)},
                     .sinkage = {fresh.sinkage_over_radius, c.sinkage_std}};
  }
  rules_ = std::make_shared<const GroundRules>(GroundRules{parts_.policy, parts_.rover});
}

const terramech::SlopeEquilibrium& GroundModel::slope(int class_index) const {
  Ground& ground = of(class_index);
  std::call_once(ground.once, [&] {
    ground.slope.emplace(modelOf(parts_.classes[static_cast<std::size_t>(class_index)]), parts_.rover);
    for (const bool in_rut : {false, true}) {
      double& most = ground.most_slip[in_rut ? 1 : 0];
      const auto pull = [&](double slip) {
        return ground.slope->evenWheel(slip, 0.0, in_rut).drawbar_pull_over_load;
      };
      while (most < 0.98 && pull(most + 0.02) > pull(most)) most += 0.02;
    }
  });
  return *ground.slope;
}

const std::shared_ptr<const SlopeLattice>& GroundModel::lattice(int class_index) const {
  Ground& ground = of(class_index);
  std::call_once(ground.solved, [&] {
    ground.lattice =
        std::make_shared<const SlopeLattice>(slope(class_index), limits(), parts_.prices_crossing);
  });
  return ground.lattice;
}

int GroundModel::classIndex(int number) const noexcept {
  for (std::size_t i = 0; i < parts_.classes.size(); ++i)
    if (parts_.classes[i].number == number) return static_cast<int>(i);
  return -1;
}

SteadyWheel GroundModel::steady(int class_index, const SlippingWheel& wheel) const {
  const terramech::SlopeEquilibrium& rover = slope(class_index);
  const double most = of(class_index).most_slip[wheel.in_rut ? 1 : 0];
  return rover.evenWheel(std::min(wheel.slip, most), wheel.slip_angle_rad, wheel.in_rut);
}

SteadyWheel GroundModel::onSlope(int class_index, double gradient, bool in_rut) const {
  const auto at = [&](double slip) { return steady(class_index, {.slip = slip, .in_rut = in_rut}); };
  double low = -1.0, high = 1.0;  // steady() limits the slip to that of the greatest pull
  for (int halving = 0; halving < 20; ++halving) {
    const double middle = 0.5 * (low + high);
    (at(middle).drawbar_pull_over_load < gradient ? low : high) = middle;
  }
  return at(high);
}

std::shared_ptr<const GroundModel> GroundModel::withResistance(int class_index, double deviations) const {
  constexpr double kChange = 0.05, kLeast = 0.3, kMost = 2.0;
  Ground& own = of(class_index);
  const std::lock_guard lock(own.changing);
  std::shared_ptr<const GroundModel>& known = own.with_resistance[deviations];
  if (known) return known;
  GroundClass ground = parts_.classes[static_cast<std::size_t>(class_index)];
  double& exponent = ground.soil.sinkage_exponent;
  const double of_class = exponent;
  const auto resistance = [&](double changed) {
    exponent = changed;
    const SteadyWheel reference = terramech::mobilityReference(modelOf(ground), parts_.rover);
    return reference.torque_over_load_radius - reference.drawbar_pull_over_load;
  };
  const double slope = (resistance(of_class + kChange) - resistance(of_class - kChange)) / (2.0 * kChange);
  const double change = slope > 0.0 ? deviations * ground.resistance_std / slope : 0.0;
  exponent = std::clamp(of_class + change, kLeast, kMost);
  return known = std::make_shared<const GroundModel>(
             Parts{.rover = parts_.rover, .classes = {ground}, .policy = parts_.policy});
}

StrengthOfClass GroundModel::strengthOf(int class_index, const GroundBelief& belief) const {
  const SteadyWheel& fresh = reference(class_index, false);
  const double thrust = std::max(fresh.torque_over_load_radius, kLeastThrust);
  const double deeper =
      fresh.sinkage_over_radius > 0.0 ? belief.sinkage.value / fresh.sinkage_over_radius : 1.0;
  return {.lattice = lattice(class_index),
          .class_index = class_index,
          .strength = {1.0 + (belief.pull.value - fresh.drawbar_pull_over_load) / thrust,
                       belief.pull.std / thrust},
          .deeper = deeper};
}

std::shared_ptr<const GroundStates> GroundModel::states(int class_index, const GroundBelief& belief,
                                                        int other_class) const {
  std::vector<StrengthOfClass> classes{strengthOf(class_index, belief)};
  if (other_class >= 0) classes.push_back(strengthOf(other_class, belief));
  return std::make_shared<const GroundStates>(rules_, std::move(classes), belief);
}

CostWeights GroundModel::weights() const noexcept {
  return {.energy = 1.0, .time_W = parts_.policy.time_weight_W, .risk_J = parts_.policy.risk_weight_J};
}

GroundCost GroundModel::ground(int class_index, const GroundBelief& belief, int other_class) const {
  if (parts_.stated) {
    const auto& states = parts_.stated->states[static_cast<std::size_t>(class_index)];
    return {.curve = states->curve(weights()), .states = states};
  }
  const auto states = this->states(class_index, belief, other_class);
  const TravelState flat = states->at(0, TravelCurve::kBins / 2);
  GroundCost ground{.curve = states->curve(weights()), .states = states, .turns = turns(class_index, flat)};
  if (other_class < 0) return ground;
  const terramech::TurnEfforts others = turns(other_class, flat);
  for (const auto way : {&terramech::TurnEfforts::on_arc, &terramech::TurnEfforts::in_place,
                         &terramech::TurnEfforts::at_vertex}) {
    terramech::TurnEffort& turn = ground.turns.*way;
    turn = {std::max(turn.energy_J, (others.*way).energy_J), std::max(turn.time_s, (others.*way).time_s)};
  }
  return ground;
}

terramech::TurnEfforts GroundModel::turns(int class_index, const TravelState& flat) const {
  const terramech::Soil& soil = parts_.classes[static_cast<std::size_t>(class_index)].soil;
  const terramech::Rover& rover = parts_.rover;
  const double hotel_J_per_m = rover.hotel_power_W * static_cast<double>(flat.time_s_per_m);
  return terramech::turnEfforts(
      rover, {.lateral_resistance = std::tan(soil.friction_angle_rad),
              .bulldozing_N = terramech::bulldozing_N(soil, rover, static_cast<double>(flat.sinkage_m)),
              .rolling_J_per_m = std::max(0.0, static_cast<double>(flat.energy_J_per_m) - hotel_J_per_m)});
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
