#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace talus::terramech {

/// Knots at quantiles of the distinct finite values; at most `most`, fewer for few values.
std::vector<double> quantileKnots(const Eigen::VectorXd& x, int most);

/// Natural cubic spline basis in terms of the values at the knots, rows x knots (each row sums to 1); rows
/// are zero where x is NaN.
Eigen::MatrixXd splineBasis(const Eigen::VectorXd& x, const std::vector<double>& knots);

/// Orthonormal basis of the columns; directions of relative length below 1e-8 are dropped.
Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& columns);

}  // namespace talus::terramech
