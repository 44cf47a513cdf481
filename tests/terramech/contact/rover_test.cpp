#include <cmath>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include <refused.hpp>

#include <talus/terramech/contact/wheel_on_soil.hpp>

namespace talus::terramech {

namespace rover_test {

TEST(Wheel, SizesMustBePositiveAndGrousersAreOptional) {
  EXPECT_NO_THROW(validate(Wheel{}));
  EXPECT_NO_THROW(validate({.radius_m = 0.2, .width_m = 0.1, .grouser_height_m = 0.01, .grouser_count = 24}));
  for (const double bad : {0.0, -0.1, 1e-12, 1e14, std::nan(""), HUGE_VAL}) {
    EXPECT_THROW(validate({.radius_m = bad}), std::invalid_argument) << bad;
    EXPECT_THROW(validate({.width_m = bad}), std::invalid_argument) << bad;
  }
  EXPECT_THROW(validate({.grouser_height_m = -0.001}), std::invalid_argument);
  EXPECT_THROW(validate({.grouser_height_m = std::nan("")}), std::invalid_argument);
  EXPECT_THROW(validate({.grouser_count = -1}), std::invalid_argument);
}

using testing::HasSubstr;
using testing::Property;
using testing::Throws;

Soil sand() {
  return {.name = "sand", .friction_angle_rad = 0.55, .cohesive_modulus = 950.0, .frictional_modulus = 1.5e6};
}

TEST(Soil, SinkageModulusIsKcOverWidthPlusKphi) {
  // Closed form: Eq. A.1.
  EXPECT_DOUBLE_EQ(sinkageModulus(sand(), 0.1), 950.0 / 0.1 + 1.5e6);
}

TEST(Soil, ErrorNamesSoilFieldValueAndBound) {
  Soil soil = sand();
  soil.cohesion_Pa = -1.0;
  EXPECT_THAT([&] { validate(soil); },
              Throws<std::invalid_argument>(
                  Property(&std::exception::what, HasSubstr("soil 'sand': cohesion_Pa = -1, must be >= 0"))));
}

// Property: physically implausible magnitudes are rejected, even if the formulas accept them.
TEST(Soil, ImplausibleMagnitudesAreRejected) {
  for (const auto& [field, value, text] :
       {std::tuple{&Soil::cohesion_Pa, 1e15, "cohesion_Pa = 1e+15, must be in [0, 1e+09]"},
        {&Soil::shear_modulus_m, 1e-15, "shear_modulus_m = 1e-15, must be in [1e-09, 1000]"},
        {&Soil::shear_modulus_m, 1e15, "shear_modulus_m = 1e+15, must be in [1e-09, 1000]"},
        {&Soil::sinkage_exponent, 1e-15, "sinkage_exponent = 1e-15, must be in [0.001, 100]"},
        {&Soil::density_kg_m3, 1e-15, "density_kg_m3 = 1e-15, must be in [0.1, 1e+06]"},
        {&Soil::density_kg_m3, 1e15, "density_kg_m3 = 1e+15, must be in [0.1, 1e+06]"}}) {
    Soil soil = sand();
    soil.*field = value;
    EXPECT_REFUSED(validate(soil), std::invalid_argument, text);
  }
}

TEST(Soil, NanIsRejectedInEveryField) {
  for (const auto& [name, field] : {std::pair{"cohesion_Pa", &Soil::cohesion_Pa},
                                    {"friction_angle_rad", &Soil::friction_angle_rad},
                                    {"sinkage_exponent", &Soil::sinkage_exponent},
                                    {"cohesive_modulus", &Soil::cohesive_modulus},
                                    {"frictional_modulus", &Soil::frictional_modulus},
                                    {"shear_modulus_m", &Soil::shear_modulus_m},
                                    {"c1", &Soil::c1},
                                    {"c2", &Soil::c2},
                                    {"density_kg_m3", &Soil::density_kg_m3}}) {
    Soil soil = sand();
    soil.*field = std::nan("");
    EXPECT_REFUSED(validate(soil), std::invalid_argument, name + std::string(" = nan, must be finite"));
  }
}

using testing::ThrowsMessage;

Rover rover() {
  return {.name = "A",
          .mass_kg = 120.0,
          .gravity_m_s2 = 3.71,
          .wheel_count = 6,
          .wheelbase_m = 1.2,
          .track_m = 1.0,
          .clearance_m = 0.3,
          .max_torque_Nm = 30.0};
}

TEST(Rover, WheelLoadIsWeightOverWheelCount) {
  EXPECT_DOUBLE_EQ(wheelLoad_N(rover()), 120.0 * 3.71 / 6.0);  // Closed form: m g / count.
}

TEST(Rover, EveryLengthMassAndLimitIsChecked) {
  EXPECT_NO_THROW(validate(rover()));
  for (double Rover::*field : {&Rover::mass_kg, &Rover::gravity_m_s2, &Rover::wheelbase_m, &Rover::track_m,
                               &Rover::clearance_m, &Rover::max_torque_Nm, &Rover::max_speed_mps})
    for (const double bad : {0.0, -1.0, std::nan("")}) {
      Rover r = rover();
      r.*field = bad;
      EXPECT_THROW(validate(r), std::invalid_argument);
    }
  for (double Rover::*field :
       {&Rover::centre_of_mass_height_m, &Rover::turning_radius_m, &Rover::hotel_power_W}) {
    Rover r = rover();
    r.*field = 0.0;
    EXPECT_NO_THROW(validate(r));
    r.*field = -1.0;
    EXPECT_THROW(validate(r), std::invalid_argument);
  }
  for (const double bad : {1e-15, 1e-9, 1e-4, 1001.0}) {
    Rover r = rover();
    r.turning_radius_m = bad;
    EXPECT_THAT([&] { validate(r); }, ThrowsMessage<std::invalid_argument>(HasSubstr("must be 0 or")));
  }
  for (const auto& [field, bad] : {std::pair{&Rover::mass_kg, 1e-3},
                                   {&Rover::mass_kg, 1e7},
                                   {&Rover::max_speed_mps, 1e-12},
                                   {&Rover::max_speed_mps, 101.0}}) {
    Rover r = rover();
    r.*field = bad;
    EXPECT_THROW(validate(r), std::invalid_argument) << bad;
  }
  Rover in_millimetres = rover();
  in_millimetres.clearance_m = 250.0;
  EXPECT_THROW(validate(in_millimetres), std::invalid_argument);
  for (double Rover::*field : {&Rover::max_pitch_rad, &Rover::max_roll_rad})
    for (const double bad : {-0.1, 1.6, std::nan("")}) {
      Rover r = rover();
      r.*field = bad;
      EXPECT_THROW(validate(r), std::invalid_argument);
    }
}

TEST(Rover, ErrorNamesRoverAndField) {
  Rover one_wheel = rover();
  one_wheel.wheel_count = 1;
  EXPECT_THAT([&] { validate(one_wheel); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("rover 'A': wheels.count = 1, must be >= 2")));
  Rover flat = rover();
  flat.wheel.width_m = 0.0;
  EXPECT_THAT([&] { validate(flat); }, ThrowsMessage<std::invalid_argument>(HasSubstr("wheels.width_m = 0")));
}

}  // namespace rover_test

}  // namespace talus::terramech
