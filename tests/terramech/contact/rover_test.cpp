#include <cmath>
#include <stdexcept>

#include <talus/terramech/contact/rover.hpp>

namespace talus::terramech {
namespace rover_test {

using testing::HasSubstr;
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
