#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace talus::terramech {

/// Knots at quantiles of the distinct finite values: as many as `most`, fewer where there are few values.
std::vector<double> quantileKnots(const Eigen::VectorXd& x, int most);

/// Natural cubic spline basis by its values at the knots, rows x knots (they add up to 1 a row); a row of
/// zeros where x is NaN.
Eigen::MatrixXd splineBasis(const Eigen::VectorXd& x, const std::vector<double>& knots);

/// Orthonormal columns that span those given; directions of relative length below 1e-8 are dropped.
Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& columns);

}  // namespace talus::terramech
