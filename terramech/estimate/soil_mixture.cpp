#include <algorithm>
#include <cmath>

#include <talus/common/common.hpp>
#include <talus/terramech/estimate/soil_estimation.hpp>
#include <talus/terramech/numerics/range.hpp>

namespace talus::terramech {
namespace {

// Row of thesis Table 2.1: parameters that differ between the classes.
struct TableRow {
  const char* name;
  Interval cohesion_kPa;
  Interval friction_deg;
  Interval modulus_MN;
};

SoilClass classOf(const TableRow& row) {
  SoilClass soil{.name = row.name, .probability = 0.25};
  soil.parameters[kCohesion] = Marginal::uniform(1e3 * row.cohesion_kPa.low, 1e3 * row.cohesion_kPa.high);
  soil.parameters[kFriction] =
      Marginal::uniform(kDegree * row.friction_deg.low, kDegree * row.friction_deg.high);
  soil.parameters[kExponent] = Marginal::uniform(0.5, 1.2);
  soil.parameters[kModulus] = Marginal::uniform(1e6 * row.modulus_MN.low, 1e6 * row.modulus_MN.high);
  soil.parameters[kShear] = Marginal::uniform(0.01, 0.03);
  return soil;
}

SoilClass anySoil(double probability) {
  SoilClass soil{.name = "other", .probability = probability};
  soil.parameters[kCohesion] = Marginal::uniform(0.0, 2e4);
  soil.parameters[kFriction] = Marginal::uniform(15.0 * kDegree, 50.0 * kDegree);
  soil.parameters[kExponent] = Marginal::uniform(0.3, 1.8);
  soil.parameters[kModulus] = Marginal::logUniform(1e4, 1e8);
  soil.parameters[kShear] = Marginal::logUniform(0.003, 0.06);
  return soil;
}

}  // namespace

Marginal Marginal::fixed(double value) {
  Marginal m;
  m.low_ = m.high_ = value;
  return m;
}

Marginal Marginal::uniform(double low, double high) {
  RangeCheck("prior").above("upper bound", high, low);
  Marginal m;
  m.low_ = low;
  m.high_ = high;
  return m;
}

Marginal Marginal::logUniform(double low, double high) {
  RangeCheck("prior").above("lower bound", low, 0.0);
  Marginal m = uniform(std::log(low), std::log(high));
  m.shape_ = Shape::LogUniform;
  return m;
}

Marginal Marginal::normal(double mean, double std, double least) {
  RangeCheck("prior").above("std", std, 0.0);
  Marginal m;
  m.shape_ = Shape::Normal;
  m.low_ = least;
  m.mean_ = mean;
  m.std_ = std;
  return m;
}

double Marginal::at(double y) const {
  if (shape_ == Shape::Normal) return std::max(low_, mean_ + std_ * y);
  const double value = low_ + (high_ - low_) * y;
  return shape_ == Shape::LogUniform ? std::exp(value) : value;
}

double Marginal::slope(double y) const {
  if (shape_ == Shape::Normal) return mean_ + std_ * y > low_ ? std_ : 0.0;
  return shape_ == Shape::LogUniform ? at(y) * (high_ - low_) : high_ - low_;
}

ContactSoil SoilClass::at(const SoilVector& y) const {
  return {.cohesion_Pa = parameters[kCohesion].at(y[kCohesion]),
          .friction_angle_rad = parameters[kFriction].at(y[kFriction]),
          .sinkage_exponent = parameters[kExponent].at(y[kExponent]),
          .sinkage_modulus = parameters[kModulus].at(y[kModulus]),
          .shear_modulus_m = parameters[kShear].at(y[kShear]),
          .c1 = c1,
          .c2 = c2};
}

SoilVector SoilClass::slope(const SoilVector& y) const {
  SoilVector slope;
  for (int k = 0; k < kSoilParameters; ++k) slope[k] = parameters[static_cast<std::size_t>(k)].slope(y[k]);
  return slope;
}

SoilMixture thesisSoils() {
  return {classOf({"sand", {0.0, 1.0}, {30.0, 35.0}, {1.5, 2.0}}),
          classOf({"clay", {5.0, 7.0}, {20.0, 25.0}, {1.0, 1.5}}),
          classOf({"loam", {2.0, 4.0}, {20.0, 30.0}, {1.5, 2.0}}),
          classOf({"firm soil", {0.0, 1.0}, {30.0, 35.0}, {2.5, 3.0}})};
}

SoilMixture thesisSoilsOrOther(double other_probability) {
  SoilMixture prior = thesisSoils();
  for (SoilClass& soil : prior) soil.probability *= 1.0 - other_probability;
  prior.push_back(anySoil(other_probability));
  return prior;
}

}  // namespace talus::terramech
