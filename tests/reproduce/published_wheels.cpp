#include <array>
#include <numbers>

#include <fmt/format.h>

#include <talus/common/common.hpp>
#include <talus/terramech/calibration.hpp>
#include <talus/terramech/calibration/trace/formula_trace.hpp>
#include <talus/terramech/calibration/trace/left_out.hpp>
#include <talus/terramech/calibration/trace/residual_trace.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/mobility/slope_equilibrium.hpp>
#include <talus/terramech/terramech_io.hpp>

#include "published.hpp"

namespace talus::reproduce {
namespace {

using namespace terramech;

// NASA Glenn's MGRU3 (88 kg, four wheels of 0.25 by 0.20 m with 24 lugs of 25 mm). Values missing in the source are
// ours.
Rover mgru3() {
  Rover rover{.name = "mgru3",
              .mass_kg = 88.0,
              .gravity_m_s2 = 9.81,
              .wheel_count = 4,
              .wheelbase_m = 0.9,
              .track_m = 0.9,
              .clearance_m = 0.25,
              .max_torque_Nm = 200.0};
  rover.wheel = {.radius_m = 0.25,
                 .width_m = 0.2,
                 .grouser_height_m = 0.025,
                 .grouser_count = 24,
                 .lug_thrust = kLugThrust};
  return rover;
}

struct SlipOnSlope {
  double slope_deg, slip;
};

// The slips of `measured` and those of Talus on the recommended lunar soil, which GRC-1 simulates.
void compareSlips(PublishedCase& made, const std::string& name, const std::vector<SlipOnSlope>& measured,
                  const Rover& rover) {
  const SlopeEquilibrium ours(loadSoilPrior("lunar_nominal").mean, rover);
  cli::Series points{.name = name, .mark = cli::Series::Mark::Points}, line{.name = "Talus, " + name};
  for (const SlipOnSlope& at : measured) {
    const SlopeState state = ours.at({std::tan(at.slope_deg * kDegree), 0.0});
    made.lines.push_back({fmt::format("{}, {:g} deg, slip [-]", name, at.slope_deg), at.slip,
                          state.holds() ? state.slip : std::numeric_limits<double>::quiet_NaN(), false});
    points.x.push_back(at.slope_deg), points.y.push_back(at.slip);
  }
  for (double deg = 0.0; deg <= 30.0; deg += 0.5) {
    const SlopeState state = ours.at({std::tan(deg * kDegree), 0.0});
    if (state.holds()) line.x.push_back(deg), line.y.push_back(state.slip);
  }
  made.plots.front().series.push_back(points);
  if (name != "2021") made.plots.front().series.push_back(line);  // the rover of 2022
}

PublishedCase tiltBed() {
  PublishedCase made{.name = "mgru3",
                     .source = "slope_slip (digitised from a secondary source)",
                     .remark =
                         "tilt bed of loose GRC-1; no number is fitted, the soil is lunar_nominal "
                         "(wong_asnani_2008). The two "
                         "campaigns differ by 0.03 to 0.08; without a slip of ours the wheels cannot pull"};
  made.plots = {{.title = "Slip on slopes", .x = {"slope [deg]"}, .y = {"slip [-]"}, .series = {}}};
  compareSlips(made, "2022", {{5.6, 0.051}, {10.0, 0.104}, {15.3, 0.355}, {20.0, 0.738}, {25.2, 0.838}},
               mgru3());
  compareSlips(made, "2021", {{5.24, 0.052}, {14.96, 0.434}, {25.1, 0.885}}, mgru3());
  Rover dem = mgru3();
  dem.mass_kg = 70.0;
  dem.wheel.radius_m = 0.225;
  dem.wheel.grouser_height_m = 0.03;
  compareSlips(made, "discrete elements, 17.5 kg a wheel",
               {{2.5, 0.06}, {5.0, 0.105}, {10.0, 0.21}, {15.0, 0.415}, {20.0, 0.62}, {25.0, 0.72}}, dem);
  return made;
}

PublishedCase singleWheel() {
  PublishedCase made{
      .name = "trec",
      .source = "slope_slip (arXiv 2405.11001, figure 4)",
      .remark =
          "drawbar pull over load of one such wheel in GRC-3 at a held slip; the soil is lunar_nominal"};
  constexpr std::array<SlipOnSlope, 6> kPoints{
      {{13.82, 0.098}, {20.12, 0.2003}, {22.30, 0.3001}, {24.90, 0.4016}, {24.38, 0.5013}, {25.03, 0.701}}};
  Rover rover = mgru3();
  rover.mass_kg = 4.0 * 171.7 / rover.gravity_m_s2;
  const SlopeEquilibrium ours(loadSoilPrior("lunar_nominal").mean, rover);
  for (const SlipOnSlope& at : kPoints) {
    const double pull = ours.evenWheel(at.slip, 0.0).drawbar_pull_over_load;
    made.lines.push_back(
        {fmt::format("slip {:.2f}, DP/W [-]", at.slip), std::tan(at.slope_deg * kDegree), pull, false});
  }
  return made;
}

// Error on rows that tracing did not see, beside a regression of the columns.
PublishedCase heldOut(const std::string& name, const std::string& file, const std::string& request,
                      const std::string& source, const ProgressMonitor& watch) {
  PublishedCase made{
      .name = name,
      .source = source,
      .remark = "rms error on the rows held out (" + request +
                "), from the default soil; theirs: ridge regression on the columns and their squares "
                "(golub_1979) of the same rows"};
  const std::string path = sharedFile("TALUS_MEASURED_DATA", file, made);
  if (path.empty()) return made;
  const TraceInput input = traceInput(readTraceTable(path), baseModel("", ""), {});
  constexpr std::array kNames{"DP/W", "z/r", "T/(rW)", "F/W"};
  for (const LeftOut& left : leftOut(input.rows.trial, request, path)) {
    if (watch.stopped()) return made;
    const LeftOutErrors errors = traceWithout(input.rows.model, input.rows.trial, left, input.options, watch);
    for (std::size_t k = 0; k < kNames.size() && k < errors.refined.size(); ++k)
      if (std::isfinite(errors.refined[k]))
        made.lines.push_back({fmt::format("{}, {} [-] (without effects {:.3f}, scatter {:.3f})", errors.what,
                                          kNames[k], errors.base[k], errors.floor[k]),
                              errors.regression[k], errors.refined[k], false});
  }
  return made;
}

// Pull and side force at a slip that tracing did not see, over the slip angle.
PublishedCase slipAngles(const ProgressMonitor& watch) {
  PublishedCase made{
      .name = "cmu-angles",
      .source = "cmu_testbed (Pavlov and Johnson)",
      .remark =
          "means of the rows at a slip of 0.7 to 0.8, which are held out of the trace, from the "
          "default soil; the scatter of one run is 0.03 to 0.05 in DP/W"};
  const std::string path = sharedFile("TALUS_MEASURED_DATA", "cmu_testbed/runs.csv", made);
  if (path.empty()) return made;
  const TraceInput input = traceInput(readTraceTable(path), baseModel("", ""), {});
  const auto left = leftOut(input.rows.trial, "slip=0.7..0.8", path);
  const LeftOutErrors errors =
      traceWithout(input.rows.model, input.rows.trial, left.front(), input.options, watch);
  for (const auto& [channel, name] : {std::pair{Channel::DrawbarPull, "DP/W"}, {Channel::SideForce, "F/W"}})
    for (const double deg : {0.0, 15.0, 45.0, 75.0}) {
      double measured = 0.0, ours = 0.0, rows = 0.0;
      for (int i = 0; i < errors.trial.rows(); ++i) {
        const double at = errors.trial.measured(i, static_cast<int>(channel)),
                     angle_rad = errors.trial.states[static_cast<std::size_t>(i)].slip_angle_rad;
        if (!std::isfinite(at) || std::abs(std::abs(angle_rad) / kDegree - deg) > 4.0) continue;
        const double side = channel == Channel::SideForce && angle_rad < 0.0 ? -1.0 : 1.0;
        measured += side * at, ours += side * errors.predicted(i, static_cast<int>(channel)), rows += 1.0;
      }
      if (rows > 0.0)
        made.lines.push_back(
            {fmt::format("{:.0f} deg, {} [-], {} rows", deg, name, rows), measured / rows, ours / rows});
    }
  return made;
}

// Charge of drives over a hill: what a formula of distance and height lacks, and its error on drives left out.
PublishedCase cuadriga() {
  PublishedCase made{
      .name = "cuadriga",
      .source = "camis_2021 (drives of 2020-11-03)",
      .remark =
          "error of the charge of a drive from the others, over its mean; theirs: all 16 drives by "
          "hand, ours: the 10 of the table by `talus trace --formula`"};
  const std::string path = sharedFile("TALUS_MEASURED_DATA", "cuadriga_hill/drives.csv", made);
  if (path.empty()) return made;
  const FormulaTrace trace = traceFormula(readTelemetry(path), "charge_As = a*distance_m + b*height_m");
  made.lines.push_back({"distance and height [-]", 0.084, trace.base_held / trace.mean});
  made.lines.push_back({"with " + (trace.effects.empty() ? "nothing" : trace.effects.front().column) + " [-]",
                        0.039, trace.refined_held / trace.mean});
  return made;
}

}  // namespace

std::vector<PublishedCase> publishedWheels(const std::string& name, const ProgressMonitor& watch) {
  std::vector<PublishedCase> cases;
  const auto add = [&](const char* of, auto make) {
    if ((name.empty() || name == of) && !watch.stopped()) cases.push_back(make());
  };
  add("mgru3", [&] { return tiltBed(); });
  add("trec", [&] { return singleWheel(); });
  add("cmu", [&] {
    return heldOut("cmu", "cmu_testbed/runs.csv", "slip=0.4..1", "cmu_testbed (Pavlov and Johnson)", watch);
  });
  add("cmu-angles", [&] { return slipAngles(watch); });
  add("digitised", [&] {
    return heldOut("digitised", "single_wheel_digitised/points.csv", "source", "single_wheel_digitised",
                   watch);
  });
  add("cuadriga", [&] { return cuadriga(); });
  const auto say = [&](const char* of, const char* source, const char* why) {
    add(of, [&] { return PublishedCase{.name = of, .source = source, .remark = why}; });
  };
  say("ex1", "arXiv 2601.04547",
      "not rebuilt: the unit of v in s = (0.00522 v + 0.00105) a^2 + 0.0265 v + 0.0256 is "
      "not stated, and silica no. 5 has no published pressure-sinkage");
  say("scm", "Chrono SCM", "`tests/terramech/scm_loop.py DATA talus`: Chrono is not a part of this command");
  say("gis", "GRASS r.walk, scikit-image", "`tests/benchmark/compare_gis.py`: needs both programs");
  say("ompl", "OMPL 1.5.2", "`talus bench`: cost under one function, cold, with the bound");
  return cases;
}

}  // namespace talus::reproduce
