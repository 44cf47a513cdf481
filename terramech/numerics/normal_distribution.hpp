#pragma once

#include <cstddef>

#include <Eigen/Core>

namespace talus::terramech {

/// Standard normal density, distribution function and its inverse [-].
double normalDensity(double x);
double normalProbability(double x);

/// x with normalProbability(x) = p, p in (0, 1), to 1e-12 or so.
double normalQuantile(double p);

/// Points spread evenly over the open unit cube: a Halton sequence (bases 2, 3, 5, 7, ...; at most eight
/// rows). Deterministic: an integral over a posterior needs no seed.
Eigen::MatrixXd evenPoints(Eigen::Index rows, Eigen::Index count);

}  // namespace talus::terramech
