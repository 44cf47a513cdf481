#include <algorithm>
#include <cmath>
#include <utility>

#include <talus/planner/simulation/true_world.hpp>
#include <talus/terramech/contact/load_transfer.hpp>
#include <talus/terramech/mobility/rut.hpp>

namespace talus::planner {
namespace {

constexpr double kHighestSlip = 0.98;

bool sameSoil(const terramech::Soil& a, const terramech::Soil& b) {
  return a.cohesion_Pa == b.cohesion_Pa && a.friction_angle_rad == b.friction_angle_rad &&
         a.sinkage_exponent == b.sinkage_exponent && a.cohesive_modulus == b.cohesive_modulus &&
         a.frictional_modulus == b.frictional_modulus && a.shear_modulus_m == b.shear_modulus_m &&
         a.c1 == b.c1 && a.c2 == b.c2;
}

// A wheel in a hole of its own shape, d deep, rises by d over sqrt(2 r d): the mean slope out of it (ours).
double slopeOutOf(double dug_m, double radius_m) {
  return std::sqrt(std::max(dug_m, 0.0) / (2.0 * radius_m));
}

// The common slip at which the wheels pull what is asked: the least one, since on soft ground the pull falls
// again as the wheel digs in.
struct Balance {
  double slip = kHighestSlip;
  bool stuck = true;
};

struct LoadedTable {
  const WheelTable* table;
  double load;   // over that on the flat
  double share;  // of the rover's
};

Balance balanced(const std::vector<LoadedTable>& wheels, double demand) {
  double before = 0.0;
  for (std::size_t row = 0; row < WheelTable::kRows && WheelTable::slip(row) <= kHighestSlip; ++row) {
    double pull = 0.0;
    for (const LoadedTable& w : wheels) pull += w.share * w.table->row(row, w.load).pull;
    if (pull >= demand) {
      if (row == 0) return {-1.0, false};
      const double t = (demand - before) / (pull - before);
      return {WheelTable::slip(row - 1) + t * (WheelTable::slip(row) - WheelTable::slip(row - 1)), false};
    }
    before = pull;
  }
  return {};
}

}  // namespace

TrueWorld::TrueWorld(const WorldSoils& soils, const terramech::Rover& rover,
                     maps::Raster<std::uint8_t> class_index)
    : rover_(rover),
      class_index_(std::move(class_index)),
      classes_(soils.classes.size()),
      soils_(soils.classes),
      effects_(soils.effects),
      patches_(soils.patches) {
  for (const SoilPatch& patch : patches_) {
    const auto alike = std::find_if(soils_.begin() + static_cast<std::ptrdiff_t>(classes_), soils_.end(),
                                    [&](const auto& soil) { return sameSoil(soil, patch.soil); });
    patch_soil_.push_back(static_cast<std::size_t>(alike - soils_.begin()));
    if (alike == soils_.end()) soils_.push_back(patch.soil);
  }
  for (const auto& soil : soils_)
    tables_.push_back(
        {WheelTable(soil, rover_, effects_), WheelTable(terramech::rutted(soil), rover_, effects_)});
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

// Axles evenly over the wheelbase.
std::vector<TrueWorld::WheelState> TrueWorld::standing(const Motion& motion) const {
  const int axles = std::max(rover_.wheel_count / 2, 2);
  std::vector<double> along_m;
  for (int wheel = 0; wheel < 2 * axles; ++wheel)
    along_m.push_back(rover_.wheelbase_m * (0.5 - static_cast<double>(wheel / 2) / (axles - 1)));
  const std::vector<double> loads_N = terramech::wheelLoads_N(rover_, motion.gradient, along_m);
  std::vector<WheelState> wheels;
  for (std::size_t w = 0; w < along_m.size(); ++w) {
    const double across_m = w % 2 == 0 ? 0.5 * rover_.track_m : -0.5 * rover_.track_m;
    const maps::Point place{motion.place.x_m + along_m[w] * motion.heading.x - across_m * motion.heading.y,
                            motion.place.y_m + along_m[w] * motion.heading.y + across_m * motion.heading.x};
    wheels.push_back({.place = place,
                      .load_N = loads_N[w],
                      .passes = motion.ruts ? motion.ruts->passes(place) : 0,
                      .forces = {}});
  }
  return wheels;
}

TrueWorld::Step TrueWorld::drive(const Motion& motion) const {
  Step step;
  step.wheels = standing(motion);
  double load_N = 0.0;
  for (const WheelState& w : step.wheels) load_N += w.load_N;
  std::vector<LoadedTable> wheels;
  for (const WheelState& w : step.wheels) {
    const Tables& ground = tables_[soilAt(w.place)];
    wheels.push_back({.table = w.passes > 0 ? &ground.rut : &ground.fresh,
                      .load = w.load_N / terramech::wheelLoad_N(rover_),
                      .share = w.load_N / load_N});
  }
  const double demand = motion.gradient + slopeOutOf(motion.dug_m, rover_.wheel.radius_m);
  const Balance balance = balanced(wheels, demand);
  step.stuck = balance.stuck;
  step.slip = balance.slip;
  for (std::size_t w = 0; w < wheels.size(); ++w) {
    step.wheels[w].forces = wheels[w].table->at(step.slip, wheels[w].load);
    step.torque_Nm += step.wheels[w].forces.torque * step.wheels[w].load_N * rover_.wheel.radius_m;
  }
  // Power of all wheels over the speed: T omega / v with omega = v/(r (1 - i)); a braking wheel gives nothing
  // back.
  const double moving = 1.0 - std::max(step.slip, 0.0);
  step.speed_mps = rover_.max_speed_mps * moving;
  step.energy_J_per_m = std::max(step.torque_Nm, 0.0) / (rover_.wheel.radius_m * moving) +
                        rover_.hotel_power_W / step.speed_mps;
  return step;
}

}  // namespace talus::planner
