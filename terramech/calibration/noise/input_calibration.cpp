#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <vector>

#include <talus/terramech/calibration/noise/input_calibration.hpp>
#include <talus/terramech/numerics/squared.hpp>

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

/// Speeds over ground with the errors due to their slips, and the mean of each group.
struct Speeds {
  Eigen::ArrayXd value, variance, mean, mean_variance;
  double groups = 0.0;

  /// Mean square of the deviations from the group means, in units of their errors.
  double scatter() const {
    const auto n = static_cast<double>(value.size());
    return ((value - mean).square() / variance).sum() / std::max(1.0, n - groups);
  }
};

Speeds speedsOf(const Trial& trial, const std::vector<int>& group,
                const std::function<double(double)>& slip_std) {
  const auto n = static_cast<Eigen::Index>(trial.states.size());
  Speeds v{Eigen::ArrayXd(n), Eigen::ArrayXd(n), Eigen::ArrayXd(n), Eigen::ArrayXd(n)};
  std::map<int, std::pair<double, double>> sums;  // of weights, and of weighted speeds
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto row = static_cast<std::size_t>(i);
    const double rim = trial.states[row].rim_speed_mps;
    v.value[i] = rim * (1.0 - trial.slip[row]);
    v.variance[i] = squared(rim * slip_std(trial.slip[row])) + squared(1e-6 * rim);
    auto& [weight, sum] = sums[group[row]];
    weight += 1.0 / v.variance[i];
    sum += v.value[i] / v.variance[i];
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& [weight, sum] = sums[group[static_cast<std::size_t>(i)]];
    v.mean[i] = sum / weight;
    v.mean_variance[i] = 1.0 / weight;
  }
  v.groups = static_cast<double>(sums.size());
  return v;
}

}  // namespace

std::vector<int> setSpeeds(const Trial& trial, const SensorNoise& noise) {
  const auto tied = std::count_if(trial.states.begin(), trial.states.end(), isTied);
  if (tied < trial.rows() || trial.rows() < 3 || !slipIsSeen(trial, noise)) return {};
  const std::vector<int> one(trial.states.size(), 0);
  for (const std::vector<int>& group : {one, trial.run}) {
    if (2 * std::set<int>(group.begin(), group.end()).size() > group.size()) continue;
    const Speeds v = speedsOf(
        trial, group, [&](double slip) { return std::min(noise.slipStd(slip), 0.1 * std::abs(slip)); });
    if (v.scatter() <= 4.0) return group;  // (T12)
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
  const Speeds v = speedsOf(trial, group, [&](double slip) { return noise.slipStd(slip); });
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

/// Posterior for normal true values with normal errors: deviations from the mean are multiplied by the share
/// of the scatter that is not error.
std::vector<Posterior> shrink(const std::vector<double>& measured, const std::vector<double>& std) {
  const auto n = static_cast<Eigen::Index>(measured.size());
  const Eigen::Map<const Eigen::ArrayXd> x(measured.data(), n), error(std.data(), n);
  const double mean = x.mean(), scatter = (x - mean).square().mean();
  const double kept = std::clamp(1.0 - error.square().mean() / (scatter + 1e-300), 0.0, 1.0);
  std::vector<Posterior> out;
  // (T11)
  for (Eigen::Index i = 0; i < n; ++i) out.push_back({mean + kept * (x[i] - mean), kept * squared(error[i])});
  return out;
}

/// Posterior slips at set speeds over ground: deviations of the speeds are multiplied by the share of their
/// scatter that is not error. The error of a run's mean is added to each row; sharedSlipStd() has the error
/// of a single mean.
std::vector<Posterior> slipsAtSetSpeeds(const Trial& trial, const std::vector<int>& group,
                                        const SensorNoise& noise) {
  const Speeds v = speedsOf(trial, group, [&](double slip) { return noise.slipStd(slip); });
  const Eigen::ArrayXd weight = v.variance.inverse();
  const double freedom = static_cast<double>(trial.rows()) - v.groups;
  const double excess = (weight * (v.value - v.mean).square()).sum() - freedom;
  const double scatter = std::max(0.0, excess / (weight.sum() - weight.square().sum() / weight.sum()));
  const bool one = isOne(group);
  std::vector<Posterior> out;
  for (Eigen::Index i = 0; i < v.value.size(); ++i) {
    const double rim = trial.states[static_cast<std::size_t>(i)].rim_speed_mps;
    const double kept = scatter / (scatter + v.variance[i]);  // (T13)
    const double own = kept * v.variance[i] + (one ? 0.0 : squared(1.0 - kept) * v.mean_variance[i]);
    out.push_back({1.0 - (v.mean[i] + kept * (v.value[i] - v.mean[i])) / rim, own / (rim * rim)});
  }
  return out;
}

}  // namespace

void calibrateInputs(Trial& trial, const SensorNoise& noise, const std::optional<NominalLoad>& set) {
  const auto n = trial.states.size();
  std::vector<double> slip_std(n), log_load(n), load_std(n, noise.load_relative);
  for (std::size_t i = 0; i < n; ++i) {
    slip_std[i] = noise.slipStd(trial.slip[i]);
    log_load[i] = std::log(trial.load_N[i]);
  }
  const std::vector<int> speed = setSpeeds(trial, noise);
  // The mixture converges slowly for a single level; if the scatter is mostly error, shrink() is equally
  // accurate.
  const auto slips = !speed.empty() ? slipsAtSetSpeeds(trial, speed, noise)
                     : !slipIsSeen(trial, noise)
                         ? shrink(trial.slip, slip_std)
                         : deconvolve(trial.slip, [&](double slip) { return noise.slipStd(slip); });
  const auto loads =
      set ? std::vector<Posterior>{} : deconvolve(log_load, [&](double) { return noise.load_relative; });
  for (std::size_t i = 0; i < n; ++i) {
    // The grid does not resolve errors below its step; the variance of precise inputs is therefore limited.
    const auto row = static_cast<Eigen::Index>(i);
    const double trust = squared(slip_std[i]), trust_load = squared(load_std[i]);
    setSlip(trial.states[i], std::clamp(slips[i].mean, -1.0, 1.0));
    trial.slip_variance[row] = std::clamp(slips[i].variance, (speed.empty() ? 0.3 : 0.02) * trust, trust);
    if (set) {
      trial.states[i].load_N = set->load_N(static_cast<int>(i), trial.load_N[i]);
      trial.load_variance[row] = (1.0 - set->error_share + 1.0 / set->rows[row]) * trust_load;  // (T15)
      continue;
    }
    trial.states[i].load_N =
        std::abs(loads[i].mean - log_load[i]) > 2.5 * load_std[i] ? trial.load_N[i] : std::exp(loads[i].mean);
    trial.load_variance[row] = std::clamp(loads[i].variance, 0.3 * trust_load, trust_load);
  }
}

}  // namespace talus::terramech
