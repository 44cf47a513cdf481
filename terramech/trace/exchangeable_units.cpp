#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <talus/terramech/trace/exchangeable_units.hpp>
#include <talus/terramech/trace/spline_basis.hpp>

namespace talus::terramech {
namespace {

/// Share of a column's scatter that lies between runs above which a run is said to fix it.
constexpr double kFixedByRun = 0.5;

/// The values of one channel that are there, over their standard deviations.
struct Values {
  std::vector<int> row;
  std::vector<double> value;
};

Values valuesOf(const Eigen::MatrixXd& residual, const Whitening& whitening, int channel) {
  Values v;
  for (int row = 0; row < residual.rows(); ++row) {
    if (!std::isfinite(residual(row, channel))) continue;
    v.row.push_back(row);
    v.value.push_back(residual(row, channel) / whitening.std(row, channel));
  }
  return v;
}

/// Scatter of values about the means of their groups.
struct Scatter {
  double between = 0.0, total = 0.0;
  int groups = 0, count = 0;
};

Scatter scatterOf(const std::vector<double>& value, const std::vector<int>& group) {
  std::map<int, std::pair<double, int>> sums;
  double mean = 0.0;
  for (std::size_t i = 0; i < value.size(); ++i) {
    auto& [sum, count] = sums[group[i]];
    sum += value[i];
    ++count;
    mean += value[i] / static_cast<double>(value.size());
  }
  Scatter s{.groups = static_cast<int>(sums.size()), .count = static_cast<int>(value.size())};
  for (const auto& [key, part] : sums)
    s.between += part.second * std::pow(part.first / part.second - mean, 2);
  for (double v : value) s.total += (v - mean) * (v - mean);
  return s;
}

/// Normal score of a scatter between groups of which a fit has taken `spent` degrees of freedom.
double betweenScore(const Scatter& s, int spent) {
  const double k = s.groups - spent, n = s.count - spent;
  if (n - k < 4.0 || k < 2.0 || s.total <= 0.0) return 0.0;
  const double excess = s.between / s.total - (k - 1.0) / (n - 1.0);
  return excess / std::sqrt(2.0 * (k - 1.0) * (n - k)) * (n - 1.0) * std::sqrt(n + 1.0);
}

std::vector<int> at(const std::vector<int>& of_row, const std::vector<int>& rows) {
  std::vector<int> part;
  for (int row : rows) part.push_back(of_row[static_cast<std::size_t>(row)]);
  return part;
}

Eigen::VectorXd columnAt(const Trial& trial, const std::string& name, const std::vector<int>& rows) {
  Eigen::VectorXd x(static_cast<Eigen::Index>(rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double v = trial.states[static_cast<std::size_t>(rows[i])].covariate(name);
    x[static_cast<Eigen::Index>(i)] = std::isfinite(v) ? v : 0.0;
  }
  return x;
}

/// What parabolas in columns leave of values.
std::vector<double> withoutParabolas(const std::vector<double>& value,
                                     const std::vector<Eigen::VectorXd>& columns) {
  const auto n = static_cast<Eigen::Index>(value.size());
  Eigen::MatrixXd basis(n, 1 + 2 * static_cast<Eigen::Index>(columns.size()));
  basis.col(0).setOnes();
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const Eigen::VectorXd& x = columns[k];
    const double low = x.minCoeff(), span = std::max(x.maxCoeff() - low, 1e-300);
    const auto at = 1 + 2 * static_cast<Eigen::Index>(k);
    basis.col(at) = (x.array() - low) / span;
    basis.col(at + 1) = basis.col(at).array().square();
  }
  const Eigen::MatrixXd q = orthonormal(basis);
  const Eigen::Map<const Eigen::VectorXd> v(value.data(), n);
  const Eigen::VectorXd left = v - q * (q.transpose() * v);
  return {left.data(), left.data() + left.size()};
}

std::vector<int> runsFromZero(const Trial& trial) {
  std::map<int, int> number;
  std::vector<int> run;
  for (int r : trial.run) run.push_back(number.try_emplace(r, static_cast<int>(number.size())).first->second);
  return run;
}

std::vector<std::string> fixedByRun(const Trial& trial, const std::vector<int>& run) {
  std::vector<int> all(run.size());
  std::iota(all.begin(), all.end(), 0);
  std::vector<std::string> fixed;
  for (const std::string& name : trial.covariates) {
    const Eigen::VectorXd x = columnAt(trial, name, all);
    const Scatter s = scatterOf({x.data(), x.data() + x.size()}, run);
    if (s.between > kFixedByRun * s.total) fixed.push_back(name);
  }
  return fixed;
}

/// How much more the means of runs scatter than their rows allow. Parabolas in columns that runs fix are
/// taken out one after another while four runs are to spare; what they explain to the end is no offset.
double runScore(const Values& v, const std::vector<int>& run, const Trial& trial,
                const std::vector<std::string>& fixed) {
  const std::vector<int> group = at(run, v.row);
  const Scatter whole = scatterOf(v.value, group);
  const double score = betweenScore(whole, 0);
  std::vector<Eigen::VectorXd> open, taken;
  for (const std::string& name : fixed) open.push_back(columnAt(trial, name, v.row));
  while (!open.empty() && whole.groups - 2 * static_cast<int>(taken.size() + 1) > 4) {
    std::size_t best = 0;
    double least = 0.0;
    Scatter left;
    for (std::size_t k = 0; k < open.size(); ++k) {
      taken.push_back(open[k]);
      const Scatter s = scatterOf(withoutParabolas(v.value, taken), group);
      taken.pop_back();
      if (k == 0 || s.between < least) best = k, least = s.between, left = s;
    }
    taken.push_back(open[best]);
    open.erase(open.begin() + static_cast<long>(best));
    if (betweenScore(left, 2 * static_cast<int>(taken.size())) < 1.0) return 0.0;
  }
  return score;
}

std::vector<int> byTime(const Trial& trial) {
  std::vector<int> order(trial.states.size());
  std::iota(order.begin(), order.end(), 0);
  const auto time = [&](int row) { return trial.states[static_cast<std::size_t>(row)].time_s; };
  if (std::all_of(order.begin(), order.end(), [&](int row) { return std::isfinite(time(row)); }))
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return time(a) < time(b); });
  return order;
}

/// Correlation of neighbours `lag` apart.
double autocorrelation(const std::vector<double>& value, int lag) {
  double product = 0.0, square = 0.0;
  for (std::size_t i = 0; i < value.size(); ++i) {
    square += value[i] * value[i];
    if (i >= static_cast<std::size_t>(lag)) product += value[i] * value[i - static_cast<std::size_t>(lag)];
  }
  return square > 0.0 ? product / square : 0.0;
}

/// Values of a channel along time.
std::vector<double> series(const Eigen::MatrixXd& residual, const Whitening& whitening, int channel,
                           const std::vector<int>& order) {
  std::vector<double> value;
  for (int row : order)
    if (std::isfinite(residual(row, channel)))
      value.push_back(residual(row, channel) / whitening.std(row, channel));
  return value;
}

/// Lag from which a channel no longer correlates; 0: neighbours do not.
int memory(const std::vector<double>& smooth, const std::vector<double>& raw) {
  const auto n = static_cast<double>(smooth.size());
  const double one = autocorrelation(smooth, 1);
  const double three = one + autocorrelation(smooth, 2) + autocorrelation(smooth, 3);
  if (n < 20.0 || std::max(one, three / std::sqrt(3.0)) * std::sqrt(n) < 3.2) return 0;
  const Eigen::VectorXd when = Eigen::VectorXd::LinSpaced(static_cast<Eigen::Index>(raw.size()), 0.0, 1.0);
  const std::vector<double> left = withoutParabolas(raw, {when});
  int lag = 1;
  while (4 * lag < static_cast<int>(n) && autocorrelation(left, lag) > 1.5 / std::sqrt(n)) ++lag;
  return lag;
}

/// Whether what sets the contact follows time: what the model lacks then lasts as noise might.
bool isInOrder(const Trial& trial, const std::vector<int>& order) {
  for (const char* name : {"slip", "load_N", "slip_angle_rad", "slope_rad", "speed_mps", "pass_index"}) {
    if (std::find(trial.covariates.begin(), trial.covariates.end(), name) == trial.covariates.end()) continue;
    Eigen::VectorXd x = columnAt(trial, name, order);
    x.array() -= x.mean();
    if (autocorrelation({x.data(), x.data() + x.size()}, 1) > 0.3) return true;
  }
  return false;
}

ExchangeableUnits stretchesOfTime(const Trial& trial, const Whitening& whitening,
                                  const Eigen::MatrixXd& residual) {
  const std::vector<int> order = byTime(trial);
  if (isInOrder(trial, order)) return {};
  const Eigen::MatrixXd smooth = withoutSmooth(trial, residual, trial.covariates);
  std::vector<std::string> others;
  for (const std::string& name : trial.covariates)
    if (name != "time_s") others.push_back(name);
  const Eigen::MatrixXd without_time = withoutSmooth(trial, residual, others);
  int longest = 0;
  for (int c = 0; c < kChannels; ++c)
    longest = std::max(
        longest, memory(series(smooth, whitening, c, order), series(without_time, whitening, c, order)));
  if (longest == 0) return {};
  ExchangeableUnits units{std::vector<int>(order.size()), false, without_time};
  const int length = std::max(2, 2 * longest), count = std::max(1, trial.rows() / length);
  for (std::size_t k = 0; k < order.size(); ++k)
    units.unit[static_cast<std::size_t>(order[k])] =
        static_cast<int>(k * static_cast<std::size_t>(count) / order.size());
  return units;
}

}  // namespace

int ExchangeableUnits::count() const {
  return unit.empty() ? 0 : *std::max_element(unit.begin(), unit.end()) + 1;
}

ExchangeableUnits exchangeableUnits(const Trial& trial, const Whitening& whitening,
                                    const Eigen::MatrixXd& residual) {
  const std::vector<int> run = runsFromZero(trial);
  const int runs = *std::max_element(run.begin(), run.end()) + 1;
  if (runs > 1 && runs < trial.rows()) {
    const std::vector<std::string> fixed = fixedByRun(trial, run);
    std::vector<std::string> others;
    for (const std::string& name : trial.covariates)
      if (std::find(fixed.begin(), fixed.end(), name) == fixed.end()) others.push_back(name);
    const Eigen::MatrixXd left = withoutSmooth(trial, residual, others);
    double strongest = 0.0;
    for (int c = 0; c < kChannels; ++c) {
      const Values v = valuesOf(left, whitening, c);
      if (v.value.size() > 8) strongest = std::max(strongest, runScore(v, run, trial, fixed));
    }
    if (strongest > 2.4) return {run, true, left};
  }
  return stretchesOfTime(trial, whitening, residual);
}

Eigen::MatrixXd unitMeans(const Eigen::MatrixXd& residual, const Eigen::MatrixXd& std,
                          const std::vector<int>& unit) {
  const int units = *std::max_element(unit.begin(), unit.end()) + 1;
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(units, residual.cols()), weight = sum, mean = residual;
  for (Eigen::Index row = 0; row < residual.rows(); ++row)
    for (Eigen::Index c = 0; c < residual.cols(); ++c) {
      if (!std::isfinite(residual(row, c))) continue;
      const double w = 1.0 / (std(row, c) * std(row, c));
      sum(unit[static_cast<std::size_t>(row)], c) += w * residual(row, c);
      weight(unit[static_cast<std::size_t>(row)], c) += w;
    }
  for (Eigen::Index row = 0; row < residual.rows(); ++row)
    for (Eigen::Index c = 0; c < residual.cols(); ++c) {
      const int u = unit[static_cast<std::size_t>(row)];
      mean(row, c) = std::isfinite(residual(row, c)) && weight(u, c) > 0.0 ? sum(u, c) / weight(u, c) : 0.0;
    }
  return mean;
}

}  // namespace talus::terramech
