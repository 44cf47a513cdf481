#include <cmath>
#include <memory>

#include <planner/rehearsal.hpp>

namespace talus::planner {
namespace {

terramech::Rover rover() {
  return {.name = "test rover",
          .mass_kg = 60.0,
          .gravity_m_s2 = 3.72,
          .wheel_count = 4,
          .wheel = {.radius_m = 0.12, .width_m = 0.12},
          .wheelbase_m = 0.8,
          .track_m = 0.6,
          .clearance_m = 0.2,
          .centre_of_mass_height_m = 0.3,
          .max_torque_Nm = 15.0,
          .max_speed_mps = 0.1,
          .hotel_power_W = 15.0};
}

terramech::Soil sand() {
  return {.name = "sand",
          .cohesion_Pa = 800.0,
          .friction_angle_rad = 0.63,
          .sinkage_exponent = 1.0,
          .cohesive_modulus = 1400.0,
          .frictional_modulus = 820000.0,
          .shear_modulus_m = 0.015};
}

terramech::Soil trap() {
  terramech::Soil soil = sand();
  soil.cohesion_Pa = 0.0;
  soil.friction_angle_rad = 0.42;
  soil.frictional_modulus = 300000.0;
  return soil;
}

maps::Grid grid() {
  return {.width = 60, .height = 40, .resolution_m = 1.0, .south_west = {}};
}

costmap::TraversabilityMap flatMap() {
  costmap::MapLayers layers;
  layers.elevation.elevation_m = maps::Raster<float>(grid(), 0.0F);
  return {std::move(layers),
          std::make_shared<costmap::GroundModel>(costmap::GroundModel::Parts{
              .rover = rover(), .classes = {{.number = 1, .soil = sand()}}, .policy = {}}),
          {}};
}

Rehearsal over(const WorldSoils& soils, bool senses) {
  const maps::Raster<std::uint8_t> classes(grid(), 0);
  const TrueWorld world(soils, rover(), classes);
  costmap::TraversabilityMap map = flatMap();
  RehearsalOptions options;
  options.start = {5.5, 20.5};
  options.goal = {54.5, 20.5};
  options.senses = senses;
  return rehearse(map, world, options);
}

TEST(Rehearsal, GroundThatIsAsBelievedIsDrivenAtOnce) {
  const Rehearsal drive = over({.classes = {sand()}, .patches = {}}, true);
  EXPECT_EQ(drive.outcome, Outcome::Reached);
  EXPECT_NEAR(drive.length_m, 49.0, 0.5);  // Closed form: straight over flat ground, to the goal
}

TEST(Rehearsal, AnUndeclaredTrapHoldsWhoDrivesIn) {
  const WorldSoils soils{.classes = {sand()}, .patches = {{{30.0, 20.5}, 4.0, trap()}}};
  EXPECT_EQ(over(soils, false).outcome, Outcome::Immobilised);
  // What the rehearsal shows and the rover does not yet master: with all wheels in ground that pulls less
  // than nothing, watching the slip comes too late.
  EXPECT_EQ(over(soils, true).outcome, Outcome::Immobilised);
}

TEST(Rehearsal, SameSeedSameDrive) {
  const WorldSoils soils{.classes = {sand()}, .patches = {{{30.0, 20.5}, 4.0, trap()}}};
  const Rehearsal a = over(soils, true), b = over(soils, true);
  EXPECT_EQ(a.track, b.track);
  EXPECT_EQ(a.energy_J, b.energy_J);
}

TEST(WheelTable, HoldsTheForwardModel) {
  const WheelTable table(sand(), rover());
  EXPECT_LT(table.at(0.0).pull, table.at(0.3).pull);
  EXPECT_LT(table.at(0.3).pull, table.at(0.6).pull);
  EXPECT_LT(table.at(-0.5).torque, 0.0);
}

}  // namespace
}  // namespace talus::planner
