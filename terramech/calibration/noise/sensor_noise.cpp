#include <algorithm>
#include <cmath>
#include <functional>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <nlopt.hpp>

#include <talus/terramech/calibration.hpp>
#include <talus/terramech/calibration/noise/sensor_noise.hpp>
#include <talus/terramech/effects/refined_model.hpp>
#include <talus/terramech/numerics/functions.hpp>

namespace talus::terramech {
namespace {

/// Standard deviation of the logarithm of a stated error.
constexpr double kStatedSpread = 0.25;

/// A positive number, searched by its logarithm, with a log-normal prior.
struct Scale {
  double* target;
  double median, spread;  // spread: standard deviation of the logarithm
};

std::optional<double> statedOf(const StatedSensors& stated, Channel channel) {
  constexpr std::optional<double> StatedSensors::*kFields[] = {
      &StatedSensors::drawbar_pull_N, &StatedSensors::sinkage_m, &StatedSensors::torque_Nm,
      &StatedSensors::side_force_N};
  return stated.*kFields[static_cast<std::size_t>(channel)];
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
    if (!given && stated.relative) {
      all.push_back({&noise.relative[k], *stated.relative, kStatedSpread});
      continue;
    }
    all.push_back({&noise.absolute[k],
                   given.value_or(std::max(0.01 * medianOf(sizes), 0.1 * medianOf(left)) + 1e-9),
                   given ? kStatedSpread : 1.0});
    all.push_back({&noise.relative[k], given ? 0.01 : 0.03, 1.0});
  }
  if (stated.slip || !stated.relative)
    all.push_back({&noise.slip_absolute, std::max(stated.slip.value_or(0.005), 1e-5),
                   stated.slip ? kStatedSpread : 1.0});
  if (!stated.slip)
    all.push_back(
        {&noise.slip_relative, stated.relative.value_or(0.02), stated.relative ? kStatedSpread : 0.7});
  const double load = stated.load_N ? std::max(*stated.load_N / medianOf(trial.load_N), 1e-5)
                                    : stated.relative.value_or(0.02);
  all.push_back({&noise.load_relative, load, stated.load_N || stated.relative ? kStatedSpread : 0.7});
  return all;
}

/// Root mean square over all rows of the sensor's error, in the unit of its column.
double errorOf(const Trial& trial, const Eigen::MatrixXd& level, const SensorNoise& noise, int channel) {
  const auto k = static_cast<std::size_t>(channel);
  double sum = 0.0;
  for (int row = 0; row < trial.rows(); ++row)
    sum += squared(noise.absolute[k]) + squared(noise.relative[k] * level(row, channel) *
                                                trial.denominator(row, static_cast<Channel>(channel)));
  return std::sqrt(sum / std::max(1, trial.rows()));
}

}  // namespace

std::vector<StrainedSensor> strainedSensors(const Trial& trial, const Eigen::MatrixXd& level,
                                            const StatedSensors& stated, SensorNoise& noise) {
  std::vector<StrainedSensor> all;
  const auto isStrained = [&](const char* column, const std::optional<double>& declared, double fitted) {
    if (!declared || !(fitted > *declared * std::exp(2.0 * kStatedSpread))) return false;  // (T8)
    all.push_back({column, *declared, fitted});
    return true;
  };
  for (int c = 0; c < kChannels; ++c) {
    const auto channel = static_cast<Channel>(c);
    // For a drive, the pull follows from the slope and is not a sensor reading.
    if (!trial.has(channel) || (channel == Channel::DrawbarPull && !trial.moment.empty())) continue;
    const auto declared = statedOf(stated, channel);
    if (!isStrained(kAnswers[static_cast<std::size_t>(c)], declared, errorOf(trial, level, noise, c)))
      continue;
    noise.absolute[static_cast<std::size_t>(c)] = *declared;
    noise.relative[static_cast<std::size_t>(c)] = 0.0;
  }
  if (isStrained("slip", stated.slip, noise.slip_absolute)) noise.slip_absolute = *stated.slip;
  const double load_N = medianOf(trial.load_N);
  if (isStrained("load_N", stated.load_N, noise.load_relative * load_N))
    noise.load_relative = *stated.load_N / load_N;
  return all;
}

std::vector<std::string> unstatedSensors(const Trial& trial, const StatedSensors& stated) {
  std::vector<std::string> all;
  for (int c = 0; c < kChannels; ++c)
    if (const auto channel = static_cast<Channel>(c); trial.has(channel) && !statedOf(stated, channel))
      all.emplace_back(kAnswers[static_cast<std::size_t>(c)]);
  if (!stated.slip) all.emplace_back("slip");
  if (!stated.load_N) all.emplace_back("load_N");
  return all;
}

std::vector<std::string> noiseColumns(const Trial& trial) {
  std::vector<std::string> names;
  for (const std::string& name : trial.covariates)
    if (std::find(trial.chance.begin(), trial.chance.end(), name) == trial.chance.end())
      names.push_back(name);
  return names;
}

std::vector<std::string> allButSlip(const Trial& trial) {
  const std::vector<std::string> names = noiseColumns(trial);
  const bool determines_slip = std::find(names.begin(), names.end(), "rim_speed_mps") != names.end();
  std::vector<std::string> others;
  for (const std::string& name : names)
    if (name != "slip" && !(name == "speed_mps" && determines_slip)) others.push_back(name);
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
    r -= q * (q.transpose() * r);  // (T6)
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
    const double variance = squared(noise.slipStd(slip));
    const double own = trial.moment.empty() ? variance : 0.0;
    const Eigen::Matrix4d factor = rowFactor(
        rowCovariance(trial, row, level, slopes, noise, own, squared(noise.load_relative)), residual, row);
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
  using Cost = std::function<double(const std::vector<double>&)>;
  Cost cost = [&](const std::vector<double>& log_ratio) {
    set(log_ratio);
    double sum = 0.0;
    for (std::size_t k = 0; k < all.size(); ++k) sum += 0.5 * squared(log_ratio[k] / all[k].spread);
    return sum - logLikelihood(trial, residual, level, slopes, noise);  // (T7)
  };
  nlopt::opt search(nlopt::LN_NELDERMEAD, static_cast<unsigned>(all.size()));  // nelder_mead_1965
  search.set_min_objective(
      [](const std::vector<double>& x, std::vector<double>&, void* f) { return (*static_cast<Cost*>(f))(x); },
      &cost);
  search.set_initial_step(0.7);
  search.set_maxeval(900);
  search.set_ftol_abs(1e-3);
  std::vector<double> best(all.size(), 0.0);
  try {
    double value = 0.0;
    search.optimize(best, value);
  } catch (const nlopt::roundoff_limited&) {  // no step improves within rounding
  }
  set(best);
  return noise;
}

std::array<double, kChannels> noiseFloor(const Trial& trial, const Eigen::MatrixXd& level,
                                         const InputSlopes& slopes, const SensorNoise& noise) {
  std::array<double, kChannels> floor{};
  for (std::size_t c = 0; c < kChannels; ++c) {
    double sum = 0.0;
    int count = 0;
    for (int row = 0; row < trial.rows(); ++row) {
      const auto k = static_cast<int>(c);
      if (!std::isfinite(trial.measured(row, k))) continue;
      const double slip = noise.slipStd(trial.slip[static_cast<std::size_t>(row)]);
      // (T50)
      sum += std::pow(noise.absolute[c] / trial.denominator(row, static_cast<Channel>(k)), 2) +
             std::pow(noise.relative[c] * level(row, k), 2) + std::pow(slip * slopes.by_slip(row, k), 2) +
             std::pow(noise.load_relative * slopes.by_load(row, k), 2);
      ++count;
    }
    floor[c] = count ? std::sqrt(sum / count) : std::nan("");
  }
  return floor;
}

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
