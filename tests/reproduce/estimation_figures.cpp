#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <thesis_runs.hpp>

#include <talus/common/common.hpp>
#include <talus/terramech/strength/strength_lines.hpp>

#include "figure_parts.hpp"

namespace talus::reproduce {
namespace {

using namespace cli;
using namespace terramech;

ThesisFigure straightStresses(std::uint64_t seed) {
  constexpr int kSoils = 100;
  Series truth = points("truth"), found = points("estimate");
  MeanAndStd off_c, off_phi;
  int greater = 0, smaller = 0;  // cohesion, friction angle
  ThesisRuns runs(seed);
  for (int count = 0; count < kSoils;) {
    const ThesisRun run = runs.next({.noise = 0.0});
    if (run.soil.name != "clay") continue;
    ++count;
    MohrCoulombLine through;
    for (const WheelSample& s : run.samples)
      through.add(iagnemmaPair(kThesisWheel, s, run.soil.shear_modulus_m));
    const ShearStrength fit = through.estimate();
    const double c = 1e-3 * (fit.cohesion_Pa - run.soil.cohesion_Pa),
                 phi = (fit.frictionAngle_rad() - run.soil.friction_angle_rad) / kDegree;
    off_c.add(c);
    off_phi.add(phi);
    greater += c > 0.0 ? 1 : 0;
    smaller += phi < 0.0 ? 1 : 0;
    put(truth, 1e-3 * run.soil.cohesion_Pa, run.soil.friction_angle_rad / kDegree);
    put(found, 1e-3 * fit.cohesion_Pa, fit.frictionAngle_rad() / kDegree);
  }
  return {
      "2.3",
      "Straight stresses on cohesive soil",
      "Iagnemma's method gives a greater cohesion and a smaller friction angle than is true",
      fmt::format("of {} clays, noise-free, K given, {} have a greater cohesion and {} a smaller friction "
                  "angle; off by {:.2f} +- {:.2f} kPa and "
                  "{:.1f} +- {:.1f} deg",
                  kSoils, greater, smaller, off_c.mean(), off_c.std(), off_phi.mean(), off_phi.std()),
      verdictOf(greater > 0.9 * kSoils && smaller > 0.9 * kSoils,
                greater > 0.9 * kSoils ? "in part: the cohesion is greater, the friction angle not smaller"
                                       : "not reproduced"),
      {{.title = "Clays of Table 2.1",
        .x = {.label = "c [kPa]", .low = 0.0},
        .y = {.label = "phi [deg]", .low = 0.0},
        .series = {truth, found}}}};
}

ThesisFigure coefficients(std::uint64_t seed) {
  const Soil soil = middle(2);
  const double t = std::tan(soil.friction_angle_rad);
  std::vector<Series> terms = lines({"M1 c tan(phi)", "M2 c", "M3 tan(phi)", "M4"});
  for (int k = 2; k <= 8; ++k) {
    const double slip = 0.1 * k;
    const auto m = linearOffset(kThesisWheel, drive(soil, 80.0, slip), soil.shear_modulus_m);
    put(terms[0], slip, 1e-3 * m.m1 * soil.cohesion_Pa * t);
    put(terms[1], slip, 1e-3 * soil.cohesion_Pa);
    put(terms[2], slip, 1e-3 * m.m3_Pa * t);
    put(terms[3], slip, 1e-3 * m.m4_Pa);
  }
  double worst = 0.0;
  ThesisRuns runs(seed);
  for (int k = 0; k < 500; ++k) {
    const ThesisRun run = runs.next({.noise = 0.0});
    for (const WheelSample& s : run.truth) {
      const double m1 = linearOffset(kThesisWheel, s, run.soil.shear_modulus_m).m1;
      worst = std::max(worst, std::abs(m1 * std::tan(run.soil.friction_angle_rad)));
    }
  }
  return {
      "2.5",
      "Size of the four terms of Eq. 2.9",
      "M1 c tan(phi) is less than 10 % of M2 c",
      fmt::format("the ratio, M1 tan(phi), is at most {:.3f} over 500 soils of Table 2.1, slip 0.2 to 0.8",
                  worst),
      verdictOf(worst < 0.1, "not reproduced"),
      {{.title = "Loam of Table 2.1, 80 N",
        .x = {.label = "slip [-]"},
        .y = {.label = "term [kPa]"},
        .series = terms}}};
}

ThesisFigure simplification(std::uint64_t seed) {
  Series cloud = points("distance of (tan phi, c) from the line");
  MeanAndStd in_tangent, in_cohesion;
  ThesisRuns runs(seed);
  for (int k = 0; k < 500; ++k) {
    const ThesisRun run = runs.next({.noise = 0.0});
    for (const WheelSample& s : run.truth) {
      const auto m = linearOffset(kThesisWheel, s, run.soil.shear_modulus_m);
      const double m3 = 1e-3 * m.m3_Pa;  // kPa
      const double miss =
          1e-3 * (m.m4_Pa - run.soil.cohesion_Pa) - m3 * std::tan(run.soil.friction_angle_rad);
      const double cohesion = std::abs(miss) / (1.0 + m3 * m3);
      if (k % 5 == 0) put(cloud, cohesion, cohesion * m3);
      in_cohesion.add(cohesion);
      in_tangent.add(cohesion * m3);
    }
  }
  const bool alike =
      std::abs(in_tangent.mean() - 0.033) < 0.002 && std::abs(in_tangent.std() - 0.021) < 0.002;
  return {"2.6",
          "Error of dropping M1 (Eq. 2.11)",
          "errors of mean 0.033 and standard deviation 0.021 in tan(phi), 0.002 and 0.002 kPa in c",
          fmt::format(
              "mean {:.3f} and standard deviation {:.3f} in tan(phi), {:.3f} and {:.3f} kPa in c; both are "
              "the foot of the perpendicular in (kPa, -), not an error of c",
              in_tangent.mean(), in_tangent.std(), in_cohesion.mean(), in_cohesion.std()),
          verdictOf(alike, "not reproduced", ", as a distance"),
          {{.title = "500 soils",
            .x = {.label = "distance in c [kPa]"},
            .y = {.label = "distance in tan(phi) [-]"},
            .series = {cloud}}}};
}

ThesisFigure representative(std::uint64_t seed) {
  const ThesisRun run = clayRun(seed, 0.0);
  const FittedPoints f = fittedPoints(run, run.soil.shear_modulus_m, "samples");
  const double t = std::tan(run.soil.friction_angle_rad);
  double apart = 0.0;  // of the lines over the samples, in parts of the true strength
  for (const double m3 : f.cloud.x) {
    const double truth = 1e-3 * run.soil.cohesion_Pa + m3 * t;
    apart = std::max(apart, std::abs(1e-3 * f.fit.cohesion_Pa + m3 * f.fit.tan_friction - truth) / truth);
  }
  return {
      "2.7",
      "An estimate on clay",
      "the fitted line is close to the true one on highly cohesive soil",
      fmt::format(
          "truth c = {:.2f} kPa, phi = {:.1f} deg; noise-free estimate {:.2f} kPa, {:.1f} deg, K given; over "
          "the samples the lines are at most {:.1f} % apart",
          1e-3 * run.soil.cohesion_Pa, run.soil.friction_angle_rad / kDegree, 1e-3 * f.fit.cohesion_Pa,
          f.fit.frictionAngle_rad() / kDegree, 100.0 * apart),
      verdictOf(apart < 0.05, "not reproduced", " without noise; see 2.9 with it"),
      {{.title = "Clay, ten samples",
        .x = {.label = "M3 [kPa]", .low = 0.0},
        .y = {.label = "M4 [kPa]", .low = 0.0},
        .series = {straight("truth", 1e-3 * run.soil.cohesion_Pa, t, 25.0),
                   straight("fit", 1e-3 * f.fit.cohesion_Pa, f.fit.tan_friction, 25.0), f.cloud}}}};
}

// What 2.9 claims of the linear-offset method: its errors over the numbers of samples.
std::string windowVerdict(const Series& c_kPa, const Series& phi_deg) {
  constexpr double kPrinted_kPa = 1.14, kPrinted_deg = 6.52;
  if (c_kPa.y.back() > c_kPa.y[1] || phi_deg.y.back() > phi_deg.y[1]) return "not reproduced";
  for (std::size_t at = 0; at < c_kPa.x.size(); ++at) {
    if (c_kPa.y[at] > kPrinted_kPa || phi_deg.y[at] > kPrinted_deg) continue;
    return at <= 1 ? "reproduced"
                   : fmt::format(
                         "in part: more samples improve both, but the printed pair takes {} samples, not ten",
                         c_kPa.x[at]);
  }
  return fmt::format("in part: more samples improve both, but {} do not reach the printed pair",
                     c_kPa.x.back());
}

ThesisFigure window(std::uint64_t seed) {
  constexpr int kSoils = 40;
  const std::vector<int> counts{5, 10, 20, 40, 60};
  std::vector<double> offset_c(counts.size()), offset_phi(counts.size()), ours_c(counts.size()),
      ours_phi(counts.size());
  ThesisRuns runs(seed);
  for (int k = 0; k < kSoils; ++k) {
    const ThesisRun run = runs.next({.noise = 0.05, .samples = counts.back()});
    MohrCoulombLine through;
    for (std::size_t at = 0, i = 0; i < run.samples.size(); ++i) {
      through.add(linearOffset(kThesisWheel, run.samples[i], run.soil.shear_modulus_m).pair());
      if (static_cast<int>(i) + 1 != counts[at]) continue;
      const ShearStrength fit = through.estimate();
      const Soil ours = soilFrom({run.samples.data(), i + 1}, thesisPriors(), 0.05).model.soil;
      offset_c[at] += std::pow(fit.cohesion_Pa - run.soil.cohesion_Pa, 2) / kSoils;
      offset_phi[at] += std::pow(fit.frictionAngle_rad() - run.soil.friction_angle_rad, 2) / kSoils;
      ours_c[at] += std::pow(ours.cohesion_Pa - run.soil.cohesion_Pa, 2) / kSoils;
      ours_phi[at] += std::pow(ours.friction_angle_rad - run.soil.friction_angle_rad, 2) / kSoils;
      ++at;
    }
  }
  std::vector<Series> c = lines({"linear-offset, K given", "wong-reece (ours), K inferred"});
  std::vector<Series> phi = c;
  for (std::size_t at = 0; at < counts.size(); ++at) {
    put(c[0], counts[at], 1e-3 * std::sqrt(offset_c[at]));
    put(c[1], counts[at], 1e-3 * std::sqrt(ours_c[at]));
    put(phi[0], counts[at], std::sqrt(offset_phi[at]) / kDegree);
    put(phi[1], counts[at], std::sqrt(ours_phi[at]) / kDegree);
  }
  return {"2.9",
          "Effect of more samples",
          "1.14 kPa and 6.52 deg with 10 samples at 5 % noise; more samples improve both",
          fmt::format("10 samples, {} soils: linear-offset {:.2f} kPa, {:.2f} deg; 60 samples {:.2f} kPa, "
                      "{:.2f} deg. Ours: {:.2f} kPa, {:.2f} deg and {:.2f} kPa, {:.2f} deg",
                      kSoils, c[0].y[1], phi[0].y[1], c[0].y[4], phi[0].y[4], c[1].y[1], phi[1].y[1],
                      c[1].y[4], phi[1].y[4]),
          windowVerdict(c[0], phi[0]),
          {{.title = "rms error of cohesion",
            .x = {.label = "samples"},
            .y = {.label = "[kPa]", .low = 0.0},
            .series = c},
           {.title = "rms error of friction angle",
            .x = {.label = "samples"},
            .y = {.label = "[deg]", .low = 0.0},
            .series = phi}}};
}

}  // namespace

std::vector<ThesisFigure> estimationFigures(std::uint64_t seed) {
  std::vector<ThesisFigure> figures;
  for (const auto make : {straightStresses, coefficients, simplification, representative, window})
    figures.push_back(make(seed));
  return figures;
}

}  // namespace talus::reproduce
