#include <algorithm>
#include <cmath>

#include <Eigen/QR>

#include <talus/terramech/calibration/noise/spline_basis.hpp>
#include <talus/terramech/effects/refined_model.hpp>
#include <talus/terramech/numerics/functions.hpp>

namespace talus::terramech {

std::vector<double> quantileKnots(const Eigen::VectorXd& x, int most) {
  std::vector<double> sorted;
  for (double v : x)
    if (std::isfinite(v)) sorted.push_back(v);
  std::sort(sorted.begin(), sorted.end());
  if (sorted.empty()) return {};
  std::vector<double> distinct = sorted;
  const double close = 1e-6 * (sorted.back() - sorted.front());
  distinct.erase(
      std::unique(distinct.begin(), distinct.end(), [&](double a, double b) { return b - a <= close; }),
      distinct.end());
  const auto count = std::min<std::size_t>(static_cast<std::size_t>(most), distinct.size());
  if (count == distinct.size()) return distinct;
  std::vector<double> knots;
  for (std::size_t k = 0; k < count; ++k) {
    const double q = static_cast<double>(k) / static_cast<double>(count - 1);
    knots.push_back(sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))]);
  }
  const double apart = 0.02 * (sorted.back() - sorted.front());
  std::vector<double> spaced{knots.front()};
  for (double k : knots)
    if (k - spaced.back() > apart) spaced.push_back(k);
  return spaced;
}

Eigen::MatrixXd splineBasis(const Eigen::VectorXd& x, const std::vector<double>& knots) {
  const auto count = static_cast<Eigen::Index>(knots.size());
  Eigen::MatrixXd basis = Eigen::MatrixXd::Zero(x.size(), count);
  std::vector<double> unit(knots.size(), 0.0);
  for (Eigen::Index k = 0; k < count; ++k) {
    unit[static_cast<std::size_t>(k)] = 1.0;
    const NaturalSpline spline{knots, unit};
    for (Eigen::Index row = 0; row < x.size(); ++row)
      if (std::isfinite(x[row])) basis(row, k) = spline(x[row]);
    unit[static_cast<std::size_t>(k)] = 0.0;
  }
  return basis;
}

Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& columns) {
  if (columns.cols() == 0) return columns;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(columns);
  qr.setThreshold(1e-8);
  const Eigen::Index rank = qr.rank();
  return qr.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), rank);
}

}  // namespace talus::terramech
