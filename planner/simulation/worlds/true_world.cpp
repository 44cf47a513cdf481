#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>

#include <talus/planner/simulation/simulation.hpp>
#include <talus/terramech/contact/load_transfer.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/contact/wong_reece_batch.hpp>
#include <talus/terramech/effects/refined_model.hpp>
#include <talus/terramech/mobility/turning.hpp>
#include <talus/terramech/mobility/wheel_forces_table.hpp>

namespace talus::planner {

namespace {

using terramech::Soil;

constexpr double kClear_m = 2.0;  // distance of start and goal from random patches

// Limits the factor, so that extreme draws leave a soil within its range.
double scaled(double value, double factor) {
  return value * std::max(factor, 0.2);
}

Soil varied(Soil soil, double spread, std::mt19937_64& random) {
  std::normal_distribution<double> factor(1.0, spread);
  soil.cohesion_Pa = scaled(soil.cohesion_Pa, factor(random));
  soil.friction_angle_rad = std::atan(scaled(std::tan(soil.friction_angle_rad), factor(random)));
  const double stiffness = std::max(factor(random), 0.2);
  soil.cohesive_modulus *= stiffness;
  soil.frictional_modulus *= stiffness;
  return soil;
}

// Random generator of one class: depends on the world's seed and the class number, not on other declared
// classes.
std::mt19937_64 drawsOf(std::uint64_t seed, int number) {
  const auto low = [](std::uint64_t word) { return static_cast<std::uint32_t>(word); };
  std::seed_seq words{low(seed), low(seed >> 32), static_cast<std::uint32_t>(number)};
  return std::mt19937_64(words);
}

// The spectrum of exp(-d / l) is that of k = (a, b) / (l |c|) with normal a, b and c.
GroundDepartures departures(const std::vector<costmap::GroundClass>& classes, std::uint64_t seed) {
  constexpr int kWaves = 256;
  constexpr double kCorrelation_m = costmap::TravelPolicy{}.correlation_length_m;
  GroundDepartures made;
  std::normal_distribution<double> normal;
  for (const costmap::GroundClass& ground : classes) {
    std::mt19937_64 own = drawsOf(seed + 1, ground.number);
    made.of_class.push_back(ground.mean_std * normal(own));
    made.place_std.push_back(ground.pull_std);
  }
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> phase(0.0, 2.0 * std::numbers::pi);
  for (int k = 0; k < kWaves; ++k) {
    const double x = normal(random), y = normal(random),
                 per_m = 1.0 / (kCorrelation_m * std::max(std::abs(normal(random)), 1e-3));
    made.waves.push_back({x * per_m, y * per_m, phase(random)});
  }
  return made;
}

maps::Point anywhere(const maps::Grid& grid, std::mt19937_64& random) {
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const double x = share(random), y = share(random);
  return {grid.south_west.x_m + x * grid.width * grid.resolution_m,
          grid.south_west.y_m + y * grid.height * grid.resolution_m};
}

}  // namespace

WorldSoils drawWorld(const Truth& truth, const std::vector<costmap::GroundClass>& classes,
                     const maps::Grid& grid, const WorldDraw& draw) {
  WorldSoils world;
  for (const costmap::GroundClass& ground : classes) {
    const auto stated = truth.classes.find(ground.number);
    std::mt19937_64 own = drawsOf(draw.seed, ground.number);
    world.classes.push_back(
        varied(stated == truth.classes.end() ? ground.soil : stated->second, truth.spread, own));
    double& rut = world.classes.back().rut_stiffness;
    if (truth.as_believed)
      rut = std::max(1.0, rut + ground.rut_stiffness_std * std::normal_distribution<double>()(own));
  }
  if (truth.as_believed) world.departures = departures(classes, draw.seed);
  world.patches = truth.patches;
  world.effects = truth.effects;
  std::mt19937_64 random(draw.seed);
  const Soil patch_soil = truth.random_patches > 0 ? varied(truth.patch_soil, truth.spread, random) : Soil{};
  std::uniform_real_distribution<double> size(0.5, 1.5);
  for (int i = 0; i < truth.random_patches; ++i) {
    const maps::Point centre = anywhere(grid, random);
    const double radius_m = truth.patch_radius_m * size(random);
    const auto near = [&](const maps::Point& p) {
      return std::hypot(centre.x_m - p.x_m, centre.y_m - p.y_m) < radius_m + kClear_m;
    };
    if (!near(draw.start) && !near(draw.goal)) world.patches.push_back({centre, radius_m, patch_soil});
  }
  return world;
}

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

constexpr double kHighestSlip = 0.98;

bool sameSoil(const terramech::Soil& a, const terramech::Soil& b) {
  return a.cohesion_Pa == b.cohesion_Pa && a.friction_angle_rad == b.friction_angle_rad &&
         a.sinkage_exponent == b.sinkage_exponent && a.cohesive_modulus == b.cohesive_modulus &&
         a.frictional_modulus == b.frictional_modulus && a.shear_modulus_m == b.shear_modulus_m &&
         a.c1 == b.c1 && a.c2 == b.c2 && a.slip_sinkage_exponent == b.slip_sinkage_exponent;
}

// A wheel in a hole of its own shape and depth d rises by d over a length of sqrt(2 r d): the mean slope to
// climb (ours).
double slopeOutOf(double dug_m, double radius_m) {
  return std::sqrt(std::max(dug_m, 0.0) / (2.0 * radius_m));
}

struct LoadedTable {
  const SimulatedWheelTable* table;
  double load;      // relative to the load on level ground
  double share;     // share of the rover's weight
  double strength;  // of the ground relative to its soil
};

// Forces on ground with `strength` times the shear stresses of its soil.
SimulatedWheelTable::Row scaled(SimulatedWheelTable::Row forces, double strength) {
  forces.pull += (strength - 1.0) * forces.torque;
  forces.torque *= strength;
  forces.hold *= strength;
  return forces;
}

// Required force divided by the normal force; `across` is a magnitude.
struct RequiredForce {
  double along, across;
};

RequiredForce demandOf(double along, double across) {
  const double run = std::hypot(1.0, along);
  return {along * std::sqrt(1.0 + along * along + across * across) / run, std::abs(across) / run};
}

// Common slip and slip angle at which the wheels give the required forces.
struct Balance {
  double slip = kHighestSlip;
  double angle_rad = 0.0;
  bool stuck = true, slides = false;
};

// Forces along and across the direction of travel of wheels turned uphill by the slip angle of a sheet.
RequiredForce given(const std::vector<LoadedTable>& wheels, std::size_t row, std::size_t sheet) {
  double pull = 0.0, hold = 0.0;
  for (const LoadedTable& w : wheels) {
    const SimulatedWheelTable::Row forces = scaled(w.table->row(row, w.load, sheet), w.strength);
    pull += w.share * forces.pull;
    hold += w.share * forces.hold;
  }
  const double c = std::cos(SimulatedWheelTable::angle_rad(sheet)),
               s = std::sin(SimulatedWheelTable::angle_rad(sheet));
  return {pull * c - hold * s, hold * c + pull * s};
}

// Smallest slip at one slip angle that gives the required force along the direction of travel, and the side
// force at that slip. On soft ground the pull decreases again at higher slip, because the wheel digs in.
struct Steady {
  double slip, hold;
  bool brakes;  // false: even locked wheels pull more than required, so the rover slides down
};

std::optional<Steady> steady(const std::vector<LoadedTable>& wheels, double along, std::size_t sheet) {
  RequiredForce before{};
  for (std::size_t row = 0;
       row < SimulatedWheelTable::kRows && SimulatedWheelTable::slip(row) <= kHighestSlip; ++row) {
    const RequiredForce now = given(wheels, row, sheet);
    if (now.along >= along) {
      if (row == 0) return Steady{-1.0, now.across, now.along <= along};
      const double t = (along - before.along) / (now.along - before.along);
      return Steady{SimulatedWheelTable::slip(row - 1) +
                        t * (SimulatedWheelTable::slip(row) - SimulatedWheelTable::slip(row - 1)),
                    before.across + t * (now.across - before.across), true};
    }
    before = now;
  }
  return std::nullopt;
}

// Returns the smallest slip angle at which the wheels hold the rover, interpolated between two sheets with an
// equilibrium.
Balance balanced(const std::vector<LoadedTable>& wheels, const RequiredForce& demand) {
  std::optional<Steady> before;
  for (std::size_t sheet = 0; sheet < SimulatedWheelTable::kAngles; ++sheet) {
    const auto now = steady(wheels, demand.along, sheet);
    if (sheet == 0 && !now) return {};
    if (now && !now->brakes) break;
    if (now && now->hold >= demand.across) {
      const double t = before ? (demand.across - before->hold) / (now->hold - before->hold) : 1.0;
      const double from = sheet == 0 ? 0.0 : SimulatedWheelTable::angle_rad(sheet - 1);
      return {before ? before->slip + t * (now->slip - before->slip) : now->slip,
              from + t * (SimulatedWheelTable::angle_rad(sheet) - from), false, false};
    }
    before = now;
  }
  return {.stuck = true, .slides = true};
}

}  // namespace

std::uint64_t Ruts::square(const maps::Point& place) const noexcept {
  const auto index = [this](double value_m) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(value_m / square_m_))) &
           0xffffffffU;
  };
  return index(place.x_m) << 32 | index(place.y_m);
}

void Ruts::press(const maps::Point& place) {
  const auto [found, fresh] = marks_.try_emplace(square(place), Mark{.pressed_at_m = odometer_m_});
  if (fresh) return;
  Mark& mark = found->second;
  if (movedOn(mark)) {
    mark.before = mark.passes;
    ++mark.passes;
  }
  mark.pressed_at_m = odometer_m_;
}

int Ruts::passes(const maps::Point& place) const {
  const auto found = marks_.find(square(place));
  if (found == marks_.end()) return 0;
  return movedOn(found->second) ? found->second.passes : found->second.before;
}

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

TrueWorld::TrueWorld(const WorldSoils& soils, const terramech::Rover& rover,
                     maps::Raster<std::uint8_t> class_index)
    : rover_(rover),
      class_index_(std::move(class_index)),
      classes_(soils.classes.size()),
      soils_(soils.classes),
      effects_(soils.effects),
      departures_(soils.departures),
      patches_(soils.patches) {
  for (terramech::Soil& soil : soils_) soil = underGravity(soil, rover.gravity_m_s2);
  for (SoilPatch& patch : patches_) patch.soil = underGravity(patch.soil, rover.gravity_m_s2);
  for (const SoilPatch& patch : patches_) {
    const auto alike = std::find_if(soils_.begin() + static_cast<std::ptrdiff_t>(classes_), soils_.end(),
                                    [&](const auto& soil) { return sameSoil(soil, patch.soil); });
    patch_soil_.push_back(static_cast<std::size_t>(alike - soils_.begin()));
    if (alike == soils_.end()) soils_.push_back(patch.soil);
  }
  // Only the soils that occur get tables: a class raster may declare hundreds of classes, and a table takes a
  // tenth of a second.
  std::vector<bool> occurs(soils_.size(), false);
  for (const std::uint8_t index : class_index_.values())
    occurs[std::min<std::size_t>(index, classes_ - 1)] = true;
  occurs[0] = true;  // outside the map
  for (const std::size_t soil : patch_soil_) occurs[soil] = true;
  tables_.resize(soils_.size());
  for (std::size_t i = 0; i < soils_.size(); ++i)
    if (occurs[i])
      tables_[i] = Tables{.fresh = SimulatedWheelTable(soils_[i], rover_, effects_),
                          .rut = SimulatedWheelTable(terramech::rutted(soils_[i]), rover_, effects_)};
}

double GroundDepartures::field(const maps::Point& place) const noexcept {
  double sum = 0.0;
  for (const Wave& w : waves) sum += std::cos(w.x * place.x_m + w.y * place.y_m + w.phase);
  return sum * std::sqrt(2.0 / static_cast<double>(std::max<std::size_t>(waves.size(), 1)));
}

double TrueWorld::strengthAt(const maps::Point& place) const noexcept {
  const std::size_t soil = soilAt(place);
  if (soil >= departures_.of_class.size()) return 1.0;
  const double departure =
      departures_.of_class[soil] + departures_.place_std[soil] * departures_.field(place);
  return std::max(0.0, 1.0 + departure / tables_[soil]->fresh.at(0.5, 1.0).torque);
}

std::size_t TrueWorld::soilAt(const maps::Point& place, double margin_m) const noexcept {
  for (std::size_t i = patches_.size(); i-- > 0;) {
    const SoilPatch& patch = patches_[i];
    if (std::hypot(place.x_m - patch.centre.x_m, place.y_m - patch.centre.y_m) < patch.radius_m + margin_m)
      return patch_soil_[i];
  }
  const auto cell = class_index_.grid().cellAt(place);
  return cell ? std::min<std::size_t>(class_index_[*cell], classes_ - 1) : 0;
}

// Axles are evenly spaced over the wheelbase. On a cross slope, load moves to the lower wheels by the moment
// of the weight's component across the slope, as along the slope; no wheel carries less than a tenth of its
// share.
std::vector<TrueWorld::SimulatedWheel> TrueWorld::standing(const Motion& motion) const {
  const int axles = std::max(rover_.wheel_count / 2, 2);
  std::vector<double> along_m;
  for (int wheel = 0; wheel < 2 * axles; ++wheel)
    along_m.push_back(rover_.wheelbase_m * (0.5 - static_cast<double>(wheel / 2) / (axles - 1)));
  const std::vector<double> loads_N = terramech::wheelLoads_N(rover_, motion.gradient, along_m);
  const double run = std::hypot(1.0, motion.gradient),
               leaning = std::copysign(demandOf(motion.gradient, motion.across).across, motion.across) * 2.0 *
                         rover_.centre_of_mass_height_m / rover_.track_m,
               moved = std::clamp(leaning, -0.9, 0.9), less = run / std::hypot(run, motion.across);
  std::vector<SimulatedWheel> wheels;
  for (std::size_t w = 0; w < along_m.size(); ++w) {
    const double side = w % 2 == 0 ? 1.0 : -1.0, across_m = side * 0.5 * rover_.track_m;
    const maps::Point place{motion.place.x_m + along_m[w] * motion.heading.x - across_m * motion.heading.y,
                            motion.place.y_m + along_m[w] * motion.heading.y + across_m * motion.heading.x};
    wheels.push_back({.place = place,
                      .load_N = loads_N[w] * less * (1.0 - side * moved),
                      .passes = motion.ruts ? motion.ruts->passes(place) : 0,
                      .forces = {}});
  }
  return wheels;
}

TrueWorld::Step TrueWorld::drive(const Motion& motion) const {
  Step step;
  step.wheels = standing(motion);
  double load_N = 0.0;
  for (const SimulatedWheel& w : step.wheels) load_N += w.load_N;
  std::vector<LoadedTable> wheels;
  for (const SimulatedWheel& w : step.wheels) {
    const Tables& ground = *tables_[soilAt(w.place)];
    wheels.push_back({.table = w.passes > 0 ? &ground.rut : &ground.fresh,
                      .load = w.load_N / terramech::wheelLoad_N(rover_),
                      .share = w.load_N / load_N,
                      .strength = strengthAt(w.place)});
  }
  RequiredForce demand = demandOf(motion.gradient, motion.across);
  demand.along += slopeOutOf(motion.dug_m, rover_.wheel.radius_m);
  const Balance balance = balanced(wheels, demand);
  step.stuck = balance.stuck;
  step.slides = balance.slides;
  step.slip = balance.slip;
  step.slip_angle_rad = -std::copysign(balance.angle_rad, motion.across);
  for (std::size_t w = 0; w < wheels.size(); ++w) {
    step.wheels[w].forces =
        scaled(wheels[w].table->at(step.slip, wheels[w].load, balance.angle_rad), wheels[w].strength);
    step.torque_Nm += step.wheels[w].forces.torque * step.wheels[w].load_N * rover_.wheel.radius_m;
  }
  // Power of all wheels over the speed of travel: T omega / v with omega = v cos(beta) / (r (1 - i)). Braking
  // recovers no energy.
  const double moving = (1.0 - std::max(step.slip, 0.0)) / std::cos(balance.angle_rad);
  step.speed_mps = rover_.max_speed_mps * moving;
  step.energy_J_per_m = std::max(step.torque_Nm, 0.0) / (rover_.wheel.radius_m * moving) +
                        rover_.hotel_power_W / step.speed_mps;
  return step;
}

terramech::TurnEffort TrueWorld::turn(const costmap::Direction& from, const Motion& motion) const {
  const costmap::Direction& to = motion.heading;
  const double turned_rad =
      std::abs(std::atan2(from.x * to.y - from.y * to.x, from.x * to.x + from.y * to.y));
  if (!(turned_rad > 1e-6)) return {};
  const terramech::Soil& soil = soils_[soilAt(motion.place)];
  const Step flat = drive({.place = motion.place, .heading = to, .ruts = motion.ruts});
  double sinkage = 0.0;
  for (const SimulatedWheel& w : flat.wheels) sinkage = std::max(sinkage, w.forces.sinkage);
  const double rolling = flat.stuck ? 0.0 : flat.energy_J_per_m - rover_.hotel_power_W / flat.speed_mps;
  const terramech::TurnEffort radian =
      terramech::turnEfforts(
          rover_, {.lateral_resistance = std::tan(soil.friction_angle_rad),
                   .bulldozing_N = terramech::bulldozing_N(soil, rover_, sinkage * rover_.wheel.radius_m),
                   .rolling_J_per_m = std::max(0.0, rolling)})
          .at_vertex;
  return {.energy_J = turned_rad * radian.energy_J, .time_s = turned_rad * radian.time_s};
}

namespace {

// Standard deviations of the rover's sensors, equal to those assumed by WheelObserver.
constexpr double kSlipNoise = 0.02, kAngleNoise_rad = 0.02, kTorqueNoise = 0.05, kSinkageNoise = 0.03;
constexpr double kSecondNoise = 0.03;  // of the slip by rim speed and odometry
// Standard deviation of the difference between the slip of one wheel and the slip of the rover.
constexpr double kEncoderNoise = 0.005;
// Magnitudes of the faults of SensorFault.
constexpr double kSlipBias = -0.2, kTorqueOffset = 0.15, kSinkageOffset = -0.1;
constexpr double kDisplaced_m = 5.0, kDisplacedFor_m = 10.0;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

}  // namespace

const std::vector<std::string_view>& sensorFaultNames() {
  static const std::vector<std::string_view> names{"none",           "slip_stuck",    "slip_biased",
                                                   "odometry_stuck", "torque_offset", "sinkage_datum",
                                                   "silent",         "pose_displaced"};
  return names;
}

terramech::Telemetry telemetryOf(const WheelMeasurements& look) {
  using R = const costmap::TelemetryReading&;
  using All = const WheelMeasurements&;
  constexpr std::pair<const char*, double (*)(R, All)> kColumns[] = {
      {"time_s", [](R r, All) { return r.time_s; }},
      {"x_m", [](R r, All) { return r.place.x_m; }},
      {"y_m", [](R r, All) { return r.place.y_m; }},
      {"heading_rad", [](R, All all) { return all.heading_rad; }},
      {"slope_rad", [](R r, All) { return std::atan(r.gradient); }},
      {"roll_rad", [](R r, All) { return std::atan(r.across); }},
      {"slip", [](R r, All) { return r.slip; }},
      {"slip_angle_rad", [](R r, All) { return r.slip_angle_rad; }},
      {"rim_speed_mps", [](R, All all) { return all.rim_speed_mps; }},
      {"speed_mps", [](R r, All all) { return all.rim_speed_mps * (1.0 - r.speed_slip); }},
      {"load_N", [](R r, All) { return r.load_N; }},
      {"torque_Nm", [](R r, All) { return r.torque_Nm; }},
      {"sinkage_m", [](R r, All) { return r.sinkage_m; }},
      {"pass_index", [](R r, All) { return static_cast<double>(r.pass); }}};
  terramech::Telemetry rows{
      .source = "simulation", .numbers = {}, .words = {{"wheel", {}}}, .lines = {}, .rejected = {}};
  for (const auto& [name, field] : kColumns) rows.numbers.push_back({name, {}});
  for (std::size_t w = 0; w < look.wheels.size(); ++w) {
    if (std::isnan(look.wheels[w].slip)) continue;
    for (std::size_t c = 0; c < rows.numbers.size(); ++c)
      rows.numbers[c].values.push_back(kColumns[c].second(look.wheels[w], look));
    rows.words[0].values.push_back("w" + std::to_string(w + 1));
    rows.lines.push_back(rows.lines.size() + 1);
  }
  return rows;
}

SimulatedSensors::SimulatedSensors(const SensorOptions& options, const terramech::Rover& rover)
    : options_(options), rover_(rover), random_(options.seed), random_speed_(~options.seed) {
  if (!(options.pose_drift >= 0.0 && options.pose_drift <= kMostPoseDrift))
    throw std::invalid_argument("SensorOptions: pose_drift = " + std::to_string(options.pose_drift) +
                                ", must be 0 to " + std::to_string(kMostPoseDrift));
  const double way = std::uniform_real_distribution<double>(0.0, 6.283185307179586)(random_);
  drift_per_m_ = {options.pose_drift * std::cos(way), options.pose_drift * std::sin(way)};
  displaced_from_m_ = std::uniform_real_distribution<double>(5.0, 20.0)(random_);
  faulty_wheel_ =
      static_cast<std::size_t>(random_() % static_cast<std::uint64_t>(std::max(rover.wheel_count, 1)));
}

maps::Point SimulatedSensors::estimatedPlace(const maps::Point& place) const noexcept {
  return {place.x_m + drift_.x_m, place.y_m + drift_.y_m};
}

void SimulatedSensors::moved(double distance_m) {
  drift_.x_m += drift_per_m_.x_m * distance_m;
  drift_.y_m += drift_per_m_.y_m * distance_m;
  driven_m_ += distance_m;
}

bool SimulatedSensors::drops() {
  return options_.noise && std::uniform_real_distribution<double>(0.0, 1.0)(random_) < options_.dropout;
}

WheelMeasurements SimulatedSensors::look(const TrueWorld::Step& step, const Moment& moment) {
  const double radius_m = rover_.wheel.radius_m, noise = options_.noise ? 1.0 : 0.0;
  WheelMeasurements look{.heading_rad = std::atan2(moment.heading.y, moment.heading.x),
                         .slip_angle_rad = step.slip_angle_rad + noise * kAngleNoise_rad * normal_(random_),
                         .rim_speed_mps = rover_.max_speed_mps,
                         .wheels = {}};
  const double slip = step.slip + noise * kSlipNoise * normal_(random_);
  for (const TrueWorld::SimulatedWheel& wheel : step.wheels) {
    const double own_slip = slip + noise * kEncoderNoise * normal_(random_);
    const double torque = wheel.forces.torque * (1.0 + noise * kTorqueNoise * normal_(random_));
    const double sinkage = wheel.forces.sinkage * (1.0 + noise * kSinkageNoise * normal_(random_));
    look.wheels.push_back({.time_s = moment.time_s,
                           .place = estimatedPlace(wheel.place),
                           .load_N = wheel.load_N,
                           .slip = std::clamp(own_slip, -1.0, 1.0),
                           .torque_Nm = drops() ? kNone : torque * wheel.load_N * radius_m,
                           .sinkage_m = drops() ? kNone : sinkage * radius_m + moment.dug_m,
                           .gradient = moment.gradient,
                           .across = moment.across,
                           .slip_angle_rad = look.slip_angle_rad,
                           .drawbar_pull_N = kNone,
                           .pass = wheel.passes + 1});
    if (options_.second_slip)
      look.wheels.back().speed_slip = step.slip + noise * kSecondNoise * normal_speed_(random_speed_);
    spoil(look.wheels.back(), look.wheels.size() - 1);
  }
  return look;
}

void SimulatedSensors::spoil(costmap::TelemetryReading& reading, std::size_t wheel) {
  const double radius_m = rover_.wheel.radius_m;
  const bool mine = wheel == faulty_wheel_;
  const double displaced_m = driven_m_ - displaced_from_m_;
  switch (options_.fault) {
    case SensorFault::SlipStuck:
    case SensorFault::OdometryStuck:
      if (!mine && options_.fault == SensorFault::SlipStuck) return;
      if (!stuck_slip_) stuck_slip_ = reading.slip;
      reading.slip = *stuck_slip_;
      if (options_.fault == SensorFault::OdometryStuck) reading.speed_slip = reading.slip;
      return;
    case SensorFault::SlipBiased:
      if (mine) reading.slip = std::clamp(reading.slip + kSlipBias, -1.0, 1.0);
      return;
    case SensorFault::TorqueOffset:
      if (mine) reading.torque_Nm += kTorqueOffset * reading.load_N * radius_m;
      return;
    case SensorFault::SinkageDatum:
      if (mine) reading.sinkage_m = std::max(reading.sinkage_m + kSinkageOffset * radius_m, 0.0);
      return;
    case SensorFault::Silent:
      if (mine) reading.slip = reading.torque_Nm = reading.sinkage_m = kNone;
      return;
    case SensorFault::PoseDisplaced:
      if (displaced_m >= 0.0 && displaced_m < kDisplacedFor_m) reading.place.x_m += kDisplaced_m;
      return;
    case SensorFault::None:
      return;
  }
}

}  // namespace talus::planner
