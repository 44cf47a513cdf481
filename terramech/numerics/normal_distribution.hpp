#pragma once

#include <cstddef>

#include <Eigen/Core>

namespace talus::terramech {

/// Return the density and the cumulative distribution function of the standard normal distribution at x.
double normalDensity(double x);
double normalProbability(double x);

/// Returns x with normalProbability(x) = p, with an error of about 1e-12. Throws std::invalid_argument unless
/// 0 < p < 1.
double normalQuantile(double p);

/// Returns the first `count` points of the Halton sequence in the open unit cube of dimension `rows`, one
/// point per column (bases 2, 3, 5, 7, ...). The points are evenly spread and deterministic, so that
/// integrals over a posterior need no random seed. Throws std::invalid_argument for more than eight rows.
Eigen::MatrixXd evenPoints(Eigen::Index rows, Eigen::Index count);

}  // namespace talus::terramech
