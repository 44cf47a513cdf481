#include <algorithm>
#include <cmath>
#include <functional>

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include <terramech/nelder_mead.hpp>
#include <terramech/sensor_noise.hpp>
#include <terramech/spline_basis.hpp>

namespace talus::terramech {
namespace {

double squared(double x) {
  return x * x;
}

/// Row covariances of scaled residuals.
Eigen::Matrix4d covariance(const Trial& trial, int row, const Eigen::MatrixXd& level,
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

/// Indices of the channels that a row measures.
int present(const Eigen::MatrixXd& measured, int row, std::array<int, kChannels>& index) {
  int count = 0;
  for (int c = 0; c < kChannels; ++c)
    if (std::isfinite(measured(row, c))) index[static_cast<std::size_t>(count++)] = c;
  return count;
}

/// Inverse of the lower Cholesky factor of the covariance of the channels that a row measures; zero
/// elsewhere.
Eigen::Matrix4d rowFactor(const Eigen::Matrix4d& s, const Eigen::MatrixXd& measured, int row) {
  std::array<int, kChannels> index{};
  const int n = present(measured, row, index);
  Eigen::Matrix<double, -1, -1, 0, 4, 4> part(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      part(i, j) = s(index[static_cast<std::size_t>(i)], index[static_cast<std::size_t>(j)]);
  const auto inverse =
      Eigen::LLT<decltype(part)>(part).matrixL().solve(decltype(part)::Identity(n, n)).eval();
  Eigen::Matrix4d full = Eigen::Matrix4d::Zero();
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= i; ++j)
      full(index[static_cast<std::size_t>(i)], index[static_cast<std::size_t>(j)]) = inverse(i, j);
  return full;
}

Eigen::Vector4d finiteOrZero(const Eigen::MatrixXd& residual, int row) {
  return residual.row(row).transpose().unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; });
}

/// A positive number in a search on logarithms, with a log-normal prior.
struct Scale {
  double* target;
  double median, spread;  // spread: std of the logarithm
};

double medianOf(std::vector<double> v) {
  if (v.empty()) return 0.0;
  std::nth_element(v.begin(), v.begin() + static_cast<long>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

std::optional<double> statedOf(const StatedSensors& stated, Channel channel) {
  switch (channel) {
    case Channel::DrawbarPull:
      return stated.drawbar_pull_N;
    case Channel::Sinkage:
      return stated.sinkage_m;
    case Channel::Torque:
      return stated.torque_Nm;
    case Channel::SideForce:
      return stated.side_force_N;
  }
  return {};
}

std::vector<Scale> scales(const Trial& trial, const Eigen::MatrixXd& residual, const Eigen::MatrixXd& level,
                          const StatedSensors& stated, SensorNoise& noise) {
  std::vector<Scale> all;
  for (int c = 0; c < kChannels; ++c) {
    if (!trial.has(static_cast<Channel>(c))) continue;
    std::vector<double> sizes, left;
    for (int row = 0; row < trial.rows(); ++row) {
      const double unit = trial.denominator(row, static_cast<Channel>(c));
      sizes.push_back(std::abs(level(row, c)) * unit);
      if (std::isfinite(residual(row, c))) left.push_back(std::abs(residual(row, c)) * unit);
    }
    const auto k = static_cast<std::size_t>(c);
    const auto given = statedOf(stated, static_cast<Channel>(c));
    all.push_back({&noise.absolute[k],
                   given.value_or(std::max(0.01 * medianOf(sizes), 0.1 * medianOf(left)) + 1e-9),
                   given ? 0.25 : 1.0});
    all.push_back({&noise.relative[k], given ? 0.01 : 0.03, 1.0});
  }
  if (stated.slip)
    all.push_back({&noise.slip_absolute, std::max(*stated.slip, 1e-5), 0.25});
  else
    all.push_back({&noise.slip_relative, 0.02, 0.7});
  const double load = medianOf(trial.load_N);
  all.push_back({&noise.load_relative, stated.load_N ? std::max(*stated.load_N / load, 1e-5) : 0.02,
                 stated.load_N ? 0.25 : 0.7});
  return all;
}

}  // namespace

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

bool slipIsSeen(const Trial& trial, const SensorNoise& noise) {
  const Eigen::Map<const Eigen::ArrayXd> slip(trial.slip.data(), trial.rows());
  const Eigen::ArrayXd error = (squared(noise.slip_absolute) + squared(noise.slip_relative) * slip.square())
                                   .sqrt()
                                   .min(0.1 * slip.abs());
  return (slip - slip.mean()).square().mean() > 4.0 * error.square().mean();
}

double levelStd(const Trial& trial, const SensorNoise& noise) {
  double sum = 0.0;
  for (double slip : trial.slip) sum += squared(noise.slip_absolute) + squared(noise.slip_relative * slip);
  return std::sqrt(sum) / trial.rows();
}

void setSlip(WheelState& state, double slip) {
  const double ground = state.rim_speed_mps * (1.0 - state.slip);
  if (std::abs(state.speed_mps - ground) <= 1e-3 * std::abs(state.rim_speed_mps))
    state.speed_mps = state.rim_speed_mps * (1.0 - slip);
  state.slip = slip;
}

std::vector<std::string> allButSlip(const Trial& trial) {
  const auto& names = trial.covariates;
  const bool tells_slip = std::find(names.begin(), names.end(), "rim_speed_mps") != names.end();
  std::vector<std::string> others;
  for (const std::string& name : names)
    if (name != "slip" && !(name == "speed_mps" && tells_slip)) others.push_back(name);
  return others;
}

Eigen::MatrixXd withoutSmooth(const Trial& trial, const Eigen::MatrixXd& residual,
                              const std::vector<std::string>& names) {
  Eigen::MatrixXd left = residual;
  for (int c = 0; c < kChannels; ++c) {
    std::vector<int> rows;
    for (int row = 0; row < trial.rows(); ++row)
      if (std::isfinite(residual(row, c))) rows.push_back(row);
    const auto n = static_cast<Eigen::Index>(rows.size());
    if (n < 8) continue;
    std::vector<Eigen::MatrixXd> parts{Eigen::MatrixXd::Ones(n, 1)};
    Eigen::Index columns = 1;
    const auto room = n / 4;
    for (const std::string& name : names) {
      Eigen::VectorXd x(n);
      for (Eigen::Index i = 0; i < n; ++i)
        x[i] = trial.states[static_cast<std::size_t>(rows[static_cast<std::size_t>(i)])].covariate(name);
      const auto knots = quantileKnots(x, n >= 120 ? 6 : 4);
      if (knots.size() < 2 || columns + static_cast<Eigen::Index>(knots.size()) > room) continue;
      parts.push_back(splineBasis(x, knots));
      columns += static_cast<Eigen::Index>(knots.size()) - 1;
    }
    Eigen::MatrixXd all(n, 0);
    for (const auto& part : parts) {
      const Eigen::Index at = all.cols();
      all.conservativeResize(n, at + part.cols());
      all.rightCols(part.cols()) = part;
    }
    const Eigen::MatrixXd q = orthonormal(all);
    Eigen::VectorXd r(n);
    for (Eigen::Index i = 0; i < n; ++i) r[i] = residual(rows[static_cast<std::size_t>(i)], c);
    r -= q * (q.transpose() * r);
    r *= std::sqrt(static_cast<double>(n) / static_cast<double>(n - q.cols()));
    for (Eigen::Index i = 0; i < n; ++i) left(rows[static_cast<std::size_t>(i)], c) = r[i];
  }
  return left;
}

namespace {

double logLikelihood(const Trial& trial, const Eigen::MatrixXd& residual, const Eigen::MatrixXd& level,
                     const InputSlopes& slopes, const SensorNoise& noise) {
  MomentSlip shared{trial.moment, Eigen::MatrixXd::Zero(trial.rows(), kChannels)};
  Eigen::VectorXd white(trial.rows() * kChannels);
  double sum = 0.0;
  for (int row = 0; row < trial.rows(); ++row) {
    const double slip = trial.states[static_cast<std::size_t>(row)].slip;
    const double variance = squared(noise.slip_absolute) + squared(noise.slip_relative * slip);
    const double own = trial.moment.empty() ? variance : 0.0;
    const Eigen::Matrix4d factor = rowFactor(
        covariance(trial, row, level, slopes, noise, own, squared(noise.load_relative)), residual, row);
    white.segment<kChannels>(row * kChannels) = factor * finiteOrZero(residual, row);
    shared.moved.row(row) = std::sqrt(variance) * factor * slopes.by_slip.row(row).transpose();
    for (int c = 0; c < kChannels; ++c)
      if (factor(c, c) > 0.0) sum += std::log(factor(c, c));
  }
  return sum - 0.5 * white.squaredNorm() + shared.logLikelihood(white);
}

}  // namespace

SensorNoise fitNoise(const Trial& trial, const Eigen::MatrixXd& residual, const Eigen::MatrixXd& level,
                     const InputSlopes& slopes, const StatedSensors& stated) {
  SensorNoise noise;
  const std::vector<Scale> all = scales(trial, residual, level, stated, noise);
  const auto set = [&](const std::vector<double>& log_ratio) {
    for (std::size_t k = 0; k < all.size(); ++k) *all[k].target = all[k].median * std::exp(log_ratio[k]);
  };
  const auto cost = [&](const std::vector<double>& log_ratio) {
    set(log_ratio);
    double sum = 0.0;
    for (std::size_t k = 0; k < all.size(); ++k) sum += 0.5 * squared(log_ratio[k] / all[k].spread);
    return sum - logLikelihood(trial, residual, level, slopes, noise);
  };
  set(nelderMead(cost, std::vector<double>(all.size(), 0.0),
                 {.step = 0.7, .evaluations = 900, .tolerance = 1e-3}));
  return noise;
}

namespace {

struct Posterior {
  double mean, variance;
};

/// Posterior of each true value under the distribution of true values that makes the measured ones most
/// likely: a mixture of atoms whose places and weights are found by expectation maximisation. `std_at` is the
/// noise at a true value. Values that are known better than the atoms lie apart stay as measured.
std::vector<Posterior> deconvolve(const std::vector<double>& measured,
                                  const std::function<double(double)>& std_at) {
  constexpr int kRounds = 200;
  const auto n = static_cast<Eigen::Index>(measured.size());
  const auto atoms = std::min<Eigen::Index>(50, std::max<Eigen::Index>(2, n / 2));
  const Eigen::Map<const Eigen::ArrayXd> x(measured.data(), n);
  const double spacing = (x.maxCoeff() - x.minCoeff()) / static_cast<double>(atoms) + 1e-12;
  Eigen::ArrayXd place = Eigen::ArrayXd::LinSpaced(atoms, x.minCoeff(), x.maxCoeff());
  Eigen::ArrayXd weight = Eigen::ArrayXd::Constant(atoms, 1.0 / static_cast<double>(atoms)), std(atoms);
  Eigen::ArrayXXd share(n, atoms);
  for (int round = 0; round < kRounds; ++round) {
    for (Eigen::Index a = 0; a < atoms; ++a) std[a] = std::max(std_at(place[a]), 0.5 * spacing);
    for (Eigen::Index a = 0; a < atoms; ++a)
      share.col(a) = weight[a] / std[a] * (-0.5 * ((x - place[a]) / std[a]).square()).exp();
    const Eigen::ArrayXd total = share.rowwise().sum() + 1e-300;
    share.colwise() /= total;
    for (Eigen::Index a = 0; a < atoms; ++a) {
      const double mass = share.col(a).sum();
      weight[a] = mass / static_cast<double>(n);
      if (mass > 1e-6) place[a] = (share.col(a) * x).sum() / mass;
    }
  }
  std::vector<Posterior> out;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double mean = (share.row(i).transpose() * place).sum();
    const double spread = (share.row(i).transpose() * (place - mean).square()).sum();
    const double own = std_at(x[i]);
    out.push_back(own < 0.5 * spacing ? Posterior{x[i], own * own} : Posterior{mean, spread});
  }
  return out;
}

}  // namespace

namespace {

/// Normal values with normal errors: the share of the scatter that is not error is kept.
std::vector<Posterior> shrink(const std::vector<double>& measured, const std::vector<double>& std) {
  const auto n = static_cast<Eigen::Index>(measured.size());
  const Eigen::Map<const Eigen::ArrayXd> x(measured.data(), n), error(std.data(), n);
  const double mean = x.mean(), scatter = (x - mean).square().mean();
  const double kept = std::clamp(1.0 - error.square().mean() / (scatter + 1e-300), 0.0, 1.0);
  std::vector<Posterior> out;
  for (Eigen::Index i = 0; i < n; ++i) out.push_back({mean + kept * (x[i] - mean), kept * squared(error[i])});
  return out;
}

}  // namespace

void calibrateInputs(Trial& trial, const SensorNoise& noise) {
  const auto n = trial.states.size();
  std::vector<double> slip_std(n), log_load(n), load_std(n, noise.load_relative);
  for (std::size_t i = 0; i < n; ++i) {
    slip_std[i] = std::hypot(noise.slip_absolute, noise.slip_relative * trial.slip[i]);
    log_load[i] = std::log(trial.load_N[i]);
  }
  // The mixture takes long to see that one level is one; nothing is lost where the scatter is mostly error.
  const auto slips =
      !slipIsSeen(trial, noise) ? shrink(trial.slip, slip_std) : deconvolve(trial.slip, [&](double slip) {
        return std::hypot(noise.slip_absolute, noise.slip_relative * slip);
      });
  const auto loads = deconvolve(log_load, [&](double) { return noise.load_relative; });
  for (std::size_t i = 0; i < n; ++i) {
    // A grid cannot place a value better than its step: precise inputs are left as measured.
    const auto row = static_cast<Eigen::Index>(i);
    const double trust = squared(slip_std[i]), trust_load = squared(load_std[i]);
    setSlip(trial.states[i], std::clamp(slips[i].mean, -1.0, 1.0));
    trial.slip_variance[row] = std::clamp(slips[i].variance, 0.3 * trust, trust);
    trial.states[i].load_N =
        std::abs(loads[i].mean - log_load[i]) > 2.5 * load_std[i] ? trial.load_N[i] : std::exp(loads[i].mean);
    trial.load_variance[row] = std::clamp(loads[i].variance, 0.3 * trust_load, trust_load);
  }
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
  part.shared = subset(whitening.shared, keep);
  return part;
}

Eigen::VectorXd Whitening::apply(const Eigen::MatrixXd& residual) const {
  Eigen::VectorXd out(residual.rows() * kChannels);
  for (int row = 0; row < residual.rows(); ++row)
    out.segment<kChannels>(row * kChannels) =
        factor[static_cast<std::size_t>(row)] * finiteOrZero(residual, row);
  shared.takeOut(out);
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
  if (!trial.moment.empty()) w.shared = {trial.moment, Eigen::MatrixXd::Zero(trial.rows(), kChannels)};
  for (int row = 0; row < trial.rows(); ++row) {
    const double slip_variance = trial.slip_variance[row];
    Eigen::Matrix4d s = covariance(trial, row, level, slopes, noise,
                                   trial.moment.empty() ? slip_variance : 0.0, trial.load_variance[row]);
    s.diagonal() = s.diagonal().cwiseMax(least);
    w.factor.push_back(rowFactor(s, trial.measured, row));
    w.std.row(row) = s.diagonal().transpose();
    if (!trial.moment.empty()) {
      w.std.row(row) += slip_variance * slopes.by_slip.row(row).cwiseAbs2();
      w.shared.moved.row(row) =
          std::sqrt(slip_variance) * w.factor.back() * slopes.by_slip.row(row).transpose();
    }
  }
  w.std = w.std.cwiseSqrt();
  return w;
}

}  // namespace talus::terramech
