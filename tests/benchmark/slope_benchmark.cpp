#include <benchmark/benchmark.h>

#include <talus/terramech/mobility/slope_equilibrium.hpp>

/// Time of rover equilibria on inclined planes.
namespace talus::terramech {
namespace {

const Soil kSand{.name = "dry_sand",
                 .cohesion_Pa = 1040.0,
                 .friction_angle_rad = 0.4887,
                 .sinkage_exponent = 1.1,
                 .cohesive_modulus = 990.0,
                 .frictional_modulus = 1528430.0,
                 .shear_modulus_m = 0.02};
const Rover kRover{.name = "mer",
                   .mass_kg = 176.0,
                   .gravity_m_s2 = 3.71,
                   .wheel_count = 6,
                   .wheel = {.radius_m = 0.125, .width_m = 0.16},
                   .wheelbase_m = 1.22,
                   .track_m = 1.06,
                   .clearance_m = 0.29,
                   .centre_of_mass_height_m = 0.47,
                   .max_torque_Nm = 45.0,
                   .steering = Steering::AllWheel};

void slopeEquilibrium(benchmark::State& state) {
  const SlopeEquilibrium equilibrium{kSand, kRover};
  int k = 0;
  for (auto _ : state) {
    k = (k + 1) % 961;
    benchmark::DoNotOptimize(equilibrium.at({-0.45 + 0.03 * (k % 31), -0.45 + 0.03 * (k / 31)}));
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(slopeEquilibrium);

}  // namespace
}  // namespace talus::terramech
