#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <talus/terramech/trace/exchangeable_units.hpp>
#include <talus/terramech/trace/sensor_noise.hpp>
#include <talus/terramech/trace/trial.hpp>

namespace talus::terramech {

/// One question put to the residuals.
struct CovariateTest {
  std::string covariate;  ///< column, "constant", or name of an effect whose own direction is tried
  int channel = -1;       ///< of Channel; -1: an effect's direction through all channels
  double z = 0.0;         ///< strength as a normal score (wilson_hilferty_1931), less its mean and over its
                          ///< standard deviation under noise alone
  double p_value = 1.0;   ///< family-wise: how often noise alone gives any question this strength
};

/// A direction in the space of whitened residuals, rows*kChannels x degrees of freedom.
struct Direction {
  std::string name;
  Eigen::MatrixXd columns;
};

/// The hypothesis to test.
struct TestPlan {
  std::vector<Direction> directions;  ///< of candidate effects, whitened
  Eigen::MatrixXd nuisance_whitened;  ///< derivatives by what was fitted already, whitened
  Eigen::MatrixXd nuisance_marginal;  ///< the same over marginal standard deviations
  Eigen::MatrixXd shared_error;  ///< rows x kChannels: a normal error of all rows at once, one std; may be
                                 ///< empty
  ExchangeableUnits units;       ///< rows whose errors belong together
  int flips = 1999;
  std::uint64_t seed = 1;
};

/// Every covariate in every channel (spline and line), every grouping, a constant, and every direction,
/// against sign flips: of what the rows of a unit share as one, and of what is left of each row by itself
/// (its units' means taken out again). p-values of the maximum over all questions (westfall_young_1993), each
/// on the scale that it has under noise, so that one that few units answer does not drown the others. Exact,
/// where rows are on their own, when the noise is symmetric, whatever its variance from row to row.
std::vector<CovariateTest> testCovariates(const Trial& trial, const Whitening& whitening,
                                          const Eigen::MatrixXd& residual, const Eigen::VectorXd& sinkage_m,
                                          const TestPlan& plan);

/// Values of a covariate over the rows; "sinkage_m" is the model's.
Eigen::VectorXd covariateValues(const Trial& trial, const std::string& name,
                                const Eigen::VectorXd& sinkage_m);

}  // namespace talus::terramech
