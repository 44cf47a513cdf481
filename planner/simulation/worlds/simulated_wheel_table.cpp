#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <talus/planner/simulation/worlds/simulated_wheel_table.hpp>
#include <talus/terramech/contact/wong_reece.hpp>
#include <talus/terramech/contact/wong_reece_batch.hpp>
#include <talus/terramech/effects/refined_model.hpp>
#include <talus/terramech/mobility/steady_wheel.hpp>

namespace talus::planner {
namespace {

using Row = SimulatedWheelTable::Row;

// For a soil that cannot carry the wheel.
constexpr Row kSunk{-1.0, 1.0, 1.0, 0.0};

Row between(const Row& a, const Row& b, double t) {
  return {a.pull + t * (b.pull - a.pull), a.torque + t * (b.torque - a.torque),
          a.sinkage + t * (b.sinkage - a.sinkage), a.hold + t * (b.hold - a.hold)};
}

// Wheel operations of all entries of the table.
std::vector<terramech::WheelOperation> operations(const terramech::Rover& rover) {
  std::vector<terramech::WheelOperation> all;
  for (std::size_t sheet = 0; sheet < SimulatedWheelTable::kAngles; ++sheet)
    for (std::size_t layer = 0; layer < SimulatedWheelTable::kLoads; ++layer)
      for (std::size_t i = 0; i < SimulatedWheelTable::kRows; ++i)
        all.push_back({.load_N = SimulatedWheelTable::load(layer) * terramech::wheelLoad_N(rover),
                       .slip = SimulatedWheelTable::slip(i),
                       .slip_angle_rad = SimulatedWheelTable::angle_rad(sheet),
                       .gravity_m_s2 = rover.gravity_m_s2});
  return all;
}

std::vector<Row> solved(const terramech::Soil& soil, const terramech::Rover& rover) {
  const std::vector<terramech::WheelOperation> all = operations(rover);
  std::vector<terramech::WheelCase> cases;
  cases.reserve(all.size());
  for (const auto& operation : all) cases.push_back(terramech::wheelCase(soil, rover.wheel, operation));
  std::vector<terramech::WheelForces> forces(cases.size());
  terramech::equilibria(cases, forces);
  std::vector<Row> rows;
  rows.reserve(all.size());
  for (std::size_t k = 0; k < all.size(); ++k) {
    const terramech::WheelForces& f = forces[k];
    const double load_N = all[k].load_N, radius_m = rover.wheel.radius_m;
    rows.push_back(std::isfinite(f.sinkage_m)
                       ? Row{f.drawbar_pull_N / load_N, f.torque_Nm / (load_N * radius_m),
                             f.sinkage_m / radius_m, -f.side_force_N / load_N}
                       : kSunk);
  }
  return rows;
}

std::vector<Row> predicted(const terramech::RefinedModel& model, const terramech::Rover& rover) {
  std::vector<terramech::WheelState> states;
  for (const auto& operation : operations(rover)) {
    states.push_back(
        terramech::steadyWheel(rover, operation.load_N, operation.slip, operation.slip_angle_rad));
    states.back().slope_rad = 0.0;
    states.back().pass_index = 1.0;
  }
  terramech::SolvedContacts contacts;
  std::vector<Row> rows;
  rows.reserve(states.size());
  for (const terramech::Reading& r : terramech::predict(model, states, contacts))
    rows.push_back(r.sinkage_m >= rover.wheel.radius_m
                       ? kSunk
                       : Row{r.drawbar_pull_N / r.load_N, r.torque_Nm / (r.load_N * rover.wheel.radius_m),
                             r.sinkage_m / rover.wheel.radius_m, -r.side_force_N / r.load_N});
  return rows;
}

terramech::RefinedModel modelOf(const terramech::Soil& soil, const std::vector<terramech::Effect>& effects) {
  terramech::RefinedModel model;
  model.soil = soil;
  model.effects = effects;
  model.slip_along_travel = false;
  return model;
}

// The lower of two nodes around a coordinate, and the position between the nodes [0, 1].
struct Between {
  std::size_t first;
  double share;
};

Between nodesAbout(double position, std::size_t nodes) {
  const double inside = std::clamp(position, 0.0, static_cast<double>(nodes - 1));
  const auto first = std::min(static_cast<std::size_t>(inside), nodes - 2);
  return {first, inside - static_cast<double>(first)};
}

}  // namespace

SimulatedWheelTable::SimulatedWheelTable(const terramech::Soil& soil, const terramech::Rover& rover,
                                         const std::vector<terramech::Effect>& effects)
    : rows_(effects.empty() ? solved(soil, rover) : predicted(modelOf(soil, effects), rover)) {}

Row SimulatedWheelTable::row(std::size_t i, double load_over_flat, std::size_t sheet) const noexcept {
  const auto [k, share] = nodesAbout((load_over_flat - load(0)) / (load(1) - load(0)), kLoads);
  const Row* layer = rows_.data() + (sheet * kLoads + k) * kRows;
  return between(layer[i], layer[kRows + i], share);
}

Row SimulatedWheelTable::onSheet(double slip, double load_over_flat, std::size_t sheet) const noexcept {
  const auto [i, share] = nodesAbout((slip + 1.0) * 0.5 * (kRows - 1), kRows);
  return between(row(i, load_over_flat, sheet), row(i + 1, load_over_flat, sheet), share);
}

Row SimulatedWheelTable::at(double slip, double load_over_flat, double slip_angle_rad) const noexcept {
  const auto [sheet, share] = nodesAbout(std::abs(slip_angle_rad) / angle_rad(1), kAngles);
  const Row near = onSheet(slip, load_over_flat, sheet);
  return share == 0.0 ? near : between(near, onSheet(slip, load_over_flat, sheet + 1), share);
}

}  // namespace talus::planner
