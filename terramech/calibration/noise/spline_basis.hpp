#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace talus::terramech {

/// Returns knots at quantiles of the distinct finite values of x: at most `most` knots, fewer for few values.
std::vector<double> quantileKnots(const Eigen::VectorXd& x, int most);

/// Returns the basis of natural cubic splines in terms of their values at the knots, rows x knots. Each row
/// sums to 1; a row is zero where x is NaN.
Eigen::MatrixXd splineBasis(const Eigen::VectorXd& x, const std::vector<double>& knots);

/// Returns an orthonormal basis of the columns; directions of relative length below 1e-8 are dropped.
Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& columns);

}  // namespace talus::terramech
