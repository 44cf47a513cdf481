#include <numbers>

#include <talus/terramech/io/csv_reader.hpp>

namespace talus::terramech {
namespace unit_test {

TEST(Unit, ConvertsWithinOneDimensionOnly) {
  EXPECT_DOUBLE_EQ(conversion("deg", "rad").value(), std::numbers::pi / 180.0);  // Closed form.
  EXPECT_EQ(conversion("kPa", "Pa"), 1000.0);
  EXPECT_EQ(conversion("mm", "m"), 1e-3);
  EXPECT_EQ(conversion("kPa", "N"), std::nullopt);
  EXPECT_EQ(conversion("furlong", "m"), std::nullopt);
}

TEST(Unit, UnitIsTheLongestKnownSuffix) {
  EXPECT_EQ(unitOf("gravity_m_s2"), "m_s2");
  EXPECT_EQ(unitOf("max_torque_Nm"), "Nm");
  EXPECT_EQ(unitOf("density_kg_m3"), "kg_m3");
  EXPECT_EQ(unitOf("sinkage_exponent"), "");
  EXPECT_EQ(unitOf("m"), "");
}

}  // namespace unit_test
}  // namespace talus::terramech
