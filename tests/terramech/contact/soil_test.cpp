#include <cmath>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include <refused.hpp>

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

}  // namespace soil_test
}  // namespace talus::terramech
