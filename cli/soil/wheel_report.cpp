#include <stdexcept>

#include <fmt/format.h>

#include <talus/cli/draw/html_report.hpp>
#include <talus/cli/soil/wheel_report.hpp>
#include <talus/common/constants.hpp>
#include <talus/terramech/contact/wong_reece.hpp>

namespace talus::cli {
namespace {

using terramech::WheelForces;

terramech::WheelOperation operationOf(const WheelOperatingPoint& work, double slip) {
  return {.load_N = work.load_N,
          .slip = slip,
          .slip_angle_rad = work.slip_angle_rad,
          .gravity_m_s2 = work.rover.gravity_m_s2};
}

Plot stressPlot(const WheelOperatingPoint& work) {
  Series normal{.name = "normal", .x = {}, .y = {}}, shear{.name = "shear", .x = {}, .y = {}};
  for (const auto& s :
       terramech::stressDistribution(work.soil, work.rover.wheel, operationOf(work, work.slip), 301)) {
    const double degrees = s.angle_rad / kDegree;
    normal.x.push_back(degrees);
    shear.x.push_back(degrees);
    normal.y.push_back(1e-3 * s.normal_Pa);
    shear.y.push_back(1e-3 * s.shear_Pa);
  }
  return {"Stress along the rim",
          {.label = "angle from the vertical, forward [deg]"},
          {.label = "stress [kPa]"},
          {normal, shear}};
}

/// A quantity over slip from -1 (braked) to 1; interrupted where the soil cannot carry the wheel.
template <class Quantity>
Plot overSlip(const WheelOperatingPoint& work, const std::string& title, const Quantity& quantity) {
  Plot plot{title, {.label = "slip [-], negative: braked"}, {.label = title + " [-]"}, {}};
  std::vector<terramech::Soil> soils{work.soil};
  soils.insert(soils.end(), work.others.begin(), work.others.end());
  for (const terramech::Soil& soil : soils) {
    Series curve{.name = work.others.empty() ? "" : soil.name, .x = {}, .y = {}};
    for (int k = -100; k <= 100; ++k) {
      const double slip = 0.01 * k;
      curve.x.push_back(slip);
      try {
        curve.y.push_back(quantity(terramech::equilibrium(soil, work.rover.wheel, operationOf(work, slip))));
      } catch (const std::domain_error&) {
        curve.y.push_back(std::numeric_limits<double>::quiet_NaN());
      }
    }
    plot.series.push_back(std::move(curve));
  }
  return plot;
}

std::vector<std::vector<std::string>> forceRows(const WheelOperatingPoint& work) {
  const WheelForces f = terramech::equilibrium(work.soil, work.rover.wheel, operationOf(work, work.slip));
  const double r = work.rover.wheel.radius_m;
  return {{"sinkage", fmt::format("{:.3f}", 1e3 * f.sinkage_m), "mm", fmt::format("{:.3f}", f.sinkage_m / r)},
          {"entry angle", fmt::format("{:.2f}", f.entry_angle_rad / kDegree), "deg", ""},
          {"torque", fmt::format("{:.3f}", f.torque_Nm), "Nm",
           fmt::format("{:.3f}", f.torque_Nm / (r * work.load_N))},
          {"drawbar pull", fmt::format("{:.3f}", f.drawbar_pull_N), "N",
           fmt::format("{:.3f}", f.drawbar_pull_N / work.load_N)},
          {"side force", fmt::format("{:.3f}", f.side_force_N), "N",
           fmt::format("{:.3f}", f.side_force_N / work.load_N)}};
}

}  // namespace

std::string wheelReport(const WheelOperatingPoint& work) {
  const double r = work.rover.wheel.radius_m, load_N = work.load_N;
  HtmlReport report{fmt::format("Wheel of {} on {}", work.rover.name, work.soil.name)};
  report.paragraph(
      fmt::format("Load {:.4g} N, slip {:.3g}, slip angle {:.3g} deg; radius {:.4g} m, width {:.4g} m. "
                  "Wong-Reece equilibrium (thesis C.2 to C.10).",
                  load_N, work.slip, work.slip_angle_rad / kDegree, r, work.rover.wheel.width_m));
  report.table({"", "value", "unit", "z/r, T/(rW), DP/W, F/W"}, forceRows(work));
  report.charts({stressPlot(work),
                 overSlip(work, "DP/W", [&](const WheelForces& f) { return f.drawbar_pull_N / load_N; }),
                 overSlip(work, "T/(rW)", [&](const WheelForces& f) { return f.torque_Nm / (r * load_N); }),
                 overSlip(work, "z/r", [&](const WheelForces& f) { return f.sinkage_m / r; })});
  return report.html();
}

}  // namespace talus::cli
