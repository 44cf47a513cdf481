#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <utility>

#include <talus/costmap/cost/cross_slope.hpp>
#include <talus/costmap/cost/turn_price.hpp>
#include <talus/costmap/ground/ground_model.hpp>
#include <talus/terramech/mobility/rover_stance.hpp>
#include <talus/terramech/mobility/rut.hpp>
#include <talus/terramech/mobility/slope_equilibrium.hpp>
#include <talus/terramech/numerics/normal_distribution.hpp>
#include <talus/terramech/numerics/range.hpp>

namespace talus::costmap {
namespace {

using terramech::Category;
using terramech::MobilityState;

// P(value < bound) of a normal estimate; a step function for std = 0.
double probabilityBelow(const Estimate& value, double bound) {
  if (value.std <= 0.0) return value.value < bound ? 1.0 : 0.0;
  return terramech::normalProbability((bound - value.value) / value.std);
}

constexpr double kLeastThrust = 0.02;  // least thrust divided by load [-]

// Pull and gross thrust of a class, both divided by load, at the reference slip.
struct Thrust {
  double pull, thrust;

  explicit Thrust(const terramech::MobilityReference& at)
      : pull(at.drawbar_pull_over_load),
        thrust(std::max({at.torque_over_load_radius, at.drawbar_pull_over_load, kLeastThrust})) {}

  double resistance() const noexcept { return thrust - pull; }
  // Thrust of ground with this pull as a fraction of the class's thrust, at most 1.
  double share(double own_pull) const noexcept {
    return std::clamp((own_pull + resistance()) / thrust, 1e-3, 1.0);
  }
};

double slopeAtSlip_rad(const terramech::MobilityCurve& curve, double slip) {
  double low = curve.minSlope_rad(), high = curve.maxSlope_rad();
  for (int halving = 0; halving < 30 && low < high; ++halving) {
    const double middle = 0.5 * (low + high);
    (curve.at(middle).slip < slip ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

SteadyWheel steadyAt(const terramech::Rover& rover, const terramech::MobilityCurve& driven,
                     double slope_rad) {
  const MobilityState state = driven.at(slope_rad);
  const double radius_m = rover.wheel.radius_m;
  const double load_N = terramech::wheelLoad_N(rover) * std::cos(slope_rad);
  return {.gradient = std::tan(slope_rad),
          .sinkage_over_radius = state.sinkage_m / radius_m,
          .torque_over_load_radius = state.torque_Nm / (load_N * radius_m)};
}

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
  return terramech::knowsPasses(rut.effects) ? terramech::MobilityOptions{.first_pass = 2}
                                             : terramech::MobilityOptions{};
}

// Options for a curve of all axles together; nullopt if the class has no multipass effect.
std::optional<terramech::MobilityOptions> axlesOf(const GroundClass& ground, const terramech::Rover& rover) {
  if (!terramech::knowsPasses(ground.effects)) return std::nullopt;
  return terramech::MobilityOptions{.axles = rover.wheel_count / 2};
}

}  // namespace

terramech::MobilityCurve mobilityOf(const GroundClass& ground, const terramech::Rover& rover,
                                    const terramech::MobilityOptions& options) {
  if (ground.effects.empty()) return {ground.soil, rover, options};
  return {modelOf(ground), rover, options};
}

terramech::MobilityReference referenceOf(const GroundClass& ground, const terramech::Rover& rover,
                                         const terramech::MobilityOptions& options) {
  if (ground.effects.empty()) return terramech::mobilityReference(ground.soil, rover, options);
  return terramech::mobilityReference(modelOf(ground), rover, options);
}

struct GroundModel::ClassGround {
  terramech::MobilityCurve wheel;   // a wheel on fresh ground
  terramech::MobilityCurve in_rut;  // a wheel in the rut of an equal wheel
  terramech::MobilityCurve all;     // all axles of the rover
  ExpectedTravel drive;             // expected cost by `all`
  terramech::SlopeEquilibrium slope;
  std::shared_ptr<const CrossSlope> crossing;
};

struct GroundModel::Lazy {
  std::once_flag once;
  std::optional<ClassGround> ground;
};

GroundModel::GroundModel(Parts parts) : parts_(std::move(parts)) {
  if (parts_.classes.empty())
    throw std::invalid_argument("ground model: classes is empty, must hold at least one");
  const terramech::RangeCheck check("drive policy");
  check.within("slope_margin_rad", parts_.policy.slope_margin_rad, {0.0, 0.5});
  tan_margin_ = std::tan(parts_.policy.slope_margin_rad);
  check.within("max_immobilisation", parts_.policy.max_immobilisation, {0.0, 1.0});
  check.within("pose_error_m", parts_.policy.pose_error_m, {0.0, 100.0});
  check.atLeast("time_weight_W", parts_.policy.time_weight_W, 0.0);
  check.within("entrapment", parts_.policy.entrapment, {0.0, 1.0});
  check.within("unmonitored_entrapment", parts_.policy.unmonitored_entrapment, {0.0, 1.0});
  check.atLeast("risk_weight_J", parts_.policy.risk_weight_J, 0.0);
  check.above("correlation_length_m", parts_.policy.correlation_length_m, 0.0);
  for (const GroundClass& c : parts_.classes) {
    if (&parts_.classes[static_cast<std::size_t>(classIndex(c.number))] != &c)
      throw std::invalid_argument("ground model: class " + std::to_string(c.number) + " is declared twice");
    // referenceOf() throws if a field of the class is out of range: an invalid class is refused here, not at
    // the first use of its curve.
    const GroundClass rut = rutOf(c);
    const terramech::MobilityReference fresh = costmap::referenceOf(c, parts_.rover);
    references_.push_back(
        {.fresh = fresh,
         .in_rut = costmap::referenceOf(rut, parts_.rover, passOf(rut)),
         .prior = {.pull = {fresh.drawbar_pull_over_load, std::hypot(c.pull_std, c.mean_std)},
                   .sinkage = {fresh.sinkage_over_radius, c.sinkage_std}}});
    if (const auto axles = axlesOf(c, parts_.rover)) costmap::referenceOf(c, parts_.rover, *axles);
    grounds_.push_back(std::make_shared<Lazy>());
  }
}

GroundModel::ClassGround GroundModel::workedOut(const GroundClass& ground) const {
  const GroundClass rut = rutOf(ground);
  terramech::MobilityCurve wheel = mobilityOf(ground, parts_.rover);
  const auto axles = axlesOf(ground, parts_.rover);
  terramech::MobilityCurve all = axles ? mobilityOf(ground, parts_.rover, *axles) : wheel;
  const ExpectedTravel drive(all);
  terramech::SlopeEquilibrium slope = slopeOf(ground, parts_.rover);
  const CrossSlope::Level level{
      .first = drive.first(),
      .last = drive.last(),
      .thrust = std::max({all.reference().torque_over_load_radius, drive.last(), kLeastThrust})};
  auto crossing = std::make_shared<const CrossSlope>(
      parts_.prices_crossing ? CrossSlope{slope, level, limits()} : CrossSlope::alongOnly());
  return {.wheel = std::move(wheel),
          .in_rut = mobilityOf(rut, parts_.rover, passOf(rut)),
          .all = std::move(all),
          .drive = drive,
          .slope = std::move(slope),
          .crossing = std::move(crossing)};
}

const GroundModel::ClassGround& GroundModel::groundOf(int class_index) const {
  const auto i = static_cast<std::size_t>(class_index);
  Lazy& lazy = *grounds_[i];
  std::call_once(lazy.once, [&] { lazy.ground.emplace(workedOut(parts_.classes[i])); });
  return *lazy.ground;
}

const std::shared_ptr<const CrossSlope>& GroundModel::crossing(int class_index) const {
  return groundOf(class_index).crossing;
}

int GroundModel::classIndex(int number) const noexcept {
  for (std::size_t i = 0; i < parts_.classes.size(); ++i)
    if (parts_.classes[i].number == number) return static_cast<int>(i);
  return -1;
}

SteadyWheel GroundModel::steady(int class_index, const SlippingWheel& wheel) const {
  const ClassGround& ground = groundOf(class_index);
  const terramech::MobilityCurve& driven = wheel.in_rut ? ground.in_rut : ground.wheel;
  SteadyWheel steady = steadyAt(parts_.rover, driven, slopeAtSlip_rad(driven, wheel.slip));
  const double radius_m = parts_.rover.wheel.radius_m;
  if (wheel.slip_angle_rad == 0.0) return steady;
  const terramech::WheelOnSlope straight = ground.slope.evenWheel(wheel.slip, 0.0),
                                turned = ground.slope.evenWheel(wheel.slip, wheel.slip_angle_rad);
  steady.gradient += (turned.drawbar_pull_N - straight.drawbar_pull_N) / turned.load_N;
  steady.torque_over_load_radius += (turned.torque_Nm - straight.torque_Nm) / (turned.load_N * radius_m);
  if (straight.sinkage_m > 0.0) steady.sinkage_over_radius *= turned.sinkage_m / straight.sinkage_m;
  steady.hold = std::abs(turned.side_force_N) / turned.load_N;
  return steady;
}

SteadyWheel GroundModel::onSlope(int class_index, double gradient, bool in_rut) const {
  const ClassGround& ground = groundOf(class_index);
  const terramech::MobilityCurve& driven = in_rut ? ground.in_rut : ground.wheel;
  const double least = driven.minSlope_rad(), most = std::max(driven.maxSlope_rad(), least);
  return steadyAt(parts_.rover, driven, std::clamp(std::atan(gradient), least, most));
}

SteadyWheel GroundModel::reference(int class_index, bool in_rut) const noexcept {
  const Reference& known = referenceOf(class_index);
  const terramech::MobilityReference& at = in_rut ? known.in_rut : known.fresh;
  return {at.drawbar_pull_over_load, at.sinkage_over_radius, at.torque_over_load_radius};
}

// tan(slope -+ margin) by the addition theorem; infinite beyond a right angle.
GroundModel::Edges GroundModel::edges(double gradient) const noexcept {
  const double left = 1.0 - gradient * tan_margin_, right = 1.0 + gradient * tan_margin_;
  constexpr double kSteeper = std::numeric_limits<double>::infinity();
  return {.low = right > 0.0 ? (gradient - tan_margin_) / right : -kSteeper,
          .high = left > 0.0 ? (gradient + tan_margin_) / left : kSteeper};
}

double GroundModel::criticalSinkage() const noexcept {
  const double stated = parts_.policy.sinkage_critical;
  return stated > 0.0 ? stated : parts_.rover.clearance_m / parts_.rover.wheel.radius_m;
}

Category GroundModel::categoryAt(double pull, double sinkage, double gradient) const {
  const Edges edge = edges(gradient);
  const double critical = criticalSinkage();
  return terramech::categorise({.drawbar_pull_over_load = pull, .sinkage_over_radius = sinkage},
                               {.dp_low = edge.low,
                                .dp_high = edge.high,
                                .z_threshold = std::min(parts_.policy.sinkage_threshold, critical),
                                .z_critical = critical});
}

RankedCategory GroundModel::category(const GroundBelief& belief, double gradient) const {
  const Edges edge = edges(gradient);
  const double below_low = probabilityBelow(belief.pull, edge.low);
  const double below_high = probabilityBelow(belief.pull, edge.high);
  const double critical = criticalSinkage(), threshold = std::min(parts_.policy.sinkage_threshold, critical);
  const double carried = probabilityBelow(belief.sinkage, threshold);
  const double free = probabilityBelow(belief.sinkage, critical);
  // Sums the probabilities of the combinations of pull and sinkage ranks that have the category of the mean.
  constexpr double kMost = std::numeric_limits<double>::infinity();
  const std::array<std::pair<double, double>, 3> pulls{
      {{kMost, 1.0 - below_high}, {gradient, below_high - below_low}, {-kMost, below_low}}};
  const std::array<std::pair<double, double>, 3> sinkages{
      {{-kMost, carried}, {threshold, free - carried}, {kMost, 1.0 - free}}};
  const Category mean = categoryAt(belief.pull.value, belief.sinkage.value, gradient);
  double probability = 0.0;
  for (const auto& [pull, chance] : pulls)
    for (const auto& [sinkage, share] : sinkages)
      if (chance * share > 1e-9 && categoryAt(pull, sinkage, gradient) == mean) probability += chance * share;
  return {mean, probability};
}

// Shifts the curve up to the reference slip; beyond, scales the thrust of the class (class comment).
Estimate GroundModel::demand(int class_index, const Estimate& pull, double gradient) const noexcept {
  const Thrust own(referenceOf(class_index).fresh);
  const double beyond = std::max(gradient - pull.value, 0.0), share = own.share(pull.value);
  return {gradient + own.pull - pull.value + beyond * (1.0 / share - 1.0),
          pull.std * (1.0 + beyond / (share * own.thrust)) / share};
}

// The greatest pull of the ground is its fraction of the class's pull at the strongest slip. If the mean pull
// is insufficient, the probability is 1, because a large standard deviation must not reduce the probability.
double GroundModel::weakProbability(const ClassGround& ground, const Estimate& pull,
                                    double gradient) noexcept {
  const Thrust own(ground.wheel.reference());
  const double strongest = ground.all.strongest().drawbar_pull_over_load;
  const double reserve = std::max({strongest, ground.drive.last(), own.pull}) - own.pull;
  // Least sufficient pull at the reference slip; by the shift of the curve if stronger than the class.
  const double least = gradient > own.pull + reserve
                           ? gradient - reserve
                           : (gradient * own.thrust - reserve * own.resistance()) / (own.thrust + reserve);
  return pull.value < least ? 1.0 : probabilityBelow(pull, least);
}

// On ground weaker by d, the braking force over load of locked wheels is less by d, or is the ground's
// fraction of the class's braking force if that is lower.
double GroundModel::unbrakedProbability(const ClassGround& ground, const Estimate& pull,
                                        double gradient) noexcept {
  const Thrust own(ground.wheel.reference());
  const double first = ground.drive.first(), locked = -first - own.resistance();
  double least = own.pull + first - gradient;
  if (locked > own.thrust && gradient > first)
    least = std::max(least, own.thrust * (-gradient - own.resistance()) / locked - own.resistance());
  return pull.value < least ? 1.0 : probabilityBelow(pull, least);
}

Refusal GroundModel::refusal(const TravelState& state, double weak, const Demand& demand,
                             const ClassGround& ground) const noexcept {
  const TravelPolicy& policy = parts_.policy;
  if (static_cast<double>(std::abs(state.torque_Nm)) > parts_.rover.max_torque_Nm) return Refusal::Torque;
  if (demand.braked < ground.drive.first() || demand.driven > ground.drive.last() ||
      weak > policy.max_immobilisation)
    return Refusal::Pull;
  if (static_cast<double>(state.sinkage_m) >= parts_.rover.clearance_m) return Refusal::Sinkage;
  const bool refused = (state.category == Category::Dangerous && !policy.allow_dangerous) ||
                       (state.category == Category::Marginal && !policy.allow_marginal);
  return refused ? Refusal::Category : Refusal::None;
}

TravelState GroundModel::state(int class_index, const GroundBelief& belief, double gradient) const {
  const ClassGround& ground = groundOf(class_index);
  const TravelPolicy& policy = parts_.policy;
  const auto& reference = ground.wheel.reference();
  const double weakness = reference.drawbar_pull_over_load - belief.pull.value;
  const Estimate demand = this->demand(class_index, belief.pull, gradient);
  const double least = std::min(gradient, 0.0), mean = std::max(demand.value, least);
  const MobilityState s = ground.all.at(std::atan(mean)), braked = ground.all.at(std::atan(least));
  const ExpectedCost expected = ground.drive.at(demand, least);
  const double surface = std::hypot(1.0, gradient);
  const double deeper =
      reference.sinkage_over_radius > 0.0 ? belief.sinkage.value / reference.sinkage_over_radius : 1.0;
  const double weak = std::max(weakProbability(ground, belief.pull, gradient),
                               unbrakedProbability(ground, belief.pull, gradient));

  TravelState state;
  state.slip = static_cast<float>(s.slip);
  // Weaker ground has at least the braking torque of stronger ground on the same slope.
  state.sinkage_m = static_cast<float>(
      std::max({s.sinkage_m, ground.drive.sinkage_m(mean), braked.sinkage_m, ground.drive.sinkage_m(least)}) *
      deeper);
  state.torque_Nm =
      static_cast<float>(std::abs(braked.torque_Nm) > std::abs(s.torque_Nm) ? braked.torque_Nm : s.torque_Nm);
  state.energy_J_per_m = static_cast<float>(expected.energy_J_per_m * surface);
  state.time_s_per_m = static_cast<float>(expected.time_s_per_m * surface);
  state.risk_per_m = static_cast<float>(-std::log1p(-policy.held() * std::min(weak, 1.0 - 1e-12)) /
                                        policy.correlation_length_m);
  state.weak = static_cast<float>(weak);
  state.pull_margin = static_cast<float>(belief.pull.value - gradient);
  state.category = categoryAt(belief.pull.value, belief.sinkage.value, gradient);
  state.class_index = static_cast<std::uint8_t>(class_index);
  state.refusal =
      refusal(state, weak, {.driven = mean, .braked = gradient - std::max(weakness, 0.0)}, ground);
  return state;
}

double GroundModel::cost_J_per_m(const TravelState& state) const noexcept {
  if (state.refusal != Refusal::None) return std::numeric_limits<double>::infinity();
  return static_cast<double>(state.energy_J_per_m) +
         parts_.policy.time_weight_W * static_cast<double>(state.time_s_per_m) +
         parts_.policy.risk_weight_J * static_cast<double>(state.risk_per_m);
}

GroundCost GroundModel::ground(int class_index, int other_class, const GroundBelief& belief) const {
  GroundCost ground;
  auto states = std::make_shared<TravelTable>();
  for (int bin = 0; bin < TravelCurve::kBins; ++bin) {
    TravelState& s = (*states)[static_cast<std::size_t>(bin)];
    s = state(class_index, belief, TravelCurve::gradient(bin));
    if (other_class != class_index) s = worse(s, state(other_class, belief, TravelCurve::gradient(bin)));
  }
  ground.crossing = class_index == other_class ? crossing(class_index)
                                               : std::make_shared<const CrossSlope>(CrossSlope::harder(
                                                     *crossing(class_index), *crossing(other_class)));
  ground.curve =
      priced(*states, ground.crossing.get(),
             {.energy = 1.0, .time_W = parts_.policy.time_weight_W, .risk_J = parts_.policy.risk_weight_J});
  ground.states = std::move(states);
  const TravelState& flat = (*ground.states)[TravelCurve::kBins / 2];
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
  const bool tips = rover.centre_of_mass_height_m > 0.0;
  return {.max_along = std::tan(rover.max_pitch_rad),
          .max_across = std::tan(rover.max_roll_rad),
          .stance = tips ? std::make_shared<const terramech::RoverStance>(rover) : nullptr,
          .outline = {rover.wheelbase_m, rover.track_m, rover.track_m + rover.wheel.width_m}};
}

}  // namespace talus::costmap
