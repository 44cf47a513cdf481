#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <talus/terramech/calibration/noise/nominal_load.hpp>

namespace talus::terramech {
namespace {

/// Greatest relative scatter of readings of one set load, and least relative distance of levels: load cells
/// have errors below 10 %.
constexpr double kLevel = 0.1;

struct Groups {
  std::vector<int> of_row;
  int count = 0;
};

Eigen::VectorXd logLoads(const Trial& trial) {
  Eigen::VectorXd x(trial.rows());
  for (int row = 0; row < trial.rows(); ++row) x[row] = std::log(trial.load_N[static_cast<std::size_t>(row)]);
  return x;
}

Groups byRun(const Trial& trial) {
  std::map<int, int> number;
  Groups g;
  for (int run : trial.run)
    g.of_row.push_back(number.try_emplace(run, static_cast<int>(number.size())).first->second);
  g.count = static_cast<int>(number.size());
  return g;
}

Groups byLevel(const Eigen::VectorXd& x) {
  std::vector<int> order(static_cast<std::size_t>(x.size()));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return x[a] < x[b]; });
  Groups g{std::vector<int>(order.size()), 1};
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k > 0 && x[order[k]] - x[order[k - 1]] > kLevel) ++g.count;
    g.of_row[static_cast<std::size_t>(order[k])] = g.count - 1;
  }
  return g;
}

Eigen::VectorXd sizes(const Groups& g) {
  Eigen::VectorXd n = Eigen::VectorXd::Zero(g.count);
  for (int of : g.of_row) n[of] += 1.0;
  return n;
}

/// Means over the groups; NaN is ignored.
Eigen::VectorXd means(const Groups& g, const Eigen::VectorXd& x) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(g.count), n = sum;
  for (Eigen::Index row = 0; row < x.size(); ++row)
    if (std::isfinite(x[row])) {
      sum[g.of_row[static_cast<std::size_t>(row)]] += x[row];
      n[g.of_row[static_cast<std::size_t>(row)]] += 1.0;
    }
  return sum.cwiseQuotient(n.cwiseMax(1.0));
}

Eigen::VectorXd centred(const Groups& g, const Eigen::VectorXd& x) {
  const Eigen::VectorXd mean = means(g, x);
  Eigen::VectorXd out = x;
  for (Eigen::Index row = 0; row < x.size(); ++row) out[row] -= mean[g.of_row[static_cast<std::size_t>(row)]];
  return out;
}

/// True if the rows have set loads: at least four rows per group on average, and a scatter below kLevel in
/// each group.
bool areSet(const Groups& g, const Eigen::VectorXd& deviation) {
  if (static_cast<Eigen::Index>(4 * g.count) > deviation.size()) return false;
  const Eigen::VectorXd square = means(g, deviation.cwiseAbs2());
  return square.maxCoeff() < kLevel * kLevel && square.maxCoeff() > 0.0;
}

struct Share {
  double value = 0.0, std = 0.0;
};

Share shareOf(const Groups& g, const Eigen::VectorXd& deviation, const Eigen::MatrixXd& residual,
              const InputSlopes& slopes) {
  double product = 0.0, square = 0.0;
  for (Eigen::Index c = 0; c < residual.cols(); ++c) {
    const auto there = residual.col(c).array().isFinite();
    if (there.count() < 8) continue;
    const Eigen::VectorXd own = centred(g, residual.col(c));
    const Eigen::VectorXd moved =
        centred(g, there.select(-slopes.by_load.col(c).cwiseProduct(deviation), std::nan("")));
    const double variance =
        there.select(own.array().square(), 0.0).sum() / static_cast<double>(there.count());
    if (!(variance > 0.0)) continue;
    product += there.select(own.array() * moved.array(), 0.0).sum() / variance;
    square += there.select(moved.array().square(), 0.0).sum() / variance;
  }
  // (T14)
  return square > 0.0 ? Share{product / square, 1.0 / std::sqrt(square)} : Share{0.0, 1.0};
}

}  // namespace

double NominalLoad::errorStd() const {
  return scatter * std::sqrt(error_share);
}

double NominalLoad::load_N(int row, double measured_N) const {
  const double deviation = std::log(measured_N) - log_mean[row];
  return std::exp(log_mean[row] + (1.0 - error_share) * deviation);  // (T15)
}

std::optional<NominalLoad> nominalLoad(const Trial& trial, const Eigen::MatrixXd& residual,
                                       const InputSlopes& slopes) {
  constexpr double kKnown = 0.25;
  if (!trial.moment.empty()) return {};
  const Eigen::VectorXd x = logLoads(trial);
  for (const Groups& g : {byRun(trial), byLevel(x)}) {
    const Eigen::VectorXd deviation = centred(g, x);
    if (!areSet(g, deviation)) continue;
    const Share share = shareOf(g, deviation, residual, slopes);
    if (share.std > kKnown || share.value < 2.0 * share.std) return {};
    const Eigen::VectorXd mean = means(g, x), size = sizes(g);
    NominalLoad found{Eigen::VectorXd(trial.rows()), Eigen::VectorXd(trial.rows())};
    for (int row = 0; row < trial.rows(); ++row) {
      found.log_mean[row] = mean[g.of_row[static_cast<std::size_t>(row)]];
      found.rows[row] = size[g.of_row[static_cast<std::size_t>(row)]];
    }
    found.error_share = share.value + 2.0 * share.std > 1.0 ? 1.0 : share.value;
    found.scatter = std::sqrt(deviation.squaredNorm() / (trial.rows() - g.count));
    return found;
  }
  return {};
}

}  // namespace talus::terramech
