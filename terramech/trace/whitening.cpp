#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>

#include <talus/terramech/trace/whitening.hpp>

namespace talus::terramech {
namespace {

double squared(double x) {
  return x * x;
}

double medianOf(std::vector<double> v) {
  if (v.empty()) return 0.0;
  std::nth_element(v.begin(), v.begin() + static_cast<long>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

}  // namespace

Eigen::Matrix4d rowCovariance(const Trial& trial, int row, const Eigen::MatrixXd& level,
                              const InputSlopes& slopes, const SensorNoise& noise, double slip_variance,
                              double load_variance) {
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
  const Part inverse = Eigen::LLT<Part>(part).matrixL().solve(Part::Identity(size, size));
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
  for (Eigen::Index row : rows)
    if (!whitening.unit.empty()) part.unit.push_back(whitening.unit[static_cast<std::size_t>(row)]);
  part.shared_white = whitening.shared_white;
  part.shared_marginal = whitening.shared_marginal;
  return part;
}

Eigen::VectorXd Whitening::ownApply(const Eigen::MatrixXd& residual) const {
  Eigen::VectorXd out(residual.rows() * kChannels);
  for (int row = 0; row < residual.rows(); ++row)
    out.segment<kChannels>(row * kChannels) =
        factor[static_cast<std::size_t>(row)] * finiteOrZero(residual, row);
  slip.takeOut(out);
  return out;
}

Eigen::VectorXd Whitening::ownMarginal(const Eigen::MatrixXd& residual) const {
  Eigen::VectorXd out(residual.rows() * kChannels);
  for (Eigen::Index row = 0; row < residual.rows(); ++row)
    for (int c = 0; c < kChannels; ++c) {
      const bool there =
          factor[static_cast<std::size_t>(row)](c, c) != 0.0 && std::isfinite(residual(row, c));
      out[row * kChannels + c] = there ? residual(row, c) / std(row, c) : 0.0;
    }
  return out;
}

void Whitening::settle(Eigen::Ref<Eigen::VectorXd> scaled, const Eigen::Vector4d& shared) const {
  if (unit.empty() || shared.isZero()) return;
  const int units = *std::max_element(unit.begin(), unit.end()) + 1;
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(units, kChannels), count = sum;
  for (std::size_t row = 0; row < unit.size(); ++row)
    for (int c = 0; c < kChannels; ++c) {
      if (factor[row](c, c) == 0.0) continue;
      sum(unit[row], c) += scaled[static_cast<Eigen::Index>(row) * kChannels + c];
      count(unit[row], c) += 1.0;
    }
  for (std::size_t row = 0; row < unit.size(); ++row)
    for (int c = 0; c < kChannels; ++c) {
      const double m = count(unit[row], c);
      if (factor[row](c, c) == 0.0 || m < 1.0) continue;
      const double kept = 1.0 / std::sqrt(1.0 + m * shared[c]);
      scaled[static_cast<Eigen::Index>(row) * kChannels + c] -= (1.0 - kept) * sum(unit[row], c) / m;
    }
}

Eigen::VectorXd Whitening::apply(const Eigen::MatrixXd& residual) const {
  Eigen::VectorXd out = ownApply(residual);
  settle(out, shared_white);
  return out;
}

Eigen::VectorXd Whitening::marginal(const Eigen::MatrixXd& residual) const {
  Eigen::VectorXd out = ownMarginal(residual);
  settle(out, shared_marginal);
  return out;
}

Eigen::MatrixXd Whitening::backFromApply(const Eigen::MatrixXd& columns) const {
  Eigen::MatrixXd back = columns;
  for (Eigen::Index k = 0; k < back.cols(); ++k) {
    settle(back.col(k), shared_white);
    slip.takeOut(back.col(k));
  }
  for (std::size_t row = 0; row < factor.size(); ++row) {
    auto part = back.middleRows<kChannels>(static_cast<Eigen::Index>(row) * kChannels);
    part = (factor[row].transpose() * part).eval();
  }
  return back;
}

Eigen::MatrixXd Whitening::backFromMarginal(const Eigen::MatrixXd& columns) const {
  Eigen::MatrixXd back = columns;
  for (Eigen::Index k = 0; k < back.cols(); ++k) settle(back.col(k), shared_marginal);
  for (std::size_t row = 0; row < factor.size(); ++row)
    for (int c = 0; c < kChannels; ++c)
      back.row(static_cast<Eigen::Index>(row) * kChannels + c) *=
          factor[row](c, c) != 0.0 ? 1.0 / std(static_cast<Eigen::Index>(row), c) : 0.0;
  return back;
}

namespace {

/// Variance that units share over that of a row, less than nought counting as nought.
double sharedVariance(const std::vector<double>& value, const std::vector<int>& unit) {
  const int units = value.empty() ? 0 : *std::max_element(unit.begin(), unit.end()) + 1;
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(units), count = sum;
  double total = 0.0;
  for (std::size_t i = 0; i < value.size(); ++i) {
    sum[unit[i]] += value[i];
    count[unit[i]] += 1.0;
    total += value[i];
  }
  const auto n = static_cast<double>(value.size()), used = static_cast<double>((count > 0.0).count());
  if (used < 3.0 || n - used < 3.0) return 0.0;
  double between = 0.0, within = 0.0;
  for (Eigen::Index u = 0; u < units; ++u)
    if (count[u] > 0.0) between += count[u] * squared(sum[u] / count[u] - total / n);
  for (std::size_t i = 0; i < value.size(); ++i) within += squared(value[i] - sum[unit[i]] / count[unit[i]]);
  within /= n - used;
  const double size = (n - count.square().sum() / n) / (used - 1.0);
  return within > 0.0 ? std::max(0.0, (between / (used - 1.0) - within) / (size * within)) : 0.0;
}

}  // namespace

void Whitening::share(const std::vector<int>& of_row, const Eigen::MatrixXd& left) {
  unit = slip.moment.empty() ? of_row : std::vector<int>{};
  shared_white.setZero();
  shared_marginal.setZero();
  if (unit.empty()) return;
  const Eigen::VectorXd white = ownApply(left), one = ownMarginal(left);
  for (int c = 0; c < kChannels; ++c) {
    std::vector<double> value, value_marginal;
    std::vector<int> group;
    for (std::size_t row = 0; row < unit.size(); ++row) {
      if (factor[row](c, c) == 0.0) continue;
      const Eigen::Index at = static_cast<Eigen::Index>(row) * kChannels + c;
      value.push_back(white[at]);
      value_marginal.push_back(one[at]);
      group.push_back(unit[row]);
    }
    shared_white[c] = sharedVariance(value, group);
    shared_marginal[c] = sharedVariance(value_marginal, group);
  }
}

namespace {

/// No reading is trusted four times better than the median one: where a relative error meets a reading near
/// zero the quadrature and the noise of slip and load, known to first order, would speak louder than the
/// sensor.
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
