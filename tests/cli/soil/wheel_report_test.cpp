#include <stdexcept>

#include <fmt/format.h>
#include <refused.hpp>

#include <talus/cli/soil/wheel_report.hpp>
#include <talus/terramech/contact/wong_reece.hpp>
#include <talus/terramech/io/soil_library.hpp>

namespace talus::cli {
namespace wheel_report_test {

using testing::HasSubstr;
using testing::Not;

WheelOperatingPoint work() {
  return {terramech::loadSoil("sandy_loam"), terramech::loadRover("fido"), 80.0, 0.3};
}

// Property: the page lists the equilibrium forces with units and divided by r, rW and W (radius r, load W).
TEST(WheelReport, PageShowsTheEquilibriumForces) {
  const WheelOperatingPoint at = work();
  const double r = at.rover.wheel.radius_m;
  const auto f = terramech::equilibrium(at.soil, at.rover.wheel, {.load_N = 80.0, .slip = 0.3});
  const std::string page = wheelReport(at);
  const auto row = [](const std::string& name, double value, const std::string& unit, double ratio) {
    return fmt::format(
        "<td>{}</td><td class=\"number\">{:.3f}</td><td>{}</td><td class=\"number\">{:.3f}</td>", name, value,
        unit, ratio);
  };
  EXPECT_THAT(page, HasSubstr(row("sinkage", 1e3 * f.sinkage_m, "mm", f.sinkage_m / r)));
  EXPECT_THAT(page, HasSubstr(row("torque", f.torque_Nm, "Nm", f.torque_Nm / (r * 80.0))));
  EXPECT_THAT(page, HasSubstr(row("drawbar pull", f.drawbar_pull_N, "N", f.drawbar_pull_N / 80.0)));
  EXPECT_THAT(page, HasSubstr("data:image/svg+xml;base64,"));
}

// Property: each compared soil has its own curve.
TEST(WheelReport, ComparedSoilsHaveTheirOwnCurves) {
  WheelOperatingPoint at = work();
  const std::size_t alone = wheelReport(at).size();
  at.others = {terramech::loadSoil("dry_sand"), terramech::loadSoil("clay")};
  EXPECT_GT(wheelReport(at).size(), alone + 3U * 2U * 1000U);
}

TEST(WheelReport, SoilNamesAreNeverMarkup) {
  WheelOperatingPoint at = work();
  at.soil.name = "<b>sand</b>";
  EXPECT_THAT(wheelReport(at), Not(HasSubstr("<b>sand")));
}

TEST(WheelReport, LoadBeyondTheAxleIsRejected) {
  WheelOperatingPoint at = work();
  at.load_N = 1e9;
  EXPECT_REFUSED(wheelReport(at), std::domain_error,
                 "the wheel sinks to its axle before the soil carries 1000000000.000000 N");
}

}  // namespace wheel_report_test
}  // namespace talus::cli
