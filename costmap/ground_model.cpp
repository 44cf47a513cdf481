#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include <talus/costmap/ground_model.hpp>
#include <talus/terramech/mobility/rut.hpp>
#include <talus/terramech/numerics/range.hpp>

namespace talus::costmap {
namespace {

using terramech::Category;
using terramech::MobilityState;

double normalCdf(double x) {
  return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

// P(value < bound) for a normal estimate; a step where it is certain.
double probabilityBelow(const Estimate& value, double bound) {
  if (value.std <= 0.0) return value.value < bound ? 1.0 : 0.0;
  return normalCdf((bound - value.value) / value.std);
}

struct Expected {
  double energy_J_per_m = 0.0;
  double time_s_per_m = 0.0;
};

// Three-point Gauss-Hermite expectation over the pull, of the drives that are possible at all, along the
// surface.
Expected expectedDrive(const terramech::MobilityCurve& curve, const Estimate& shift, double gradient) {
  constexpr std::array<std::pair<double, double>, 3> kPoints{
      {{-1.7320508075688772, 1.0 / 6.0}, {0.0, 2.0 / 3.0}, {1.7320508075688772, 1.0 / 6.0}}};
  Expected sum;
  double weight = 0.0;
  for (const auto& [x, w] : kPoints) {
    const MobilityState s = curve.at(std::atan(gradient - shift.value - x * shift.std));
    if (!s.feasible) continue;
    sum.energy_J_per_m += w * s.energy_J_per_m;
    sum.time_s_per_m += w / s.speed_mps;
    weight += w;
  }
  return weight > 0.0 ? Expected{sum.energy_J_per_m / weight, sum.time_s_per_m / weight} : Expected{};
}

double slopeAtSlip_rad(const terramech::MobilityCurve& curve, double slip) {
  double low = curve.minSlope_rad(), high = curve.maxSlope_rad();
  for (int halving = 0; halving < 30 && low < high; ++halving) {
    const double middle = 0.5 * (low + high);
    (curve.at(middle).slip < slip ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// In the rut of an equal wheel: as data have shown, or as rutted() supposes.
terramech::MobilityCurve inRut(const GroundClass& ground, const terramech::Rover& rover) {
  if (terramech::knowsPasses(ground.effects)) return mobilityOf(ground, rover, {.first_pass = 2});
  GroundClass rut = ground;
  rut.soil = terramech::rutted(ground.soil);
  return mobilityOf(rut, rover);
}

Category lower(Category category) {
  return category == Category::Safe       ? Category::Marginal
         : category == Category::Marginal ? Category::Dangerous
                                          : category;
}

}  // namespace

terramech::MobilityCurve mobilityOf(const GroundClass& ground, const terramech::Rover& rover,
                                    const terramech::MobilityOptions& options) {
  if (ground.effects.empty()) return {ground.soil, rover, options};
  terramech::RefinedModel model;
  model.soil = ground.soil;
  model.effects = ground.effects;
  return {model, rover, options};
}

GroundModel::GroundModel(Parts parts) : parts_(std::move(parts)) {
  if (parts_.classes.empty())
    throw std::invalid_argument("ground model: classes is empty, must hold at least one");
  const terramech::RangeCheck check("drive policy");
  check.within("slope_margin_rad", parts_.policy.slope_margin_rad, {0.0, 0.5});
  tan_margin_ = std::tan(parts_.policy.slope_margin_rad);
  check.within("max_immobilisation", parts_.policy.max_immobilisation, {0.0, 1.0});
  check.atLeast("time_weight_W", parts_.policy.time_weight_W, 0.0);
  check.within("entrapment", parts_.policy.entrapment, {0.0, 1.0});
  check.atLeast("risk_weight_J", parts_.policy.risk_weight_J, 0.0);
  check.above("correlation_length_m", parts_.policy.correlation_length_m, 0.0);
  for (const GroundClass& c : parts_.classes) {
    if (&parts_.classes[static_cast<std::size_t>(classIndex(c.number))] != &c)
      throw std::invalid_argument("ground model: class " + std::to_string(c.number) + " is declared twice");
    wheel_curves_.push_back(mobilityOf(c, parts_.rover));
    rut_curves_.push_back(inRut(c, parts_.rover));
    curves_.push_back(terramech::knowsPasses(c.effects)
                          ? mobilityOf(c, parts_.rover, {.axles = parts_.rover.wheel_count / 2})
                          : wheel_curves_.back());
  }
}

int GroundModel::classIndex(int number) const noexcept {
  for (std::size_t i = 0; i < parts_.classes.size(); ++i)
    if (parts_.classes[i].number == number) return static_cast<int>(i);
  return -1;
}

GroundBelief GroundModel::prior(int class_index) const {
  const auto i = static_cast<std::size_t>(class_index);
  const GroundClass& c = parts_.classes[i];
  const auto& reference = wheel_curves_[i].reference();
  return {.pull = {reference.drawbar_pull_over_load, std::hypot(c.pull_std, c.mean_std)},
          .sinkage = {reference.sinkage_over_radius, c.sinkage_std}};
}

SteadyWheel GroundModel::steady(int class_index, const DrivenWheel& wheel) const noexcept {
  const terramech::MobilityCurve& driven = curve(class_index, wheel.in_rut);
  const double slope_rad = slopeAtSlip_rad(driven, wheel.slip);
  const MobilityState state = driven.at(slope_rad);
  const double radius_m = parts_.rover.wheel.radius_m;
  const double load_N = terramech::wheelLoad_N(parts_.rover) * std::cos(slope_rad);
  return {.gradient = std::tan(slope_rad),
          .sinkage_over_radius = state.sinkage_m / radius_m,
          .torque_over_load_radius = state.torque_Nm / (load_N * radius_m)};
}

SteadyWheel GroundModel::reference(int class_index, bool in_rut) const noexcept {
  const terramech::MobilityReference& at = curve(class_index, in_rut).reference();
  return {at.drawbar_pull_over_load, at.sinkage_over_radius, at.torque_over_load_radius};
}

// tan(slope -+ margin) by the addition theorem; beyond a right angle nothing is enough.
GroundModel::Edges GroundModel::edges(double gradient) const noexcept {
  const double left = 1.0 - gradient * tan_margin_, right = 1.0 + gradient * tan_margin_;
  constexpr double kSteeper = std::numeric_limits<double>::infinity();
  return {.low = right > 0.0 ? (gradient - tan_margin_) / right : -kSteeper,
          .high = left > 0.0 ? (gradient + tan_margin_) / left : kSteeper};
}

Category GroundModel::categoryAt(double pull, double sinkage, double gradient) const {
  const DrivePolicy& policy = parts_.policy;
  const Edges edge = edges(gradient);
  const double critical = policy.sinkage_critical > 0.0
                              ? policy.sinkage_critical
                              : parts_.rover.clearance_m / parts_.rover.wheel.radius_m;
  return terramech::categorise({.drawbar_pull_over_load = pull, .sinkage_over_radius = sinkage},
                               {.dp_low = edge.low,
                                .dp_high = edge.high,
                                .z_threshold = std::min(policy.sinkage_threshold, critical),
                                .z_critical = critical});
}

Ranked GroundModel::category(const GroundBelief& belief, double gradient) const {
  const Edges edge = edges(gradient);
  const double below_low = probabilityBelow(belief.pull, edge.low);
  const double below_high = probabilityBelow(belief.pull, edge.high);
  // What each of the three pull ranks becomes at the believed sinkage; their chances add up.
  const std::array<std::pair<double, double>, 3> ranks{
      {{std::numeric_limits<double>::infinity(), 1.0 - below_high},
       {gradient, below_high - below_low},
       {-std::numeric_limits<double>::infinity(), below_low}}};
  const Category mean = categoryAt(belief.pull.value, belief.sinkage.value, gradient);
  double probability = 0.0;
  for (const auto& [pull, chance] : ranks)
    if (categoryAt(pull, belief.sinkage.value, gradient) == mean) probability += chance;
  return {mean, probability};
}

DriveState GroundModel::state(int class_index, const GroundBelief& belief, double gradient) const {
  const auto& curve = curves_[static_cast<std::size_t>(class_index)];
  const auto& policy = parts_.policy;
  const terramech::Rover& rover = parts_.rover;
  const auto& reference = wheel_curves_[static_cast<std::size_t>(class_index)].reference();
  const Estimate shift{belief.pull.value - reference.drawbar_pull_over_load, belief.pull.std};
  const MobilityState s = curve.at(std::atan(gradient - shift.value));
  const Expected expected = expectedDrive(curve, shift, gradient);
  const double surface = std::hypot(1.0, gradient);
  const double deeper =
      reference.sinkage_over_radius > 0.0 ? belief.sinkage.value / reference.sinkage_over_radius : 1.0;
  const auto& ground = parts_.classes[static_cast<std::size_t>(class_index)];
  // At most, the ground pulls what it pulls at its strongest slip. What is uncertain of the class as a whole
  // is met once on a route and shows in the category's probability; only what differs from place to place is
  // a hazard that every metre has.
  const double reserve = curve.strongest().drawbar_pull_over_load - reference.drawbar_pull_over_load;
  const Estimate most{belief.pull.value + std::max(reserve, 0.0), std::min(belief.pull.std, ground.pull_std)};
  const double stuck = probabilityBelow(most, gradient);

  DriveState state;
  state.slip = static_cast<float>(s.slip);
  state.sinkage_m = static_cast<float>(s.sinkage_m * deeper);
  state.torque_Nm = static_cast<float>(s.torque_Nm);
  state.energy_J_per_m = static_cast<float>(expected.energy_J_per_m * surface);
  state.time_s_per_m = static_cast<float>(expected.time_s_per_m * surface);
  state.risk_per_m = static_cast<float>(-std::log1p(-policy.entrapment * std::min(stuck, 1.0 - 1e-12)) /
                                        policy.correlation_length_m);
  state.pull_margin = static_cast<float>(belief.pull.value - gradient);
  state.category = categoryAt(belief.pull.value, belief.sinkage.value, gradient);

  const bool refused = (state.category == Category::Dangerous && !policy.allow_dangerous) ||
                       (state.category == Category::Marginal && !policy.allow_marginal);
  if (std::abs(s.torque_Nm) > rover.max_torque_Nm)
    state.refusal = Refusal::Torque;
  else if (!s.feasible || stuck > policy.max_immobilisation)
    state.refusal = Refusal::Pull;
  else if (static_cast<double>(state.sinkage_m) >= rover.clearance_m)
    state.refusal = Refusal::Sinkage;
  else if (refused)
    state.refusal = Refusal::Category;
  return state;
}

double GroundModel::cost_J_per_m(const DriveState& state) const noexcept {
  if (state.refusal != Refusal::None) return std::numeric_limits<double>::infinity();
  return static_cast<double>(state.energy_J_per_m) +
         parts_.policy.time_weight_W * static_cast<double>(state.time_s_per_m) +
         parts_.policy.risk_weight_J * static_cast<double>(state.risk_per_m);
}

DriveGround GroundModel::ground(int class_index, const GroundBelief& belief, bool demoted) const {
  DriveGround ground;
  auto states = std::make_shared<DriveTable>();
  for (int bin = 0; bin < DriveCurve::kBins; ++bin) {
    DriveState& s = (*states)[static_cast<std::size_t>(bin)];
    s = state(class_index, belief, DriveCurve::gradient(bin));
    if (demoted) {
      s.category = lower(s.category);
      const bool refused = (s.category == Category::Dangerous && !parts_.policy.allow_dangerous) ||
                           (s.category == Category::Marginal && !parts_.policy.allow_marginal);
      if (s.refusal == Refusal::None && refused) s.refusal = Refusal::Category;
    }
    ground.curve.cost_J_per_m[static_cast<std::size_t>(bin)] = static_cast<float>(cost_J_per_m(s));
  }
  ground.states = std::move(states);
  return ground;
}

DriveCost::Limits GroundModel::limits() const {
  return {.max_along = std::tan(parts_.rover.max_pitch_rad),
          .max_across = std::tan(parts_.rover.max_roll_rad)};
}

}  // namespace talus::costmap
