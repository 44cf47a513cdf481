#include <cmath>
#include <filesystem>
#include <fstream>

#include <talus/terramech/contact/wong_reece.hpp>
#include <talus/terramech/tables/assessment.hpp>
#include <talus/terramech/tables/estimate_soil.hpp>

namespace talus::terramech {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const Soil kSoil{.name = "made",
                 .cohesion_Pa = 1500.0,
                 .friction_angle_rad = 0.45,
                 .sinkage_exponent = 1.0,
                 .cohesive_modulus = 0.0,
                 .frictional_modulus = 8e5,
                 .shear_modulus_m = 0.015};

// Exact rows of a wheel on the soil, in a file that goes with the object.
class Table {
 public:
  Table() : path_(std::filesystem::temp_directory_path() / "talus_estimate_soil_test.csv") {
    std::ofstream out(path_);
    out.precision(17);
    out << "load_N,torque_Nm,sinkage_m,slip,wheel_radius_m,wheel_width_m\n";
    for (int k = 0; k < 12; ++k) {
      const WheelOperation at{.load_N = 120.0 + 30.0 * (k % 3), .slip = 0.15 + 0.06 * k};
      const WheelForces f = equilibrium(kSoil, {.radius_m = 0.15, .width_m = 0.15}, at);
      out << at.load_N << ',' << f.torque_Nm << ',' << f.sinkage_m << ',' << at.slip << ",0.15,0.15\n";
    }
  }
  ~Table() { std::filesystem::remove(path_); }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

TEST(EstimateSoil, ExactRowsGiveTheSoilThatMadeThem) {
  const Table table;
  const SoilEstimate found =
      estimateSoil({.table = table.path(), .method = "wong-reece", .noise = 0.005}, {});
  EXPECT_EQ(found.rows_used, 12U);
  EXPECT_NEAR(found.cohesion_Pa, kSoil.cohesion_Pa, 150.0);
  EXPECT_NEAR(found.friction_angle_rad, kSoil.friction_angle_rad, 0.02);
}

TEST(EstimateSoil, NamesThatAreNotOnOfferAreRefused) {
  const Table table;
  EXPECT_THAT([&] { estimateSoil({.table = table.path(), .method = "wong-rece"}, {}); },
              ThrowsMessage<InputError>(HasSubstr("'wong-rece': is unknown; there are bevameter")));
  EXPECT_THAT(
      [&] { estimateSoil({.table = table.path(), .method = "iagnemma", .shear_modulus = "jointly"}, {}); },
      ThrowsMessage<InputError>(HasSubstr("'jointly': is unknown")));
  EXPECT_THROW(assessTable({.table = table.path(), .formula = "no-such"}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace talus::terramech
