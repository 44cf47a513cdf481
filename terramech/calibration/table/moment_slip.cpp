#include <algorithm>
#include <cmath>

#include <talus/terramech/calibration/table/moment_slip.hpp>

namespace talus::terramech {
namespace {

/// For each moment u.w and |u|^2.
struct Products {
  Eigen::VectorXd with_rows, length;
};

Products productsOf(const MomentSlip& slip, const Eigen::VectorXd& rows) {
  const int moments = *std::max_element(slip.moment.begin(), slip.moment.end()) + 1;
  Products p{Eigen::VectorXd::Zero(moments), Eigen::VectorXd::Zero(moments)};
  const Eigen::Index channels = slip.moved.cols();
  for (Eigen::Index row = 0; row < slip.moved.rows(); ++row) {
    const int m = slip.moment[static_cast<std::size_t>(row)];
    p.with_rows[m] += slip.moved.row(row).dot(rows.segment(row * channels, channels));
    p.length[m] += slip.moved.row(row).squaredNorm();
  }
  return p;
}

}  // namespace

void MomentSlip::takeOut(Eigen::Ref<Eigen::VectorXd> rows) const {
  if (moment.empty()) return;
  const Products p = productsOf(*this, rows);
  const Eigen::Index channels = moved.cols();
  for (Eigen::Index row = 0; row < moved.rows(); ++row) {
    const int m = moment[static_cast<std::size_t>(row)];
    if (p.length[m] <= 0.0) continue;
    // (T5) (I + u u^T)^(-1/2) = I - (1 - (1 + |u|^2)^(-1/2)) u u^T / |u|^2
    const double share = (1.0 - 1.0 / std::sqrt(1.0 + p.length[m])) * p.with_rows[m] / p.length[m];
    rows.segment(row * channels, channels) -= share * moved.row(row).transpose();
  }
}

double MomentSlip::logLikelihood(const Eigen::VectorXd& rows) const {
  if (moment.empty()) return 0.0;
  const Products p = productsOf(*this, rows);
  const Eigen::ArrayXd grown = 1.0 + p.length.array();
  return 0.5 * (p.with_rows.array().square() / grown - grown.log()).sum();
}

MomentSlip subset(const MomentSlip& slip, const std::vector<char>& keep) {
  MomentSlip part;
  if (slip.moment.empty()) return part;
  std::vector<Eigen::Index> rows;
  for (std::size_t row = 0; row < keep.size(); ++row) {
    if (!keep[row]) continue;
    part.moment.push_back(slip.moment[row]);
    rows.push_back(static_cast<Eigen::Index>(row));
  }
  part.moved = slip.moved(rows, Eigen::all);
  return part;
}

}  // namespace talus::terramech
