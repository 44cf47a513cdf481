#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include <talus/terramech/io/covariance_fault.hpp>

namespace talus::terramech {

std::string faultOfCovariance(const std::vector<double>& values, std::size_t size) {
  const auto n = static_cast<Eigen::Index>(size);
  const Eigen::MatrixXd given = Eigen::Map<const Eigen::MatrixXd>(values.data(), n, n);
  constexpr double kRounding =
      1e-6;  // of a correlation: an inverse of condition 1e10 and 17 digits in the file
  Eigen::MatrixXd correlation = given;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (given(i, i) < 0.0)
      return "has the negative variance " + std::to_string(given(i, i)) + " in row " + std::to_string(i + 1);
    for (Eigen::Index k = 0; k < n; ++k) {
      const double scale = std::sqrt(given(i, i)) * std::sqrt(std::max(given(k, k), 0.0));
      if (std::abs(given(i, k) - given(k, i)) > kRounding * scale)
        return "is not symmetric in row " + std::to_string(i + 1);
      if (std::abs(given(i, k)) > (1.0 + kRounding) * scale)
        return "has a correlation beyond 1 in row " + std::to_string(i + 1);
      correlation(i, k) = scale > 0.0 ? given(i, k) / scale : 0.0;
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(correlation, Eigen::EigenvaluesOnly);
  if (n > 0 && !(solver.eigenvalues().minCoeff() >= -kRounding * static_cast<double>(n)))
    return "gives a combination of the parameters a negative variance (it is not positive semidefinite)";
  return "";
}

}  // namespace talus::terramech
