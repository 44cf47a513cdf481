#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

#include <talus/terramech/trace/covariate_tests.hpp>
#include <talus/terramech/trace/spline_basis.hpp>

namespace talus::terramech {
namespace {

/// Normal score of a chi-squared variable.
double normalScore(double chi2, int freedom) {
  const double f = 2.0 / (9.0 * freedom);
  return (std::cbrt(std::max(chi2, 0.0) / freedom) - 1.0 + f) / std::sqrt(f);
}

/// A question: columns that give, times the residual, its coordinates along orthonormal ones in the scaled
/// space where it is asked.
struct Question {
  CovariateTest test;
  Eigen::MatrixXd columns;
  double total = 0.0;  ///< squared length of the scaled residual it looks at
  int count = 0;       ///< its measured values
};

Eigen::MatrixXd without(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& nuisance) {
  if (nuisance.cols() == 0) return orthonormal(columns);
  return orthonormal(columns - nuisance * (nuisance.transpose() * columns));
}

/// Row by row, missing readings 0.
Eigen::VectorXd stacked(const Eigen::MatrixXd& residual) {
  Eigen::VectorXd all(residual.rows() * kChannels);
  for (Eigen::Index row = 0; row < residual.rows(); ++row)
    for (int c = 0; c < kChannels; ++c)
      all[row * kChannels + c] = std::isfinite(residual(row, c)) ? residual(row, c) : 0.0;
  return all;
}

class Asker {
 public:
  Asker(const Trial& trial, const Whitening& whitening, const Eigen::MatrixXd& residual, const TestPlan& plan)
      : trial_(trial),
        plan_(plan),
        whitening_(whitening),
        residual_(residual),
        white_(whitening.apply(residual)),
        marginal_(whitening.marginal(residual)),
        nuisance_white_(orthonormal(plan.nuisance_whitened)),
        nuisance_(orthonormal(plan.nuisance_marginal)) {}

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
    q.columns = whitening_.backFromMarginal(without(full, nuisance_));
    q.count = static_cast<int>(rows.size());
    for (int row : rows)
      q.total += marginal_[row * kChannels + channel] * marginal_[row * kChannels + channel];
    add(std::move(q));
  }

  void askDirection(const Direction& direction) {
    Question q;
    q.test.covariate = direction.name;
    q.columns = whitening_.backFromApply(without(direction.columns, nuisance_white_));
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

  Eigen::MatrixXd allColumns() const {
    Eigen::Index count = 0;
    for (const Question& q : questions_) count += q.columns.cols();
    Eigen::MatrixXd all(white_.size(), count);
    Eigen::Index at = 0;
    for (const Question& q : questions_) {
      all.middleCols(at, q.columns.cols()) = q.columns;
      at += q.columns.cols();
    }
    return all;
  }

  /// Less, in each channel, what the mean of its unit takes of a row: whatever signs rows are given, their
  /// units' means stay nought.
  Eigen::MatrixXd withinUnits(const Eigen::MatrixXd& columns) const;

  Eigen::MatrixXd sums(const Eigen::MatrixXd& columns, const Eigen::VectorXd& residual,
                       const std::vector<int>& group, int groups) const {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(groups, columns.cols());
    for (Eigen::Index i = 0; i < residual.size(); ++i)
      sum.row(group[static_cast<std::size_t>(i / kChannels)]) += columns.row(i) * residual[i];
    return sum;
  }

  /// Coordinates of flipped residuals, flips x all columns.
  Eigen::MatrixXd flipped(const Eigen::MatrixXd& columns) const;

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
  const Whitening& whitening_;
  const Eigen::MatrixXd& residual_;
  Eigen::VectorXd white_, marginal_;
  Eigen::MatrixXd nuisance_white_, nuisance_;
  std::vector<Question> questions_;
};

Eigen::MatrixXd Asker::withinUnits(const Eigen::MatrixXd& columns) const {
  const std::vector<int>& unit = plan_.units.unit;
  const auto cell = [&](Eigen::Index i) {
    return static_cast<Eigen::Index>(unit[static_cast<std::size_t>(i / kChannels)]) * kChannels +
           i % kChannels;
  };
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(plan_.units.count() * kChannels);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(weight.size(), columns.cols());
  const auto weightOf = [&](Eigen::Index i) {
    const auto row = i / kChannels, c = i % kChannels;
    if (whitening_.factor[static_cast<std::size_t>(row)](c, c) == 0.0) return 0.0;
    return 1.0 / (whitening_.std(row, c) * whitening_.std(row, c));
  };
  for (Eigen::Index i = 0; i < columns.rows(); ++i) {
    weight[cell(i)] += weightOf(i);
    sum.row(cell(i)) += columns.row(i);
  }
  Eigen::MatrixXd within = columns;
  for (Eigen::Index i = 0; i < columns.rows(); ++i)
    if (weight[cell(i)] > 0.0) within.row(i) -= weightOf(i) / weight[cell(i)] * sum.row(cell(i));
  return within;
}

Eigen::MatrixXd Asker::flipped(const Eigen::MatrixXd& columns) const {
  std::mt19937_64 random(plan_.seed);
  const auto signs = [&](Eigen::Index count) {
    Eigen::MatrixXd sign(plan_.flips, count);
    for (Eigen::Index flip = 0; flip < sign.rows(); ++flip) {
      std::uint64_t bits = 0;
      for (Eigen::Index k = 0; k < count; ++k) {
        if (k % 64 == 0) bits = random();
        sign(flip, k) = (bits >> (k % 64)) & 1U ? 1.0 : -1.0;
      }
    }
    return sign;
  };
  std::vector<int> row(static_cast<std::size_t>(trial_.rows()));
  std::iota(row.begin(), row.end(), 0);
  Eigen::MatrixXd products;
  if (plan_.units.unit.empty()) {
    products = signs(trial_.rows()) * sums(columns, stacked(residual_), row, trial_.rows());
  } else {
    const Eigen::MatrixXd shared = unitMeans(residual_, whitening_.std, plan_.units.unit);
    const int units = plan_.units.count();
    products =
        signs(trial_.rows()) * sums(withinUnits(columns), stacked(residual_ - shared), row, trial_.rows());
    products += signs(units) * sums(columns, stacked(shared), plan_.units.unit, units);
  }
  if (plan_.shared_error.size() == 0) return products;
  const Eigen::RowVectorXd common = stacked(plan_.shared_error).transpose() * columns;
  std::normal_distribution<double> normal;
  for (Eigen::Index flip = 0; flip < products.rows(); ++flip) products.row(flip) += normal(random) * common;
  return products;
}

std::vector<CovariateTest> Asker::answer() const {
  std::vector<CovariateTest> tests;
  if (questions_.empty()) return tests;
  const Eigen::MatrixXd columns = allColumns(), products = flipped(columns);
  const auto count = static_cast<Eigen::Index>(questions_.size());
  Eigen::ArrayXXd noise(products.rows(), count);
  for (Eigen::Index flip = 0; flip < products.rows(); ++flip) {
    const std::vector<double> z = scores(products.row(flip));
    noise.row(flip) = Eigen::Map<const Eigen::ArrayXd>(z.data(), count);
  }
  const Eigen::ArrayXd mean = noise.colwise().mean().transpose();
  const Eigen::ArrayXd std =
      ((noise.rowwise() - mean.transpose()).square().colwise().mean().sqrt() + 1e-9).transpose();
  const Eigen::ArrayXd most =
      ((noise.rowwise() - mean.transpose()).rowwise() / std.transpose()).rowwise().maxCoeff();
  const std::vector<double> raw = scores(stacked(residual_).transpose() * columns);
  for (Eigen::Index k = 0; k < count; ++k) {
    CovariateTest test = questions_[static_cast<std::size_t>(k)].test;
    test.z = (raw[static_cast<std::size_t>(k)] - mean[k]) / std[k];
    test.p_value = (1.0 + static_cast<double>((most >= test.z).count())) / (1.0 + plan_.flips);
    tests.push_back(std::move(test));
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

}  // namespace

Eigen::VectorXd covariateValues(const Trial& trial, const std::string& name,
                                const Eigen::VectorXd& sinkage_m) {
  if (name == "sinkage_m") return sinkage_m;
  Eigen::VectorXd x(trial.rows());
  for (int row = 0; row < trial.rows(); ++row)
    x[row] = trial.states[static_cast<std::size_t>(row)].covariate(name);
  return x;
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
