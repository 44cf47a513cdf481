#include <cmath>
#include <stdexcept>

#include <talus/terramech/contact/soil.hpp>

namespace talus::terramech {
namespace soil_test {

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

TEST(Soil, RefusalNamesSoilFieldValueAndBound) {
  Soil soil = sand();
  soil.cohesion_Pa = -1.0;
  EXPECT_THAT([&] { validate(soil); },
              Throws<std::invalid_argument>(
                  Property(&std::exception::what, HasSubstr("soil 'sand': cohesion_Pa = -1, must be >= 0"))));
}

// Property: magnitudes that no ground has are refused, be they in range of a formula or not.
TEST(Soil, ImpossibleMagnitudesAreRefused) {
  for (const auto& [field, value] : {std::pair{&Soil::cohesion_Pa, 1e15},
                                     {&Soil::shear_modulus_m, 1e-15},
                                     {&Soil::shear_modulus_m, 1e15},
                                     {&Soil::sinkage_exponent, 1e-15},
                                     {&Soil::density_kg_m3, 1e-15},
                                     {&Soil::density_kg_m3, 1e15}}) {
    Soil soil = sand();
    soil.*field = value;
    EXPECT_THROW(validate(soil), std::invalid_argument) << value;
  }
}

TEST(Soil, NotANumberIsRefusedInEveryField) {
  for (double Soil::*field :
       {&Soil::cohesion_Pa, &Soil::friction_angle_rad, &Soil::sinkage_exponent, &Soil::cohesive_modulus,
        &Soil::frictional_modulus, &Soil::shear_modulus_m, &Soil::c1, &Soil::c2, &Soil::density_kg_m3}) {
    Soil soil = sand();
    soil.*field = std::nan("");
    EXPECT_THROW(validate(soil), std::invalid_argument);
  }
}

}  // namespace soil_test
}  // namespace talus::terramech
