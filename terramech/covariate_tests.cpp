#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include <terramech/covariate_tests.hpp>
#include <terramech/spline_basis.hpp>

namespace talus::terramech {
namespace {

/// Normal score of a chi-squared variable.
double normalScore(double chi2, int freedom) {
  const double f = 2.0 / (9.0 * freedom);
  return (std::cbrt(std::max(chi2, 0.0) / freedom) - 1.0 + f) / std::sqrt(f);
}

/// A question: orthonormal columns and the residual that they are asked of.
struct Question {
  CovariateTest test;
  Eigen::MatrixXd columns;
  bool whitened = false;
  double total = 0.0;  ///< squared length of the residual it looks at
  int count = 0;       ///< its measured values
};

Eigen::MatrixXd without(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& nuisance) {
  if (nuisance.cols() == 0) return orthonormal(columns);
  return orthonormal(columns - nuisance * (nuisance.transpose() * columns));
}

class Asker {
 public:
  Asker(const Trial& trial, const Whitening& whitening, const Eigen::MatrixXd& residual, const TestPlan& plan)
      : trial_(trial),
        plan_(plan),
        white_(whitening.apply(residual)),
        marginal_(whitening.marginal(residual)),
        nuisance_white_(orthonormal(plan.nuisance_whitened)),
        nuisance_(orthonormal(plan.nuisance_marginal)) {
    if (plan.shared_error.size() == 0) return;
    shared_white_ = whitening.apply(plan.shared_error);
    shared_ = whitening.marginal(plan.shared_error);
  }

  /// A dependence within one channel on the columns given by row; centred unless it is the constant itself.
  void ask(const std::string& name, int channel, Eigen::MatrixXd by_row, bool centre) {
    const auto rows = rowsOf(channel);
    if (rows.size() < 8) return;
    Eigen::MatrixXd full = Eigen::MatrixXd::Zero(white_.size(), by_row.cols());
    for (Eigen::Index k = 0; k < by_row.cols(); ++k) {
      double mean = 0.0;
      for (int row : rows) mean += by_row(row, k) / static_cast<double>(rows.size());
      for (int row : rows) full(row * kChannels + channel, k) = by_row(row, k) - (centre ? mean : 0.0);
    }
    Question q;
    q.test.covariate = name;
    q.test.channel = channel;
    q.columns = without(full, nuisance_);
    q.count = static_cast<int>(rows.size());
    for (int row : rows)
      q.total += marginal_[row * kChannels + channel] * marginal_[row * kChannels + channel];
    add(std::move(q));
  }

  void askDirection(const Direction& direction) {
    Question q;
    q.test.covariate = direction.name;
    q.columns = without(direction.columns, nuisance_white_);
    q.whitened = true;
    q.total = white_.squaredNorm();
    q.count = static_cast<int>((trial_.measured.array().isFinite()).count());
    add(std::move(q));
  }

  std::vector<CovariateTest> answer() const;

 private:
  std::vector<int> rowsOf(int channel) const {
    std::vector<int> rows;
    for (int row = 0; row < trial_.rows(); ++row)
      if (std::isfinite(trial_.measured(row, channel))) rows.push_back(row);
    return rows;
  }

  void add(Question q) {
    if (q.columns.cols() > 0 && q.total > 0.0) questions_.push_back(std::move(q));
  }

  /// Sums over groups of column times residual, groups x all columns.
  Eigen::MatrixXd groupSums() const {
    Eigen::Index columns = 0;
    for (const Question& q : questions_) columns += q.columns.cols();
    const int groups = *std::max_element(plan_.group.begin(), plan_.group.end()) + 1;
    Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(groups, columns);
    Eigen::Index at = 0;
    for (const Question& q : questions_) {
      const Eigen::VectorXd& r = q.whitened ? white_ : marginal_;
      for (Eigen::Index i = 0; i < r.size(); ++i)
        sums.row(plan_.group[static_cast<std::size_t>(i / kChannels)]).segment(at, q.columns.cols()) +=
            q.columns.row(i) * r[i];
      at += q.columns.cols();
    }
    return sums;
  }

  /// The shared error along all columns.
  Eigen::RowVectorXd sharedProducts(Eigen::Index columns) const {
    Eigen::RowVectorXd products = Eigen::RowVectorXd::Zero(columns);
    if (shared_.size() == 0) return products;
    Eigen::Index at = 0;
    for (const Question& q : questions_) {
      products.segment(at, q.columns.cols()) = (q.whitened ? shared_white_ : shared_).transpose() * q.columns;
      at += q.columns.cols();
    }
    return products;
  }

  std::vector<double> scores(const Eigen::RowVectorXd& products) const {
    std::vector<double> z;
    Eigen::Index at = 0;
    for (const Question& q : questions_) {
      const double explained =
          std::min(products.segment(at, q.columns.cols()).squaredNorm() / q.total, 1.0 - 1e-12);
      z.push_back(normalScore(-q.count * std::log1p(-explained), static_cast<int>(q.columns.cols())));
      at += q.columns.cols();
    }
    return z;
  }

  const Trial& trial_;
  const TestPlan& plan_;
  Eigen::VectorXd white_, marginal_, shared_white_, shared_;
  Eigen::MatrixXd nuisance_white_, nuisance_;
  std::vector<Question> questions_;
};

std::vector<CovariateTest> Asker::answer() const {
  std::vector<CovariateTest> tests;
  if (questions_.empty()) return tests;
  const Eigen::MatrixXd sums = groupSums();
  const std::vector<double> observed = scores(sums.colwise().sum());
  std::mt19937_64 random(plan_.seed);
  std::vector<double> most;
  std::normal_distribution<double> normal;
  const Eigen::RowVectorXd shared = sharedProducts(sums.cols());
  Eigen::RowVectorXd sign(sums.rows());
  for (int flip = 0; flip < plan_.flips; ++flip) {
    std::uint64_t bits = 0;
    for (Eigen::Index g = 0; g < sign.size(); ++g) {
      if (g % 64 == 0) bits = random();
      sign[g] = (bits >> (g % 64)) & 1U ? 1.0 : -1.0;
    }
    const auto z = scores(sign * sums + normal(random) * shared);
    most.push_back(*std::max_element(z.begin(), z.end()));
  }
  std::sort(most.begin(), most.end());
  for (std::size_t k = 0; k < questions_.size(); ++k) {
    const auto above = most.end() - std::lower_bound(most.begin(), most.end(), observed[k]);
    tests.push_back(questions_[k].test);
    tests.back().z = observed[k];
    tests.back().p_value = (1.0 + static_cast<double>(above)) / (1.0 + plan_.flips);
  }
  std::stable_sort(tests.begin(), tests.end(),
                   [](const CovariateTest& a, const CovariateTest& b) { return a.z > b.z; });
  return tests;
}

Eigen::MatrixXd indicator(const Trial& trial, const std::string& column) {
  std::map<std::string, Eigen::Index> labels;
  for (const WheelState& s : trial.states) labels.try_emplace(std::string(s.label(column)), 0);
  Eigen::Index next = 0;
  for (auto& [label, index] : labels) index = next++;
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(trial.rows(), next);
  for (int row = 0; row < trial.rows(); ++row)
    m(row, labels[std::string(trial.states[static_cast<std::size_t>(row)].label(column))]) = 1.0;
  return m;
}

/// Intraclass correlation of groups by its one-way F statistic, as a normal score.
double withinScore(const std::vector<double>& value, const std::vector<int>& group) {
  std::map<int, std::pair<double, int>> sums;
  double mean = 0.0;
  for (std::size_t i = 0; i < value.size(); ++i) {
    auto& [sum, count] = sums[group[i]];
    sum += value[i];
    ++count;
    mean += value[i] / static_cast<double>(value.size());
  }
  double between = 0.0, total = 0.0;
  for (const auto& [key, part] : sums) between += part.second * std::pow(part.first / part.second - mean, 2);
  for (double v : value) total += (v - mean) * (v - mean);
  const auto k = static_cast<double>(sums.size()), n = static_cast<double>(value.size());
  if (n - k < 4.0 || total <= 0.0) return 0.0;
  const double excess = between / total - (k - 1.0) / (n - 1.0);
  return excess / std::sqrt(2.0 * (k - 1.0) * (n - k)) * (n - 1.0) * std::sqrt(n + 1.0);
}

}  // namespace

Eigen::VectorXd covariateValues(const Trial& trial, const std::string& name,
                                const Eigen::VectorXd& sinkage_m) {
  if (name == "sinkage_m") return sinkage_m;
  Eigen::VectorXd x(trial.rows());
  for (int row = 0; row < trial.rows(); ++row)
    x[row] = trial.states[static_cast<std::size_t>(row)].covariate(name);
  return x;
}

std::vector<int> exchangeableGroups(const Trial& trial, const Whitening& whitening,
                                    const Eigen::MatrixXd& smoothed) {
  std::map<int, int> number;
  std::vector<int> by_run, by_row;
  for (int row = 0; row < trial.rows(); ++row) {
    by_run.push_back(
        number.try_emplace(trial.run[static_cast<std::size_t>(row)], static_cast<int>(number.size()))
            .first->second);
    by_row.push_back(row);
  }
  if (static_cast<int>(number.size()) == trial.rows() || number.size() < 2) return by_row;
  double strongest = 0.0;
  for (int c = 0; c < kChannels; ++c) {
    std::vector<double> value;
    std::vector<int> group;
    for (int row = 0; row < trial.rows(); ++row) {
      if (!std::isfinite(smoothed(row, c))) continue;
      value.push_back(smoothed(row, c) / whitening.std(row, c));
      group.push_back(by_run[static_cast<std::size_t>(row)]);
    }
    if (value.size() > 8) strongest = std::max(strongest, withinScore(value, group));
  }
  return strongest > 2.4 ? by_run : by_row;
}

std::vector<CovariateTest> testCovariates(const Trial& trial, const Whitening& whitening,
                                          const Eigen::MatrixXd& residual, const Eigen::VectorXd& sinkage_m,
                                          const TestPlan& plan) {
  Asker asker{trial, whitening, residual, plan};
  std::vector<std::string> names = trial.covariates;
  names.push_back("sinkage_m");
  for (int c = 0; c < kChannels; ++c) {
    if (!trial.has(static_cast<Channel>(c))) continue;
    asker.ask("constant", c, Eigen::MatrixXd::Ones(trial.rows(), 1), false);
    for (const std::string& name : names) {
      const Eigen::VectorXd x = covariateValues(trial, name, sinkage_m);
      const auto knots = quantileKnots(x, 4);
      if (knots.size() < 2) continue;
      if (knots.size() > 2)
        asker.ask(name, c, x.unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; }), true);
      asker.ask(name, c, splineBasis(x, knots), true);
    }
    for (const std::string& column : trial.groupings) asker.ask(column, c, indicator(trial, column), true);
  }
  for (const Direction& direction : plan.directions) asker.askDirection(direction);
  return asker.answer();
}

}  // namespace talus::terramech
