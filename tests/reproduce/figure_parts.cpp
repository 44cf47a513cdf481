#include "figure_parts.hpp"

#include <array>
#include <cmath>

#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/io/soil_library.hpp>
#include <talus/terramech/strength/strength_lines.hpp>

namespace talus::reproduce {

using namespace cli;
using namespace terramech;

Soil middle(std::size_t soil_class) {
  return kThesisSoils[soil_class].middle();
}

WheelSample drive(const Soil& soil, double load, double slip) {
  const WheelForces f = equilibrium(soil, kThesisWheel, {.load_N = load, .slip = slip});
  return {load, f.torque_Nm, f.sinkage_m, slip};
}

Series line(const std::string& name) {
  return {.name = name, .x = {}, .y = {}};
}

std::vector<Series> lines(std::initializer_list<const char*> names) {
  std::vector<Series> all;
  for (const char* name : names) all.push_back(line(name));
  return all;
}

Series points(const std::string& name) {
  return {.name = name, .x = {}, .y = {}, .mark = Series::Mark::Points};
}

void put(Series& series, double x, double y) {
  series.x.push_back(x);
  series.y.push_back(y);
}

Series straight(const std::string& name, double offset, double slope, double most) {
  return {.name = name, .x = {0.0, most}, .y = {offset, offset + slope * most}};
}

FittedPoints fittedPoints(const ThesisRun& run, double modulus, const std::string& name) {
  FittedPoints f{points(name), {}};
  MohrCoulombLine through;
  for (const WheelSample& s : run.samples) {
    const StressPair p = linearOffset(kThesisWheel, s, modulus).pair();
    put(f.cloud, 1e-3 * p.normal_Pa, 1e-3 * p.shear_Pa);
    through.add(p);
  }
  f.fit = through.estimate();
  return f;
}

std::vector<SoilPrior> thesisPriors() {
  std::vector<SoilPrior> priors;
  for (const char* name : {"sand", "clay", "loam", "firm_soil"}) priors.push_back(soilPriors(name).front());
  return priors;
}

ModelSoil soilFrom(std::span<const WheelSample> samples, const std::vector<SoilPrior>& priors, double noise) {
  Telemetry table;
  table.source = "simulated";
  for (const char* name : {"load_N", "torque_Nm", "sinkage_m", "slip"}) table.numbers.push_back({name, {}});
  for (const WheelSample& s : samples) {
    const std::array row{s.load_N, s.torque_Nm, s.sinkage_m, s.slip};
    for (std::size_t k = 0; k < row.size(); ++k) table.numbers[k].values.push_back(row[k]);
    table.lines.push_back(table.lines.size() + 2);
  }
  RefinedModel model;
  model.wheel = kThesisWheel;
  return soilUnder(model, makeTrial(table, model), {.prior = priors, .noise = noise});
}

ThesisRun clayRun(std::uint64_t seed, double noise) {
  ThesisRuns runs(seed);
  for (;;) {
    ThesisRun run = runs.next({.noise = noise});
    if (run.soil_class == 1 && run.soil.cohesion_Pa > 6500.0) return run;
  }
}

double MeanAndStd::std() const {
  return std::sqrt(squares_ / count_ - mean() * mean());
}

}  // namespace talus::reproduce
