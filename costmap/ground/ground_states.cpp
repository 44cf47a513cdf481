#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <talus/costmap/ground/ground_model.hpp>
#include <talus/terramech/mobility/wheel_forces_table.hpp>
#include <talus/terramech/numerics/functions.hpp>

namespace talus::costmap {

// The limits of the pull are tan(slope -+ margin) by the addition theorem, infinite beyond a right angle.
terramech::CategoryThresholds GroundRules::thresholds(double gradient) const noexcept {
  constexpr double kSteeper = std::numeric_limits<double>::infinity();
  const double left = 1.0 - gradient * tan_margin, right = 1.0 + gradient * tan_margin;
  const double critical =
      policy.sinkage_critical > 0.0 ? policy.sinkage_critical : rover.clearance_m / rover.wheel.radius_m;
  return {.dp_low = right > 0.0 ? (gradient - tan_margin) / right : -kSteeper,
          .dp_high = left > 0.0 ? (gradient + tan_margin) / left : kSteeper,
          .z_threshold = std::min(policy.sinkage_threshold, critical),
          .z_critical = critical};
}

terramech::Category GroundRules::category(const GroundBelief& belief, double gradient) const {
  return terramech::categorise(
      {.drawbar_pull_over_load = belief.pull.value, .sinkage_over_radius = belief.sinkage.value},
      thresholds(gradient));
}

namespace {

constexpr int kStrengths = StrengthColumn::kStrengths;
constexpr float kRefused = std::numeric_limits<float>::infinity();
constexpr double kUpright_rad = 2e-4;  // interpolation error bound of the stability margin

// Integral of the normal distribution up to t, and integral of that, t P(t) + p(t): linear between nodes, with an error
// below 1e-6.
struct NormalIntegrals {
  double probability, excess;

  static NormalIntegrals at(double t) noexcept {
    constexpr double kEnd = 8.0, kPerUnit = 256.0;
    constexpr auto kNodes = static_cast<std::size_t>(2.0 * kEnd * kPerUnit) + 1;
    static const std::vector<NormalIntegrals> nodes = [] {
      std::vector<NormalIntegrals> all;
      for (std::size_t k = 0; k < kNodes; ++k) {
        const double x = static_cast<double>(k) / kPerUnit - kEnd, below = terramech::normalProbability(x);
        all.push_back({below, x * below + terramech::normalDensity(x)});
      }
      return all;
    }();
    if (!(t > -kEnd)) return {0.0, 0.0};
    if (!(t < kEnd)) return {1.0, t};
    const double place = (t + kEnd) * kPerUnit;
    const auto k = static_cast<std::size_t>(place);
    const double share = place - static_cast<double>(k);
    const NormalIntegrals &a = nodes[k], &b = nodes[k + 1];
    return {a.probability + share * (b.probability - a.probability),
            a.excess + share * (b.excess - a.excess)};
  }
};

using Entries = Eigen::Array<float, kStrengths, 1>;

// Probability that the motion holds, and weights of the entries of a column in the integral of a quantity over the
// strengths that hold, for a normal excess of the strength over the least that holds. The quantity is linear between
// entries; its integral is that of its steps of slope, (s - s_k)+ each.
struct StrengthWeights {
  Entries of;
  double holds = 0.0;
};

StrengthWeights weightsOf(double excess, double std) noexcept {
  constexpr auto& at = StrengthColumn::kExcess;
  const double width = std::max(std, 1e-9), per_width = 1.0 / width;
  NormalIntegrals here = NormalIntegrals::at(excess * per_width);
  StrengthWeights w{.of = Entries::Zero(), .holds = here.probability};
  double above = w.holds;
  for (std::size_t k = 0; k + 1 < at.size(); ++k) {
    const NormalIntegrals next = NormalIntegrals::at((excess - at[k + 1]) * per_width);
    const double share = width / (at[k + 1] - at[k]) * (here.excess - next.excess);
    w.of[static_cast<Eigen::Index>(k)] = static_cast<float>(above - share);
    above = share;
    here = next;
  }
  w.of[kStrengths - 1] = static_cast<float>(above);
  return w;
}

}  // namespace

GroundStates::GroundStates(std::shared_ptr<const GroundRules> rules, std::vector<StrengthOfClass> classes,
                           const GroundBelief& belief, double added_J_per_m)
    : rules_(std::move(rules)),
      classes_(std::move(classes)),
      belief_(belief),
      added_J_per_m_(added_J_per_m) {}

std::shared_ptr<const TravelStates> GroundStates::withAdded(double added_J_per_m) const {
  return std::make_shared<const GroundStates>(rules_, classes_, belief_, added_J_per_m_ + added_J_per_m);
}

int GroundStates::rows() const noexcept {
  int rows = 1;
  for (const StrengthOfClass& of : classes_) rows = std::max(rows, of.lattice->rows());
  return rows;
}

GroundStates::Node GroundStates::node(const StrengthOfClass& of, int row, int bin) const {
  const TravelPolicy& policy = rules_->policy;
  Node out;
  TravelState& state = out.state;
  state.class_index = static_cast<std::uint8_t>(of.class_index);
  if (!of.lattice->contains(bin)) {
    state.refusal = Refusal::Pitch;
    state.category = rules_->category(belief_, TravelCurve::gradient(bin));
    return out;
  }
  const StrengthColumn& column = of.lattice->node(row, bin);
  const double excess = of.strength.value - static_cast<double>(column.least);
  const StrengthWeights w = weightsOf(excess, of.strength.std);
  const double reserve = of.strength.value - static_cast<double>(column.required);
  const double weak =
      reserve < 0.0 ? 1.0 : NormalIntegrals::at(-reserve / std::max(of.strength.std, 1e-9)).probability;
  const double surface = std::hypot(1.0, TravelCurve::gradient(bin));
  const auto at = [&column, place = StrengthColumn::place(excess)](StrengthColumn::Quantity quantity) {
    return column.at(quantity, place);
  };
  const auto expected = [&](StrengthColumn::Quantity quantity) {
    const auto& entries = column.entries[static_cast<std::size_t>(quantity)];
    const auto all = static_cast<double>((w.of * Eigen::Map<const Entries>(entries.data())).sum()),
               limit = static_cast<double>(entries.front());
    return std::pair(surface * (w.holds > 1e-9 ? all / w.holds : limit),
                     surface * (all + 2.0 * (1.0 - w.holds) * limit));
  };
  const auto [energy_J, energy_cost_J] = expected(StrengthColumn::kEnergy);
  const auto [time_s, time_cost_s] = expected(StrengthColumn::kTime);
  const double risk = -std::log1p(-policy.held() * std::min(weak, 1.0 - 1e-12)) / policy.correlation_length_m;
  const double climb = of.lattice->climbOf(row, bin);
  state.slip = static_cast<float>(at(StrengthColumn::kSlip));
  state.sinkage_m = static_cast<float>(at(StrengthColumn::kSinkage) * of.deeper);
  state.torque_Nm = static_cast<float>(at(StrengthColumn::kTorque));
  state.energy_J_per_m = static_cast<float>(energy_J + added_J_per_m_);
  state.time_s_per_m = static_cast<float>(time_s);
  state.risk_per_m = static_cast<float>(risk);
  state.weak = static_cast<float>(weak);
  state.pull_margin = static_cast<float>(belief_.pull.value - climb);
  state.category = rules_->category(belief_, climb);
  if (excess >= 0.0) state.slip_angle_rad = static_cast<float>(at(StrengthColumn::kSlipAngle));
  if (excess >= 0.0) state.side_force_over_load = static_cast<float>(at(StrengthColumn::kSideForce));
  state.stability_margin_rad = column.margin_rad;
  const bool excluded = (state.category == terramech::Category::Dangerous && !policy.allow_dangerous) ||
                        (state.category == terramech::Category::Marginal && !policy.allow_marginal);
  if (static_cast<double>(column.margin_rad) < kUpright_rad)
    state.refusal = Refusal::Tips;
  else if (static_cast<double>(std::abs(state.torque_Nm)) > rules_->rover.max_torque_Nm)
    state.refusal = Refusal::Torque;
  else if (reserve < 0.0 || weak > policy.max_immobilisation)
    // What holds without a gradient across lacks side force.
    state.refusal = of.strength.value < static_cast<double>(of.lattice->node(0, bin).required) || row == 0
                        ? Refusal::Pull
                        : Refusal::SideForce;
  else if (static_cast<double>(state.sinkage_m) >= rules_->rover.clearance_m)
    state.refusal = Refusal::Sinkage;
  else if (excluded)
    state.refusal = Refusal::Category;
  out.terms = {energy_cost_J + added_J_per_m_, time_cost_s, risk};
  return out;
}

GroundStates::Node GroundStates::node(int row, int bin) const {
  Node out = node(classes_.front(), row, bin);
  for (std::size_t k = 1; k < classes_.size(); ++k) {
    const Node other = node(classes_[k], row, bin);
    out.state = worse(out.state, other.state);
    for (std::size_t t = 0; t < out.terms.size(); ++t) out.terms[t] = std::max(out.terms[t], other.terms[t]);
  }
  return out;
}

// Returns the terms of all nodes, raised from row to row.
std::vector<TravelStates::Terms> GroundStates::terms() const {
  const int all = rows();
  std::vector<Terms> terms(static_cast<std::size_t>(all * TravelCurve::kBins),
                           {kRefused, kRefused, kRefused});
  for (int row = 0; row < all; ++row)
    for (int bin = 0; bin < TravelCurve::kBins; ++bin) {
      const auto i = static_cast<std::size_t>(row * TravelCurve::kBins + bin);
      if (row > 0 && !(terms[i - TravelCurve::kBins][0] < kRefused)) continue;
      const Node here = node(row, bin);
      if (here.state.refusal != Refusal::None) continue;
      for (std::size_t k = 0; k < 3; ++k)
        terms[i][k] =
            std::max(static_cast<float>(here.terms[k]), row > 0 ? terms[i - TravelCurve::kBins][k] : 0.0F);
    }
  return terms;
}

bool GroundStates::isAllowed(std::size_t node) const {
  std::call_once(once_, [this] {
    for (const auto& [energy_J, time_s, risk] : terms()) allowed_.push_back(energy_J < kRefused);
  });
  return allowed_[node];
}

TravelState GroundStates::at(int row, int bin) const {
  TravelState state = node(row, bin).state;
  const auto index = [&](int r) { return static_cast<std::size_t>(r * TravelCurve::kBins + bin); };
  for (int r = std::min(row, rows() - 1); r > 0 && state.refusal == Refusal::None && !isAllowed(index(r));
       --r)
    state.refusal = node(r - 1, bin).state.refusal;
  return state;
}

double GroundStates::climb(const terramech::Gradient& gradient) const {
  double most = gradient.along;
  for (const StrengthOfClass& of : classes_) most = std::max(most, of.lattice->climb(gradient));
  return most;
}

double GroundStates::steepest(double gradient) const {
  double most = gradient;
  for (const StrengthOfClass& of : classes_) most = std::max(most, of.lattice->steepest(gradient));
  return most;
}

TravelForecast GroundStates::forecast(const terramech::Gradient& gradient) const {
  TravelForecast out{.added_J_per_m = added_J_per_m_, .fails_below = 0.0};
  const StrengthOfClass& of = classes_.front();
  TravelCurve::forNodesAround(gradient, [&](int row, int bin, double weight) {
    if (!of.lattice->contains(bin)) return;
    const StrengthColumn& column = of.lattice->node(row, bin);
    const double reserve = of.strength.value - static_cast<double>(column.least);
    const double scale = weight * std::hypot(1.0, TravelCurve::gradient(bin));
    out.fails_below -= weight * reserve / std::max(of.strength.std, 1e-6);
    out.fresh_energy += weight * static_cast<double>(column.fresh_energy);
    out.fresh_time += weight * static_cast<double>(column.fresh_time);
    for (int d = 0; d < TravelForecast::kDeviates; ++d) {
      const StrengthColumn::Place place =
          StrengthColumn::place(reserve + TravelForecast::deviate(d) * of.strength.std);
      const auto k = static_cast<std::size_t>(d);
      out.energy_J_per_m[k] += static_cast<float>(scale * column.at(StrengthColumn::kEnergy, place));
      out.time_s_per_m[k] += static_cast<float>(scale * column.at(StrengthColumn::kTime, place));
    }
  });
  return out;
}

namespace {

using terramech::RefinedModel;
using terramech::Soil;
using terramech::SoilDeviation;

constexpr std::array<std::pair<double Soil::*, double SoilDeviation::*>, 8> kFields{
    {{&Soil::cohesion_Pa, &SoilDeviation::cohesion_Pa},
     {&Soil::friction_angle_rad, &SoilDeviation::friction_angle_rad},
     {&Soil::sinkage_exponent, &SoilDeviation::sinkage_exponent},
     {&Soil::cohesive_modulus, &SoilDeviation::cohesive_modulus},
     {&Soil::frictional_modulus, &SoilDeviation::frictional_modulus},
     {&Soil::shear_modulus_m, &SoilDeviation::shear_modulus_m},
     {&Soil::slip_sinkage_exponent, &SoilDeviation::slip_sinkage_exponent},
     {&Soil::rut_stiffness, &SoilDeviation::rut_stiffness}}};

// Uncertain parameters of a model: each function adds a change to its parameter and returns the new value.
struct UncertainParameters {
  std::vector<std::function<double(RefinedModel&, double)>> add;
  std::vector<double> covariance;  // row-major
};

// Ground of a model at the reference slip: pull and resistance, pull in a rut less that on fresh ground, all over
// load, thrust there, and the logarithm of the shear modulus.
using Reference = Eigen::Matrix<double, 5, 1>;
enum ReferenceIndex { kPull, kResistance, kInRut, kThrustInRut, kLogModulus };

Reference referenceOf(RefinedModel model, const terramech::Rover& rover, double gravity_exponent = 1.0) {
  model.soil = underGravity(model.soil, rover.gravity_m_s2, gravity_exponent);
  const SteadyWheel fresh = terramech::mobilityReference(model, rover),
                    rut = terramech::mobilityReference(terramech::rutted(model), rover, 2);
  return Reference{fresh.drawbar_pull_over_load, fresh.torque_over_load_radius - fresh.drawbar_pull_over_load,
                   rut.drawbar_pull_over_load - fresh.drawbar_pull_over_load, rut.torque_over_load_radius,
                   std::log(model.soil.shear_modulus_m)};
}

// Central difference for a change that `add` makes: change of the reference over change of the parameter.
template <typename Add>
Reference changeOf(const RefinedModel& model, const terramech::Rover& rover, double step, const Add& add) {
  RefinedModel more = model, less = model;
  const double width = add(more, step) - add(less, -step);
  if (!(width > 0.0)) return Reference::Zero();
  return (referenceOf(more, rover) - referenceOf(less, rover)) / width;
}

double addTo(double& value, double change) {
  return value = std::max(value + change, 1e-3 * value);
}

GroundClass classOf(int number, const RefinedModel& tested, const UncertainParameters& parameters,
                    const terramech::Rover& rover) {
  // Step of the central difference, in standard deviations: a half keeps parameters near their bounds in range.
  constexpr double kStep = 0.5;
  constexpr double kGravityExponentStd = 0.5;  // of underGravity(): ours
  constexpr double kShapeStep = 0.05;
  terramech::requireForces(tested);
  GroundClass ground;
  ground.number = number;
  ground.soil = underGravity(tested.soil, rover.gravity_m_s2);
  ground.effects = terramech::withoutSensors(tested).effects;
  const auto count = static_cast<Eigen::Index>(parameters.add.size());
  if (count == 0) return ground;
  const Eigen::Map<const Eigen::MatrixXd> covariance(parameters.covariance.data(), count, count);
  Eigen::Matrix<double, 5, Eigen::Dynamic> slope(5, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const double std = std::sqrt(std::max(0.0, covariance(k, k)));
    try {
      slope.col(k) = changeOf(tested, rover, kStep * std, parameters.add[static_cast<std::size_t>(k)]);
    } catch (const std::invalid_argument& e) {
      std::ostringstream text;
      text << e.what() << "; it is the mean with half of its std " << std;
      throw std::invalid_argument(text.str());
    }
  }
  const auto stdOf = [&](const Reference& of) {
    const Eigen::RowVectorXd gradient = of.transpose() * slope;
    return std::sqrt(std::max(0.0, (gradient * covariance).dot(gradient)));
  };
  const Reference mean = referenceOf(tested, rover);
  if (const double std = stdOf(Reference::Unit(kPull)); std > 0.0) ground.mean_std = std;
  if (tested.soil.test_gravity_m_s2 > rover.gravity_m_s2)
    ground.mean_std =
        std::hypot(ground.mean_std, (referenceOf(tested, rover, 1.0 - kGravityExponentStd) - mean)[kPull]);
  ground.resistance_std = std::max(ground.resistance_std, stdOf(Reference::Unit(kResistance)));
  ground.modulus_std = std::max(ground.modulus_std, stdOf(Reference::Unit(kLogModulus)));
  // What strength, resistance (by the sinkage exponent) and shear modulus leave of the pull in a rut.
  const auto by = [&](double Soil::*field) {
    return changeOf(tested, rover, kShapeStep * tested.soil.*field,
                    [field](RefinedModel& model, double change) { return addTo(model.soil.*field, change); });
  };
  Reference left = Reference::Unit(kInRut);
  left[kPull] = 1.0 - mean[kThrustInRut] / (mean[kPull] + mean[kResistance]);
  const Reference by_exponent = by(&Soil::sinkage_exponent), by_modulus = by(&Soil::shear_modulus_m);
  left[kResistance] = -left.dot(by_exponent) / by_exponent[kResistance];
  left[kLogModulus] = -left.dot(by_modulus) / by_modulus[kLogModulus];
  ground.rut_std = stdOf(left);
  return ground;
}

}  // namespace

GroundClass groundClass(int number, const terramech::SoilPrior& prior, const terramech::Rover& rover) {
  UncertainParameters parameters;
  parameters.covariance.resize(kFields.size() * kFields.size());
  for (std::size_t k = 0; k < kFields.size(); ++k) {
    const auto field = kFields[k].first;
    parameters.covariance[k * kFields.size() + k] = std::pow(prior.deviation.*kFields[k].second, 2);
    parameters.add.emplace_back(
        [field](RefinedModel& model, double change) { return addTo(model.soil.*field, change); });
  }
  GroundClass ground = classOf(number, terramech::onSoil(prior.mean), parameters, rover);
  ground.rut_stiffness_std = prior.deviation.rut_stiffness;
  return ground;
}

GroundClass groundClass(int number, const RefinedModel& model, const terramech::Rover& rover) {
  UncertainParameters parameters{.add = {}, .covariance = model.covariance};
  if (!model.covariance.empty())
    for (const terramech::FittedParameter& p : model.fitted)
      parameters.add.emplace_back([p](RefinedModel& moved, double change) {
        const double next = terramech::value(moved, p) + change;
        terramech::setValue(moved, p, next);
        return next;
      });
  return classOf(number, model, parameters, rover);
}

}  // namespace talus::costmap
