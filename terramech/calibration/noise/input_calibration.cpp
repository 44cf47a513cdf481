#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <vector>

#include <talus/terramech/calibration/noise/input_calibration.hpp>
#include <talus/terramech/numerics/functions.hpp>

namespace talus::terramech {

bool slipIsSeen(const Trial& trial, const SensorNoise& noise) {
  const Eigen::Map<const Eigen::ArrayXd> slip(trial.slip.data(), trial.rows());
  const Eigen::ArrayXd error =
      slip.unaryExpr([&](double i) { return noise.slipStd(i); }).min(0.1 * slip.abs());
  return (slip - slip.mean()).square().mean() > 4.0 * error.square().mean();  // (T9)
}

namespace {

bool isTied(const WheelState& s) {
  const double ground = s.rim_speed_mps * (1.0 - s.slip);
  return std::abs(s.speed_mps - ground) <= 1e-3 * std::abs(s.rim_speed_mps);
}

/// Readings with the variances of their errors, and the mean of each group of rows.
struct Grouped {
  Eigen::ArrayXd value, variance, mean, mean_variance;
  double groups = 0.0;

  Grouped(Eigen::ArrayXd values, Eigen::ArrayXd variances, const std::vector<int>& group)
      : value(std::move(values)), variance(std::move(variances)), mean(value.size()), mean_variance(mean) {
    std::map<int, std::pair<double, double>> sums;  // of weights, and of weighted values
    for (Eigen::Index i = 0; i < value.size(); ++i) {
      auto& [weight, sum] = sums[group[static_cast<std::size_t>(i)]];
      weight += 1.0 / variance[i];
      sum += value[i] / variance[i];
    }
    for (Eigen::Index i = 0; i < value.size(); ++i) {
      const auto& [weight, sum] = sums[group[static_cast<std::size_t>(i)]];
      mean[i] = sum / weight;
      mean_variance[i] = 1.0 / weight;
    }
    groups = static_cast<double>(sums.size());
  }

  double freedom() const { return std::max(1.0, static_cast<double>(value.size()) - groups); }
  /// Sum of squared deviations from the group means, in units of their errors.
  double deviations() const { return ((value - mean).square() / variance).sum(); }
};

/// Speeds over ground that follow from slip and rim speed.
Grouped speedsOf(const Trial& trial, const std::vector<int>& group,
                 const std::function<double(double)>& slip_std) {
  const auto n = static_cast<Eigen::Index>(trial.states.size());
  Eigen::ArrayXd value(n), variance(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto row = static_cast<std::size_t>(i);
    const double rim = trial.states[row].rim_speed_mps;
    value[i] = rim * (1.0 - trial.slip[row]);
    variance[i] = squared(rim * slip_std(trial.slip[row])) + squared(1e-6 * rim);
  }
  return {value, variance, group};
}

Grouped logLoads(const Trial& trial, const std::vector<int>& group, double error) {
  const Eigen::Map<const Eigen::ArrayXd> load_N(trial.load_N.data(), trial.rows());
  return {load_N.log(), Eigen::ArrayXd::Constant(trial.rows(), squared(error)), group};
}

constexpr double kLoadError = 0.1;  // load cells have errors below 10 %

/// Levels of load, each more than kLoadError from the next.
std::vector<int> loadLevels(const Trial& trial) {
  std::map<double, int> level;
  for (double load_N : trial.load_N) level[load_N] = 0;
  int number = 0;
  for (auto at = level.begin(), last = at; at != level.end(); last = at++)
    at->second = number += at->first > last->first * std::exp(kLoadError);
  std::vector<int> group;
  for (double load_N : trial.load_N) group.push_back(level[load_N]);
  return group;
}

}  // namespace

std::vector<int> setSpeeds(const Trial& trial, const SensorNoise& noise) {
  const auto tied = std::count_if(trial.states.begin(), trial.states.end(), isTied);
  if (tied < trial.rows() || trial.rows() < 3 || !slipIsSeen(trial, noise)) return {};
  const std::vector<int> one(trial.states.size(), 0);
  for (const std::vector<int>& group : {one, trial.run}) {
    if (2 * std::set<int>(group.begin(), group.end()).size() > group.size()) continue;
    const Grouped v = speedsOf(
        trial, group, [&](double slip) { return std::min(noise.slipStd(slip), 0.1 * std::abs(slip)); });
    if (v.deviations() <= 4.0 * v.freedom()) return group;  // (T12)
  }
  return {};
}

std::optional<SetLoads> setLoads(const Trial& trial) {
  if (!trial.moment.empty()) return {};
  for (const std::vector<int>& group : {trial.run, loadLevels(trial)}) {
    const Grouped loads = logLoads(trial, group, 1.0);
    const Grouped squares{(loads.value - loads.mean).square(), loads.variance, group};
    const double greatest = squares.mean.maxCoeff();
    if (4.0 * loads.groups <= trial.rows() && greatest > 0.0 && greatest < squared(kLoadError))
      return SetLoads{group, loads.mean.exp(), std::sqrt(loads.deviations() / loads.freedom())};
  }
  return {};
}

namespace {

bool isOne(const std::vector<int>& group) {
  return !group.empty() && std::all_of(group.begin(), group.end(), [&](int g) { return g == group.front(); });
}

}  // namespace

bool inputsAreSeen(const Trial& trial, const SensorNoise& noise) {
  return slipIsSeen(trial, noise) && !isOne(setSpeeds(trial, noise));
}

Eigen::VectorXd sharedSlipStd(const Trial& trial, const SensorNoise& noise) {
  if (!slipIsSeen(trial, noise)) {
    double sum = 0.0;
    for (double slip : trial.slip) sum += squared(noise.slipStd(slip));
    return Eigen::VectorXd::Constant(trial.rows(), std::sqrt(sum) / trial.rows());
  }
  const std::vector<int> group = setSpeeds(trial, noise);
  if (!isOne(group)) return {};
  const Grouped v = speedsOf(trial, group, [&](double slip) { return noise.slipStd(slip); });
  Eigen::VectorXd shared(trial.rows());
  for (int row = 0; row < trial.rows(); ++row)
    shared[row] = std::sqrt(v.mean_variance[row]) / trial.states[static_cast<std::size_t>(row)].rim_speed_mps;
  return shared;
}

void setSlip(WheelState& state, double slip) {
  if (isTied(state)) state.speed_mps = state.rim_speed_mps * (1.0 - slip);
  state.slip = slip;
}

namespace {

struct Posterior {
  double mean, variance;
};

/// Posterior of each true value under the most likely distribution of true values: a mixture of atoms whose
/// positions and weights are found by expectation maximisation. `std_at`: noise at a true value. Values with
/// a noise below half the spacing of the atoms remain as measured.
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
  for (int round = 0; round < kRounds; ++round) {  // (T10)
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

/// Posterior of true values that are normal about the means of their groups: deviations are multiplied by the
/// share of their scatter that is not error. The error of a group's mean is added to each row; that of a single
/// mean is common to all rows, as in sharedSlipStd().
std::vector<Posterior> shrunk(const Grouped& v) {
  const Eigen::ArrayXd weight = v.variance.inverse();
  const double scatter = std::max(
      0.0, (v.deviations() - v.freedom()) / (weight.sum() - weight.square().sum() / weight.sum()));  // (T11)
  std::vector<Posterior> out;
  for (Eigen::Index i = 0; i < v.value.size(); ++i) {
    const double kept = scatter / (scatter + v.variance[i]);  // (T13)
    out.push_back({v.mean[i] + kept * (v.value[i] - v.mean[i]),
                   kept * v.variance[i] + (v.groups > 1.0 ? squared(1.0 - kept) * v.mean_variance[i] : 0.0)});
  }
  return out;
}

std::vector<Posterior> slipsAtSetSpeeds(const Trial& trial, const Grouped& speeds) {
  std::vector<Posterior> slips = shrunk(speeds);
  for (std::size_t i = 0; i < slips.size(); ++i) {
    const double rim = trial.states[i].rim_speed_mps;
    slips[i] = {1.0 - slips[i].mean / rim, slips[i].variance / (rim * rim)};
  }
  return slips;
}

}  // namespace

void calibrateInputs(Trial& trial, const SensorNoise& noise, const std::optional<SetLoads>& set) {
  const auto n = trial.states.size();
  const auto slip_std = [&](double slip) { return noise.slipStd(slip); };
  const Eigen::Map<const Eigen::ArrayXd> slip(trial.slip.data(), trial.rows());
  const Grouped log_load = logLoads(trial, set ? set->group : trial.run, noise.load_relative);
  const std::vector<int> speed = setSpeeds(trial, noise);
  // The mixture converges slowly for a single level; if the scatter is mostly error, a normal distribution is
  // equally accurate.
  const auto slips =
      !speed.empty() ? slipsAtSetSpeeds(trial, speedsOf(trial, speed, slip_std))
      : !slipIsSeen(trial, noise)
          ? shrunk({slip,
                    Eigen::ArrayXd::Constant(slip.size(), slip.unaryExpr(slip_std).square().mean() + 1e-12),
                    std::vector<int>(n, 0)})
          : deconvolve(trial.slip, slip_std);
  const auto loads = set ? std::vector<Posterior>{}
                         : deconvolve({log_load.value.begin(), log_load.value.end()},
                                      [&](double) { return noise.load_relative; });
  for (std::size_t i = 0; i < n; ++i) {
    // The grid does not resolve errors below its step; the variance of precise inputs is therefore limited.
    const auto row = static_cast<Eigen::Index>(i);
    const double trust = squared(slip_std(trial.slip[i])), trust_load = squared(noise.load_relative);
    setSlip(trial.states[i], std::clamp(slips[i].mean, -1.0, 1.0));
    trial.slip_variance[row] = std::clamp(slips[i].variance, (speed.empty() ? 0.3 : 0.02) * trust, trust);
    if (set) {
      trial.states[i].load_N = set->load_N[row];
      trial.load_variance[row] = log_load.mean_variance[row];  // (T15)
      continue;
    }
    const bool far = std::abs(loads[i].mean - log_load.value[row]) > 2.5 * noise.load_relative;
    trial.states[i].load_N = far ? trial.load_N[i] : std::exp(loads[i].mean);
    trial.load_variance[row] = std::clamp(loads[i].variance, 0.3 * trust_load, trust_load);
  }
}

}  // namespace talus::terramech
