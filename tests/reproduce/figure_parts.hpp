#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <vector>

#include <thesis_runs.hpp>

#include <talus/terramech/calibration/tables/method_estimates.hpp>
#include <talus/terramech/strength/strength_lines.hpp>

#include "thesis_figures.hpp"

/// What the figures of the thesis are drawn with.
namespace talus::reproduce {

/// A soil in the middle of a class of Table 2.1; the thesis does not state which soil it used.
terramech::Soil middle(std::size_t soil_class);

/// What a wheel of the thesis reads on a soil at a load [N] and slip.
terramech::WheelSample drive(const terramech::Soil& soil, double load_N, double slip);

/// An empty line, several, an empty cloud of points; and a point more.
cli::Series line(const std::string& name);
std::vector<cli::Series> lines(std::initializer_list<const char*> names);
cli::Series points(const std::string& name);
void put(cli::Series& series, double x, double y);

/// Straight line y = offset + slope x over [0, most].
cli::Series straight(const std::string& name, double offset, double slope, double most);

/// Of values added one at a time.
class MeanAndStd {
 public:
  void add(double value) { sum_ += value, squares_ += value * value, count_ += 1.0; }
  double mean() const { return sum_ / count_; }
  double std() const;

 private:
  double sum_ = 0.0, squares_ = 0.0, count_ = 0.0;
};

/// The points (M3, M4) of a run at a shear modulus [m] and the line fitted to them.
struct FittedPoints {
  cli::Series cloud;
  terramech::ShearStrength fit;
};
FittedPoints fittedPoints(const terramech::ThesisRun& run, double shear_modulus_m, const std::string& name);

/// The classes of Table 2.1 as priors: mean and standard deviation of their ranges.
std::vector<terramech::SoilPrior> thesisPriors();

/// The soil from readings of the wheel of the thesis, with the given relative error [-] of each reading.
terramech::ModelSoil soilFrom(std::span<const terramech::WheelSample> samples,
                              const std::vector<terramech::SoilPrior>& priors, double noise);

/// A clay run with the most cohesion that the seed gives.
terramech::ThesisRun clayRun(std::uint64_t seed, double noise);

}  // namespace talus::reproduce
