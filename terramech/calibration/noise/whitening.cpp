#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <talus/terramech/calibration/noise/whitening.hpp>
#include <talus/terramech/numerics/functions.hpp>

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

Eigen::Matrix4d rowCovariance(const Trial& trial, int row, const Eigen::MatrixXd& level,
                              const InputSlopes& slopes, const SensorNoise& noise, double slip_variance,
                              double load_variance) {
  // (T3)
  Eigen::Matrix4d s = slip_variance * slopes.by_slip.row(row).transpose() * slopes.by_slip.row(row) +
                      load_variance * slopes.by_load.row(row).transpose() * slopes.by_load.row(row);
  for (int c = 0; c < kChannels; ++c) {
    const auto k = static_cast<std::size_t>(c);
    s(c, c) += squared(noise.absolute[k] / trial.denominator(row, static_cast<Channel>(c))) +
               squared(noise.relative[k] * level(row, c)) + 1e-12;
  }
  return s;
}

Eigen::Matrix4d rowFactor(const Eigen::Matrix4d& covariance, const Eigen::MatrixXd& measured, int row) {
  std::array<Eigen::Index, kChannels> index{};
  std::size_t n = 0;
  for (int c = 0; c < kChannels; ++c)
    if (std::isfinite(measured(row, c))) index[n++] = c;
  using Part = Eigen::Matrix<double, -1, -1, 0, kChannels, kChannels>;
  const auto size = static_cast<Eigen::Index>(n);
  Part part(size, size);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      part(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = covariance(index[i], index[j]);
  const Part inverse = Eigen::LLT<Part>(part).matrixL().solve(Part::Identity(size, size));  // (T4)
  Eigen::Matrix4d full = Eigen::Matrix4d::Zero();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j <= i; ++j)
      full(index[i], index[j]) = inverse(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  return full;
}

Eigen::Vector4d finiteOrZero(const Eigen::MatrixXd& residual, int row) {
  return residual.row(row).transpose().unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; });
}

InputSlopes inputSlopes(const RefinedModel& model, const Trial& trial, SolvedContacts& solved) {
  constexpr double kStep = 0.004;
  const auto moved = [&](double slip, double load) {
    Trial copy = trial;
    for (WheelState& s : copy.states) {
      s.slip = std::clamp(s.slip + slip, -1.0, 1.0);
      s.load_N *= 1.0 + load;
    }
    return predictRows(model, copy, solved);
  };
  return {(moved(kStep, 0.0) - moved(-kStep, 0.0)) / (2.0 * kStep),
          (moved(0.0, kStep) - moved(0.0, -kStep)) / (2.0 * kStep)};
}

Whitening subset(const Whitening& whitening, const std::vector<char>& keep) {
  Whitening part;
  std::vector<Eigen::Index> rows;
  for (std::size_t row = 0; row < keep.size(); ++row) {
    if (!keep[row]) continue;
    part.factor.push_back(whitening.factor[row]);
    rows.push_back(static_cast<Eigen::Index>(row));
  }
  part.std = whitening.std(rows, Eigen::all);
  part.slip = subset(whitening.slip, keep);
  part.common.run = whitening.common.run;
  for (Eigen::Index row : rows) {
    const auto r = static_cast<std::size_t>(row);
    if (!whitening.common.unit.empty()) part.common.unit.push_back(whitening.common.unit[r]);
    if (!whitening.common.by_soil.empty()) part.common.by_soil.push_back(whitening.common.by_soil[r]);
  }
  return part;
}

Eigen::VectorXd Whitening::rowByRow(const Eigen::MatrixXd& residual) const {
  Eigen::VectorXd out(residual.rows() * kChannels);
  for (int row = 0; row < residual.rows(); ++row)
    out.segment<kChannels>(row * kChannels) =
        factor[static_cast<std::size_t>(row)] * finiteOrZero(residual, row);
  slip.takeOut(out);
  return out;
}

Eigen::VectorXd Whitening::marginal(const Eigen::MatrixXd& residual) const {
  Eigen::VectorXd out(residual.rows() * kChannels);
  for (Eigen::Index row = 0; row < residual.rows(); ++row)
    for (int c = 0; c < kChannels; ++c) {
      const bool there =
          factor[static_cast<std::size_t>(row)](c, c) != 0.0 && std::isfinite(residual(row, c));
      out[row * kChannels + c] = there ? residual(row, c) / std(row, c) : 0.0;
    }
  return out;
}

std::vector<SharedFactor> Whitening::shared() const {
  const std::size_t rows = factor.size();
  std::vector<SharedFactor> all(rows, SharedFactor::Zero());
  for (std::size_t row = 0; row < rows; ++row) {
    all[row].leftCols<kChannels>() = factor[row];  // (T16)
    if (!common.by_soil.empty())
      all[row].rightCols<kShared - kChannels>() = factor[row] * common.by_soil[row];
  }
  for (int part = 0; part < kShared && !slip.moment.empty(); ++part) {
    Eigen::VectorXd out(static_cast<Eigen::Index>(rows) * kChannels);
    for (std::size_t row = 0; row < rows; ++row)
      out.segment<kChannels>(static_cast<Eigen::Index>(row) * kChannels) = all[row].col(part);
    slip.takeOut(out);
    for (std::size_t row = 0; row < rows; ++row)
      all[row].col(part) = out.segment<kChannels>(static_cast<Eigen::Index>(row) * kChannels);
  }
  return all;
}

// (T20) (I + B B^T)^(-1/2) of each run, B = F R^(1/2) stacked over its rows: with B^T B = Q S Q^T equal to I
// - B Q diag((1 - (1 + s)^(-1/2)) / s) Q^T B^T.
void Whitening::settleRuns(Eigen::VectorXd& rows) const {
  const std::vector<int>& unit = common.unit;
  if (unit.empty() || common.run.isZero()) return;
  const Eigen::SelfAdjointEigenSolver<RunError> eigen(common.run);
  const RunError root = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  const std::vector<SharedFactor> all = shared();
  std::map<int, std::pair<RunError, SharedVector>> sums;
  for (std::size_t row = 0; row < unit.size(); ++row) {
    const auto [at, fresh] = sums.try_emplace(unit[row], RunError::Zero(), SharedVector::Zero());
    const SharedFactor b = all[row] * root;
    at->second.first += b.transpose() * b;
    at->second.second += b.transpose() * rows.segment<kChannels>(static_cast<Eigen::Index>(row) * kChannels);
  }
  std::map<int, SharedVector> taken;
  for (const auto& [number, sum] : sums) {
    const Eigen::SelfAdjointEigenSolver<RunError> own(sum.first);
    const SharedVector weight = own.eigenvalues().unaryExpr(
        [](double s) { return s > 1e-12 ? (1.0 - 1.0 / std::sqrt(1.0 + s)) / s : 0.5; });
    taken[number] =
        root * own.eigenvectors() * weight.asDiagonal() * own.eigenvectors().transpose() * sum.second;
  }
  for (std::size_t row = 0; row < unit.size(); ++row)
    rows.segment<kChannels>(static_cast<Eigen::Index>(row) * kChannels) -= all[row] * taken[unit[row]];
}

Eigen::VectorXd Whitening::apply(const Eigen::MatrixXd& residual) const {
  Eigen::VectorXd out = rowByRow(residual);
  settleRuns(out);
  return out;
}

namespace {

/// Least variance of each channel: a sixteenth of the median variance, which limits the weight of a reading
/// near zero with a relative error. The errors of the quadrature, and of the first-order noise of slip and
/// load, would otherwise exceed that of the sensor.
Eigen::Vector4d leastVariance(const Trial& trial, const Eigen::MatrixXd& level, const SensorNoise& noise) {
  Eigen::Vector4d least;
  for (int c = 0; c < kChannels; ++c) {
    const auto k = static_cast<std::size_t>(c);
    std::vector<double> variance;
    for (int row = 0; row < trial.rows(); ++row)
      variance.push_back(squared(noise.absolute[k] / trial.denominator(row, static_cast<Channel>(c))) +
                         squared(noise.relative[k] * level(row, c)));
    least[c] = medianOf(variance) / 16.0;
  }
  return least;
}

}  // namespace

std::vector<SoilFactor> soilFactors(const RefinedModel& model, const Trial& trial,
                                    const Eigen::MatrixXd& level, const SolvedContacts& solved) {
  if (!trial.moment.empty()) return {};
  constexpr double kStep = 0.02;
  std::vector<SoilFactor> all(static_cast<std::size_t>(trial.rows()), SoilFactor::Zero());
  int part = 0;
  for (const char* kind : {"empirical_strength", "empirical_stiffness"}) {
    RefinedModel moved = model;
    moved.effects.push_back({.name = kind, .covariate = "slip", .parameters = {kStep}, .knots = {0.0}});
    SolvedContacts beside = solved;
    const Eigen::MatrixXd change = (predictRows(moved, trial, beside) - level) / kStep;
    for (int row = 0; row < trial.rows(); ++row)
      all[static_cast<std::size_t>(row)].col(part) = finiteOrZero(change, row);
    ++part;
  }
  return all;
}

Whitening whitening(const Trial& trial, const Eigen::MatrixXd& level, const InputSlopes& slopes,
                    const SensorNoise& noise) {
  Whitening w;
  w.std.resize(trial.rows(), kChannels);
  const Eigen::Vector4d least = leastVariance(trial, level, noise);
  const bool alone = trial.moment.empty();
  if (!alone) w.slip = {trial.moment, Eigen::MatrixXd::Zero(trial.rows(), kChannels)};
  for (int row = 0; row < trial.rows(); ++row) {
    const double slip_variance = trial.slip_variance[row];
    Eigen::Matrix4d s = rowCovariance(trial, row, level, slopes, noise, alone ? slip_variance : 0.0,
                                      trial.load_variance[row]);
    s.diagonal() = s.diagonal().cwiseMax(least);
    w.factor.push_back(rowFactor(s, trial.measured, row));
    w.std.row(row) = s.diagonal().transpose();
    if (alone) continue;
    w.std.row(row) += slip_variance * slopes.by_slip.row(row).cwiseAbs2();
    w.slip.moved.row(row) = std::sqrt(slip_variance) * w.factor.back() * slopes.by_slip.row(row).transpose();
  }
  w.std = w.std.cwiseSqrt();
  return w;
}

}  // namespace talus::terramech
