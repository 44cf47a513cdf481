#include "goal_study.hpp"

#include <cmath>
#include <ctime>
#include <map>

#include <Eigen/LU>
#include <fmt/format.h>
#include <thesis_runs.hpp>

#include <talus/common/common.hpp>
#include <talus/terramech/estimate/drawbar_pull.hpp>
#include <talus/terramech/estimate/model_pull.hpp>
#include <talus/terramech/strength/shear_modulus.hpp>
#include <talus/terramech/strength/strength_lines.hpp>
#include <talus/terramech/terramech_io.hpp>

#include "figure_parts.hpp"

namespace talus::reproduce {
namespace {

using namespace terramech;

// Root mean square, one error at a time.
class Rms {
 public:
  void add(double error) { squares_ += error * error, ++count_; }
  double get() const { return std::sqrt(squares_ / count_); }

 private:
  double squares_ = 0.0;
  int count_ = 0;
};

// Errors of cohesion and friction angle together.
struct StrengthErrors {
  Rms cohesion, friction;

  void add(double cohesion_Pa, double friction_rad, const Soil& truth) {
    cohesion.add(1e-3 * (cohesion_Pa - truth.cohesion_Pa));
    friction.add((friction_rad - truth.friction_angle_rad) / kDegree);
  }
  std::string text() const { return fmt::format("{:.2f} kPa, {:.2f} deg", cohesion.get(), friction.get()); }
};

// Shares of truths inside the 95 % regions.
struct Coverage {
  int cohesion = 0, friction = 0, ellipse = 0, count = 0;

  void add(const ModelSoil& p, const Soil& t) {
    const Eigen::Vector2d off(p.model.soil.cohesion_Pa - t.cohesion_Pa,
                              std::tan(p.model.soil.friction_angle_rad) - std::tan(t.friction_angle_rad));
    const Eigen::Matrix2d covariance = p.strengthCovariance();
    cohesion += std::abs(off[0]) < 1.96 * std::sqrt(covariance(0, 0));
    friction += std::abs(off[1]) < 1.96 * std::sqrt(covariance(1, 1));
    ellipse += off.dot(covariance.inverse() * off) < 5.991;
    ++count;
  }
  std::string text() const {
    const auto share = [&](int k) { return 100.0 * k / count; };
    return fmt::format("c {:.1f} %, phi {:.1f} %, (c, tan phi) ellipse {:.1f} %", share(cohesion),
                       share(friction), share(ellipse));
  }
};

// Of the processor, so that other work on the machine does not count.
double seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

// The rms error that the estimates expect of themselves.
struct Expected {
  double cohesion = 0.0, friction = 0.0;
  int count = 0;

  void add(const ModelSoil& p) {
    cohesion += std::pow(1e-3 * p.std("cohesion_Pa"), 2);
    friction += std::pow(p.std("friction_angle_rad") / kDegree, 2);
    ++count;
  }
  std::string text() const {
    return fmt::format("{:.2f} kPa, {:.2f} deg", std::sqrt(cohesion / count), std::sqrt(friction / count));
  }
};

// Everything that the 5 % runs are put through.
struct StrengthStudy {
  StrengthErrors prior_mean, iagnemma, linear_offset, linear_offset_joint, mixture, known;
  Coverage coverage, known_coverage;
  Expected expected, known_expected;

  void add(const ThesisRun& run, const std::vector<SoilPrior>& classes) {
    prior_mean.add(2500.0, 28.125 * kDegree, run.soil);
    MohrCoulombLine line, offset;
    ShearModulusGrid ladder(kThesisWheel);
    for (const WheelSample& s : run.samples) {
      line.add(iagnemmaPair(kThesisWheel, s, run.soil.shear_modulus_m));
      offset.add(linearOffset(kThesisWheel, s, run.soil.shear_modulus_m).pair());
      ladder.add(s);
    }
    const auto take = [&](StrengthErrors& errors, const ShearStrength& fit) {
      errors.add(fit.cohesion_Pa, fit.frictionAngle_rad(), run.soil);
    };
    take(iagnemma, line.estimate());
    take(linear_offset, offset.estimate());
    take(linear_offset_joint, ladder.strength());
    const ModelSoil p = soilFrom(run.samples, classes, 0.05);
    mixture.add(p.model.soil.cohesion_Pa, p.model.soil.friction_angle_rad, run.soil);
    coverage.add(p, run.soil);
    expected.add(p);
    const ModelSoil q = soilFrom(run.samples, {classes[static_cast<std::size_t>(run.soil_class)]}, 0.05);
    known.add(q.model.soil.cohesion_Pa, q.model.soil.friction_angle_rad, run.soil);
    known_coverage.add(q, run.soil);
    known_expected.add(q);
  }

  void report(std::vector<GoalLine>& lines) const {
    lines.push_back({"c, phi at 5 %: always the prior mean", prior_mean.text(), ""});
    lines.push_back({"c, phi at 5 %: Iagnemma, K given", iagnemma.text(), ""});
    lines.push_back({"c, phi at 5 %: linear-offset (2.16), K given", linear_offset.text(), ""});
    lines.push_back({"c, phi at 5 %: linear-offset, K found jointly", linear_offset_joint.text(), ""});
    lines.push_back(
        {"c, phi at 5 %: wong-reece, four classes, K not given", mixture.text(), "1.4 kPa, 3.7 deg"});
    lines.push_back({"the same, expected from its own standard deviations", expected.text(), ""});
    lines.push_back({"c, phi at 5 %: wong-reece, class known", known.text(), "0.40 kPa, 1.6 deg"});
    lines.push_back({"the same, expected from its own standard deviations", known_expected.text(), ""});
    lines.push_back({"95 % regions that hold the truth, four classes", coverage.text(), "93 to 97 %"});
    lines.push_back({"95 % regions that hold the truth, class known", known_coverage.text(), "93 to 97 %"});
  }
};

// Errors of DP/W at one noise level.
struct PullStudy {
  Rms plane, small_angle, triangular, ours, posterior;

  void add(const ThesisRun& run, const ThesisRunOptions& made, const RefinedModel* found) {
    for (std::size_t k = 0; k < run.samples.size(); ++k) {
      const WheelSample& s = run.samples[k];
      const double truth = run.pull_over_load[k];
      plane.add(kThesisPlane.at(made.wheel, s) - truth);
      small_angle.add(pullAtSmallAngle(made.wheel, s) - truth);
      triangular.add(pullOfTriangularStress(made.wheel, s) - truth);
      ours.add(pullOverLoad(made.wheel, s).value - truth);
      if (found == nullptr) continue;
      const WheelState state{.wheel = made.wheel, .load_N = s.load_N, .slip = s.slip};
      posterior.add(pullOf(*found, state).pull_over_load.value - truth);
    }
  }
};

void pullLines(const GoalOptions& options, const std::vector<SoilPrior>& classes,
               const ProgressMonitor& watch, std::vector<GoalLine>& lines) {
  const std::vector<std::pair<double, const char*>> levels{{0.0, "0.002"}, {0.02, "0.008"}, {0.05, "0.016"}};
  const int soils = std::max(1, options.soils / 4);
  for (const auto& [noise, goal] : levels) {
    ThesisRuns runs(options.seed + 1);
    PullStudy study;
    const ThesisRunOptions made{.noise = noise};
    for (int k = 0; k < soils && !watch.stopped(); ++k) {
      const ThesisRun run = runs.next(made);
      const RefinedModel found = groundTruthOf(soilFrom(run.samples, classes, std::max(noise, 1e-3)).model);
      study.add(run, made, &found);
    }
    const std::string at = fmt::format("DP/W at {:.0f} % ({} soils)", 100.0 * noise, soils);
    lines.push_back({at + ": Eq. 3.21", fmt::format("{:.4f}", study.plane.get()), ""});
    lines.push_back({at + ": Eqs. 3.6, 3.15", fmt::format("{:.4f}", study.small_angle.get()), ""});
    lines.push_back({at + ": Eq. 3.12", fmt::format("{:.4f}", study.triangular.get()), ""});
    lines.push_back({at + ": single force (ours), T, z, i alone", fmt::format("{:.4f}", study.ours.get()),
                     noise == 0.0 ? "0.006" : ""});
    lines.push_back(
        {at + ": soil of the ten samples (ours)", fmt::format("{:.4f}", study.posterior.get()), goal});
  }
}

void otherWheels(const GoalOptions& options, std::vector<GoalLine>& lines) {
  const std::vector<Wheel> wheels{{.radius_m = 0.065, .width_m = 0.08},
                                  {.radius_m = 0.15, .width_m = 0.165},
                                  {.radius_m = 0.25, .width_m = 0.2}};
  for (const Wheel& wheel : wheels) {
    ThesisRuns runs(options.seed + 2);
    PullStudy study;
    const ThesisRunOptions made{
        .noise = 0.0, .samples = 10, .wheel = wheel, .load_scale = wheel.radius_m * wheel.width_m / 0.01};
    for (int k = 0; k < options.soils / 2; ++k) study.add(runs.next(made), made, nullptr);
    lines.push_back({fmt::format("DP/W at 0 %, wheel r = {} m, b = {} m: single force (ours); Eq. 3.21",
                                 wheel.radius_m, wheel.width_m),
                     fmt::format("{:.4f}; {:.4f}", study.ours.get(), study.plane.get()), "0.006"});
  }
}

// Slope and offset on T/(rW) that the residual of our estimator leaves, from all rows but one.
double leftOut(const std::vector<std::pair<double, double>>& rows, std::size_t out) {
  MohrCoulombLine line;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (k != out) line.add({.normal_Pa = rows[k].first, .shear_Pa = rows[k].second});
  }
  const ShearStrength fit = line.estimate();
  return fit.cohesion_Pa + fit.tan_friction * rows[out].first;
}

void measuredLines(const GoalOptions& options, std::vector<GoalLine>& lines) {
  if (options.measured.empty()) return;
  const Telemetry table = readTelemetry(
      options.measured, {.required = {"load_N", "torque_Nm", "sinkage_m", "slip", "drawbar_pull_N"}});
  const auto* source = table.findWords("source");
  std::map<std::string, std::vector<std::size_t>> sets;
  for (std::size_t k = 0; k < table.size(); ++k)
    sets[source == nullptr ? "all rows" : (*source)[k]].push_back(k);
  for (const auto& [name, rows] : sets) {
    Rms plane, ours, corrected;
    std::vector<std::pair<double, double>> residuals;
    for (const std::size_t k : rows) {
      const Wheel wheel{.radius_m = table.at("wheel_radius_m")[k], .width_m = table.at("wheel_width_m")[k]};
      const WheelSample s{table.at("load_N")[k], table.at("torque_Nm")[k], table.at("sinkage_m")[k],
                          table.at("slip")[k]};
      const double truth = table.at("drawbar_pull_N")[k] / s.load_N;
      plane.add(kThesisPlane.at(wheel, s) - truth);
      ours.add(pullOverLoad(wheel, s).value - truth);
      residuals.emplace_back(torqueOverLoadRadius(wheel, s), truth - pullOverLoad(wheel, s).value);
    }
    for (std::size_t k = 0; k < residuals.size(); ++k)
      corrected.add(residuals[k].second - leftOut(residuals, k));
    const std::string of = fmt::format("measured DP/W, {} ({} rows)", name, rows.size());
    lines.push_back({of + ": Eq. 3.21", fmt::format("{:.4f}", plane.get()), ""});
    lines.push_back({of + ": single force (ours), nothing fitted to it", fmt::format("{:.4f}", ours.get()),
                     name.starts_with("ding") ? "0.020" : ""});
    lines.push_back({of + ": with a line in T/(rW), leave one out", fmt::format("{:.4f}", corrected.get()),
                     name.starts_with("ding") ? "0.015" : ""});
  }
}

void timeLines(const GoalOptions& options, const std::vector<SoilPrior>& classes,
               std::vector<GoalLine>& lines) {
  ThesisRuns runs(options.seed + 3);
  const ThesisRun run = runs.next({.noise = 0.05, .samples = 100});
  double start = seconds();
  MohrCoulombLine line;
  double sum = 0.0;
  for (int pass = 0; pass < 20; ++pass) {
    for (const WheelSample& s : run.samples) {
      line.add(linearOffset(kThesisWheel, s, 0.02).pair());
      if (line.samples() > 2) sum += line.estimate().cohesion_Pa;
    }
  }
  const double linear = (seconds() - start) / 2000.0;
  start = seconds();
  sum += soilFrom({run.samples.data(), 10}, classes, 0.05).misfit;
  const double full = seconds() - start;
  lines.push_back({"processor time a sample: linear-offset, recursive",
                   fmt::format("{:.2f} us{}", 1e6 * linear, std::isfinite(sum) ? "" : "!"), "10 us"});
  lines.push_back(
      {"processor time of ten samples: wong-reece, four classes", fmt::format("{:.0f} ms", 1e3 * full), ""});
}

}  // namespace

std::vector<GoalLine> measureGoals(const GoalOptions& options, const ProgressMonitor& watch) {
  const std::vector<SoilPrior> classes = thesisPriors();
  std::vector<GoalLine> lines;
  ThesisRuns runs(options.seed);
  StrengthStudy study;
  for (int k = 0; k < options.soils; ++k) {
    if (watch.stopped()) return lines;
    watch.report(0.7 * k / options.soils);
    study.add(runs.next({.noise = 0.05}), classes);
  }
  study.report(lines);
  pullLines(options, classes, watch, lines);
  otherWheels(options, lines);
  measuredLines(options, lines);
  timeLines(options, classes, lines);
  watch.report(1.0);
  return lines;
}

}  // namespace talus::reproduce
