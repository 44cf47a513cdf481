#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>
#include <random>
#include <set>

#include <Eigen/Dense>

#include <talus/common/common.hpp>
#include <talus/terramech/calibration/noise/run_likelihood.hpp>
#include <talus/terramech/calibration/trace/formula_trace.hpp>

namespace talus::terramech {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

struct Column {
  std::string name;
  VectorXd values;
  bool cause = true;  ///< false: an answer, or the integral of one
};

/// Rows of a regression, and the run number of each row.
struct Rows {
  std::vector<Column> columns;
  std::vector<int> run;

  const VectorXd* find(const std::string& name) const {
    const auto at = std::ranges::find(columns, name, &Column::name);
    return at == columns.end() ? nullptr : &at->values;
  }
};

/// Adds a column with the value 1 for the rows with a text; of two texts one.
void addTexts(Rows& rows, const Telemetry::Words& column, const std::vector<std::size_t>& at) {
  std::map<std::string, VectorXd> is;
  for (std::size_t k = 0; k < at.size(); ++k)
    is.try_emplace(column.values[at[k]], VectorXd::Zero(std::ssize(at)))
        .first->second[static_cast<Index>(k)] = 1.0;
  if (is.size() == 2) is.erase(is.begin());
  if (column.name == "run" || is.size() > 12) return;
  for (const auto& [text, values] : is) rows.columns.push_back({column.name + "=" + text, values});
}

/// Integrals over one run, whose rows `at` are in the order of time.
std::map<std::string, double> integralsOf(const Telemetry& table, const std::vector<std::size_t>& at) {
  std::map<std::string, double> sum;
  for (std::size_t k = 1; k < at.size(); ++k) {
    const auto value = [&](const char* name, double of_next, double of_last) {
      const auto* column = table.find(name);
      return column ? of_next * (*column)[at[k]] + of_last * (*column)[at[k - 1]] : std::nan("");
    };
    const auto change = [&](const char* name) { return value(name, 1.0, -1.0); };
    const auto mean = [&](const char* name) { return value(name, 0.5, 0.5); };
    const double seconds = change("time_s"), step_m = std::hypot(change("x_m"), change("y_m"));
    sum["time_s"] += seconds;
    sum["distance_m"] += step_m;
    sum["height_m"] += table.find("z_m") ? change("z_m") : std::sin(mean("pitch_rad")) * step_m;
    sum["turning_rad"] += std::abs(std::remainder(change("heading_rad"), 2.0 * std::numbers::pi));
    sum["cross_slope_m"] += std::abs(std::sin(mean("roll_rad"))) * step_m;
    for (const auto& [name, values] : table.numbers)
      if (const auto& known = knownTelemetryColumns();
          name == "speed_mps" || std::ranges::find(known, name) == known.end())
        sum[name.ends_with("_A")   ? "charge_As"
            : name.ends_with("_W") ? "energy_J"
                                   : name + "_s"] += mean(name.c_str()) * seconds;
  }
  return sum;
}

/// Rows of a table as they are, or one row for each run of a table of sequences over time.
Rows rowsOf(const Telemetry& table, bool integrate) {
  Rows rows;
  const auto* label = table.findWords("run");
  std::map<std::string, int> number;
  std::vector<std::vector<std::size_t>> of_run;
  std::vector<std::size_t> first;
  for (std::size_t row = 0; row < table.size(); ++row) {
    const auto [at, fresh] =
        number.try_emplace(label ? (*label)[row] : std::to_string(row), std::ssize(of_run));
    if (fresh) of_run.emplace_back();
    of_run[static_cast<std::size_t>(at->second)].push_back(row);
    if (fresh || !integrate) first.push_back(row), rows.run.push_back(at->second);
  }
  if (!integrate)
    for (const auto& [name, values] : table.numbers)
      rows.columns.push_back({name, Eigen::Map<const VectorXd>(values.data(), std::ssize(values))});
  for (std::size_t k = 0; integrate && k < of_run.size(); ++k) {
    std::ranges::stable_sort(of_run[k], {}, [&](std::size_t row) { return table.at("time_s")[row]; });
    for (const auto& [name, value] : integralsOf(table, of_run[k])) {
      if (!rows.find(name))
        rows.columns.push_back({name, VectorXd::Constant(std::ssize(of_run), std::nan("")),
                                name != "charge_As" && name != "energy_J"});
      std::ranges::find(rows.columns, name, &Column::name)->values[static_cast<Index>(k)] = value;
    }
  }
  for (const auto& column : table.words) addTexts(rows, column, first);
  return rows;
}

/// Expression that is linear in its parameters: coefficient of each parameter; "" for the constant.
using Linear = std::map<std::string, VectorXd>;

void add(Linear& all, const Linear& other, double sign) {
  for (const auto& [name, values] : other)
    if (const auto [at, fresh] = all.try_emplace(name, sign * values); !fresh) at->second += sign * values;
}

bool isConstant(const Linear& all) {
  return all.size() == 1 && all.begin()->first.empty();
}

/// Recursive descent: sums of products of factors [-] atom [^ atom]; an atom is a number, a name or (sum).
class FormulaReader {
 public:
  FormulaReader(const std::string& text, const Rows& rows) : text_(text), rows_(rows) {}

  Linear read() {
    const Linear all = sum();
    if (next() != '\0') fail("has a sign that is not read: " + text_.substr(at_));
    return all;
  }

  std::set<std::string> columns;  ///< columns that the formula contains

  [[noreturn]] void fail(const std::string& reason) const {
    std::string known;
    for (const Column& c : rows_.columns) known += (known.empty() ? "" : ", ") + c.name;
    throw InputError(
        {"--formula '" + text_ + "'", reason, "write ANSWER = a*COLUMN + b*COLUMN, of " + known});
  }

 private:
  char next() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  bool take(char sign) { return next() == sign && ++at_; }
  Linear sum() {
    Linear all = product();
    for (char sign = next(); sign == '+' || sign == '-'; sign = next()) {
      ++at_;
      add(all, product(), sign == '+' ? 1.0 : -1.0);
    }
    return all;
  }

  Linear product() {
    Linear all = factor();
    for (char sign = next(); sign == '*' || sign == '/'; sign = next()) {
      ++at_;
      Linear other = factor();
      if (sign == '*' && isConstant(all)) std::swap(all, other);
      if (!isConstant(other))
        fail("is not linear in its parameters: " + all.rbegin()->first + " with " + other.rbegin()->first);
      for (auto& [name, values] : all) values.array() *= other[""].array().pow(sign == '*' ? 1.0 : -1.0);
    }
    return all;
  }

  Linear factor() {
    Linear base;
    if (take('-')) return add(base, factor(), -1.0), base;
    base = atom();
    if (!take('^')) return base;
    Linear power = atom();
    if (!isConstant(base) || !isConstant(power))
      fail("is not linear in its parameters: it has a power of one");
    base[""] = base[""].array().pow(power[""].array());
    return base;
  }

  Linear atom() {
    if (take('(')) {
      if (++depth_ > 1000) fail("has more than 1000 parentheses");
      const Linear inside = sum();
      if (!take(')')) fail("lacks a closing parenthesis");
      return inside;
    }
    const char* start = (next(), text_.c_str() + at_);
    char* end = nullptr;
    const double value = std::strtod(start, &end);
    if (end != start && !std::isalpha(static_cast<unsigned char>(*start))) {
      at_ += static_cast<std::size_t>(end - start);
      return {{"", VectorXd::Constant(std::ssize(rows_.run), value)}};
    }
    while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) || text_[at_] == '_'))
      ++at_;
    const std::string name(start, text_.c_str() + at_);
    if (name.empty()) fail("lacks a name or number at its character " + std::to_string(at_ + 1));
    const VectorXd* column = rows_.find(name);
    if (!column) return {{name, VectorXd::Ones(std::ssize(rows_.run))}};
    columns.insert(name);
    return {{"", *column}};
  }

  const std::string& text_;
  const Rows& rows_;
  std::size_t at_ = 0, depth_ = 0;
};

/// Ratios of the variance of an error that a run shares to that of single rows.
constexpr double kRatios[] = {0.0, 0.05, 0.15, 0.5, 1.5, 5.0, 15.0, 50.0};

/// Search for the columns that a base lacks, by normal regression on rows whose runs share an error.
class FormulaSearch {
 public:
  FormulaSearch(const VectorXd& answer, const Rows& rows, const MatrixXd& base,
                const std::vector<Column>& candidates, const TraceOptions& options)
      : answer_(answer), run_(rows.run), base_(base), candidates_(candidates), options_(options) {
    added_.resize(answer.size(), std::ssize(candidates_));
    for (Index j = 0; j < added_.cols(); ++j) added_.col(j) = candidates_[static_cast<std::size_t>(j)].values;
    size_.resize(static_cast<std::size_t>(*std::ranges::max_element(run_)) + 1);
    for (const int r : run_) size_[static_cast<std::size_t>(r)] += 1.0;
    ratios_ = size_.size() < run_.size() ? std::size(kRatios) : 1;
  }

  bool hasRuns() const { return ratios_ > 1; }

  /// Returns columns whose errors are independent with equal variance, for one ratio.
  MatrixXd whitened(const MatrixXd& columns, double ratio) const {
    MatrixXd mean = MatrixXd::Zero(std::ssize(size_), columns.cols()), out = columns;
    for (Index row = 0; row < columns.rows(); ++row) mean.row(runOf(row)) += columns.row(row) / count(row);
    for (Index row = 0; row < columns.rows(); ++row)
      out.row(row) -= (1.0 - 1.0 / std::sqrt(1.0 + ratio * count(row))) * mean.row(runOf(row));
    return out;
  }

  /// Log-evidence that each candidate gains over a base, for each table (column of `tables`). Sets `ratio` to the
  /// most likely one of the base on the first table.
  MatrixXd gains(const MatrixXd& tables, const MatrixXd& base, double& ratio) const {
    const double g = static_cast<double>(size_.size()),
                 freedom = static_cast<double>(tables.rows() - base.cols());
    Eigen::RowVectorXd alone = Eigen::RowVectorXd::Constant(tables.cols(), -1e300);
    MatrixXd with = MatrixXd::Constant(added_.cols(), tables.cols(), -1e300);
    for (std::size_t k = 0; k < ratios_; ++k) {
      const Eigen::HouseholderQR<MatrixXd> qr(whitened(base, kRatios[k]));
      const MatrixXd q = qr.householderQ() * MatrixXd::Identity(base.rows(), base.cols());
      const auto remainder = [&](const MatrixXd& m) {
        const MatrixXd white = whitened(m, kRatios[k]);
        return MatrixXd(white - q * (q.transpose() * white));
      };
      double constant = -qr.matrixQR().diagonal().array().abs().log().sum();
      for (const double n : size_) constant -= 0.5 * std::log(1.0 + kRatios[k] * n);
      const MatrixXd left = remainder(tables);
      MatrixXd direction = remainder(added_);
      for (Index j = 0; j < added_.cols(); ++j) {
        const double norm = direction.col(j).norm();
        direction.col(j) *= norm > 1e-6 * added_.col(j).norm() ? 1.0 / norm : 0.0;
      }
      const Eigen::RowVectorXd squares = left.colwise().squaredNorm().cwiseMax(1e-300);
      const Eigen::RowVectorXd own = constant - 0.5 * freedom * squares.array().log();
      const MatrixXd explained =
          (direction.transpose() * left).cwiseAbs2() * squares.cwiseInverse().asDiagonal();
      const MatrixXd gain = 0.5 * (freedom - 1.0) * std::log1p(g) -
                            0.5 * freedom * (g * (1.0 - explained.array()).max(0.0)).log1p();  // (T60)
      if (own[0] > alone[0]) ratio = kRatios[k];
      alone = alone.cwiseMax(own);
      with = with.cwiseMax(gain.rowwise() + own);
    }
    return with.rowwise() - alone;
  }

  struct Fit {
    VectorXd value{}, std{};  // of the parameters
    double rmse = 0.0, held_rmse = 0.0, scatter = 0.0;
  };

  /// Fits columns with uniform priors, and predicts each run from the others.
  Fit fit(const MatrixXd& columns, double ratio) const {
    const MatrixXd x = whitened(columns, ratio);
    const VectorXd y = whitened(answer_, ratio);
    const MatrixXd square = x.transpose() * x, inverse = square.inverse();
    const double n = static_cast<double>(y.size());
    Fit f{inverse * (x.transpose() * y)};
    f.scatter = (y - x * f.value).norm() / std::sqrt(n - static_cast<double>(x.cols()));
    f.std = f.scatter * inverse.diagonal().cwiseSqrt();
    f.rmse = (answer_ - columns * f.value).norm() / std::sqrt(n);
    std::vector<std::vector<Index>> rows(size_.size());
    for (Index row = 0; row < y.size(); ++row) rows[static_cast<std::size_t>(runOf(row))].push_back(row);
    for (const auto& held : rows) {
      const MatrixXd own = x(held, Eigen::all);
      const VectorXd value =
          (square - own.transpose() * own).ldlt().solve(x.transpose() * y - own.transpose() * y(held));
      f.held_rmse += (answer_(held) - columns(held, Eigen::all) * value).squaredNorm();
    }
    f.held_rmse = std::sqrt(f.held_rmse / n);
    return f;
  }

  /// Returns the answer, and tables of errors alone.
  MatrixXd tables(double ratio) const {
    std::mt19937_64 random(options_.seed);
    std::normal_distribution<double> normal;
    MatrixXd all(answer_.size(), 1 + options_.draws);
    all.col(0) = answer_;
    for (Index t = 1; t <= options_.draws; ++t) {
      VectorXd of_run(std::ssize(size_));
      for (double& v : of_run) v = std::sqrt(ratio) * normal(random);
      for (Index row = 0; row < all.rows(); ++row) all(row, t) = of_run[runOf(row)] + normal(random);
    }
    return all;
  }

  MatrixXd baseWith(const std::vector<Index>& chosen) const {
    return (MatrixXd(base_.rows(), base_.cols() + std::ssize(chosen)) << base_, added_(Eigen::all, chosen))
        .finished();
  }

  /// Gains of all candidates beside `chosen`, and their distribution on drawn tables.
  struct Scan {
    VectorXd gain;
    GainDistribution noise;
    double ratio = 0.0;  ///< of the variances of runs and rows, without a candidate
    Index best = 0;
  };

  Scan scan(const std::vector<Index>& chosen) const {
    Scan s;
    gains(answer_, baseWith(chosen), s.ratio);
    const MatrixXd gain = gains(tables(s.ratio), baseWith(chosen), s.ratio);
    s.gain = gain.col(0);
    s.gain.maxCoeff(&s.best);
    for (Index t = 1; t < gain.cols(); ++t) s.noise.greatest.push_back(gain.col(t).maxCoeff());
    std::ranges::sort(s.noise.greatest);
    return s;
  }

  /// Accepts the best candidate, and exchanges earlier ones, until nothing gains more.
  std::vector<Index> search() const {
    std::vector<Index> chosen;
    const Index most = std::min<Index>(options_.max_effects, base_.rows() - base_.cols() - 3);
    while (std::ssize(chosen) < most) {
      const Scan s = scan(chosen);
      if (!(s.gain[s.best] > std::max(0.0, s.noise.threshold(options_.significance)))) return chosen;
      chosen.push_back(s.best);
      for (std::size_t k = 0; k < chosen.size();) {
        const Scan in_place = scan(without(chosen, k));
        const bool gains_more = in_place.gain[in_place.best] > in_place.gain[chosen[k]] + 1e-9;
        if (gains_more) chosen[k] = in_place.best;
        k = gains_more ? 0 : k + 1;
      }
    }
    return chosen;
  }

  static std::vector<Index> without(std::vector<Index> chosen, std::size_t k) {
    chosen.erase(chosen.begin() + static_cast<std::ptrdiff_t>(k));
    return chosen;
  }

  const std::string& nameOf(Index j) const { return candidates_[static_cast<std::size_t>(j)].name; }

 private:
  Index runOf(Index row) const { return run_[static_cast<std::size_t>(row)]; }
  double count(Index row) const { return size_[static_cast<std::size_t>(runOf(row))]; }

  const VectorXd& answer_;
  const std::vector<int>& run_;
  const MatrixXd& base_;
  const std::vector<Column>& candidates_;
  const TraceOptions& options_;
  MatrixXd added_;
  std::vector<double> size_;
  std::size_t ratios_ = 1;
};

void requireWhole(const Column& c) {
  for (Index row = 0; row < c.values.size(); ++row)
    if (!std::isfinite(c.values[row]))
      throw InputError({"--formula", "column " + c.name + " has no value in row " + std::to_string(row + 1),
                        "leave the row or the column out"});
}

/// Candidates: columns that vary, are complete, and are not multiples of the answer.
std::vector<Column> candidatesOf(const Rows& rows, const std::set<std::string>& used,
                                 const VectorXd& answer) {
  std::vector<Column> all;
  for (const Column& c : rows.columns) {
    if (!c.cause || used.contains(c.name) || !c.values.array().isFinite().any()) continue;
    requireWhole(c);
    const VectorXd x = c.values.array() - c.values.mean(), y = answer.array() - answer.mean();
    const bool copy = std::pow(x.dot(y), 2) > (1.0 - 1e-6) * x.squaredNorm() * y.squaredNorm();
    if (x.norm() > 1e-9 * c.values.norm() && !copy) all.push_back(c);
  }
  if (!used.contains("constant")) all.push_back({"constant", VectorXd::Ones(answer.size())});
  return all;
}

/// Writes the parameters, the effects with their alternatives, and the errors.
void describe(const FormulaSearch& search, const Linear& model, const MatrixXd& base, FormulaTrace& trace) {
  const std::vector<Index> chosen = search.search();
  const auto last = search.scan(chosen), first = search.scan({});
  const auto before = search.fit(base, first.ratio), after = search.fit(search.baseWith(chosen), last.ratio);
  Index at = 0;
  for (const auto& [name, column] : model) {
    if (name.empty()) continue;
    trace.parameters.push_back({name, {after.value[at], after.std[at]}});
    ++at;
  }
  for (std::size_t k = 0; k < chosen.size(); ++k, ++at) {
    const auto in_place = search.scan(FormulaSearch::without(chosen, k));
    const double own = in_place.gain[chosen[k]];
    trace.effects.push_back(
        {search.nameOf(chosen[k]), {after.value[at], after.std[at]}, own, in_place.noise.pValue(own), {}});
    for (Index j = 0; j < in_place.gain.size(); ++j)
      if (j != chosen[k] && in_place.gain[j] >= std::max(0.0, own - closeGain({})))
        trace.effects.back().equal.push_back(search.nameOf(j));
  }
  for (Index j = 0; j < last.gain.size(); ++j)
    if (std::ranges::find(chosen, j) == chosen.end())
      trace.rejected.push_back({search.nameOf(j), {}, last.gain[j], last.noise.pValue(last.gain[j]), {}});
  std::ranges::stable_sort(trace.rejected, std::ranges::greater{}, &FormulaEffect::gain);
  trace.base_rmse = before.rmse;
  trace.refined_rmse = after.rmse;
  trace.base_held = before.held_rmse;
  trace.refined_held = after.held_rmse;
  trace.noise_floor = search.hasRuns() ? after.scatter : std::nan("");
  trace.verdict = trace.refined_held > 1.3 * trace.noise_floor ? Verdict::Unexplained
                  : chosen.empty()                             ? Verdict::NothingMissing
                                                               : Verdict::Explained;
}

}  // namespace

FormulaTrace traceFormula(const Telemetry& table, const std::string& formula, const TraceOptions& options) {
  const std::size_t equals = std::min(formula.find('='), formula.size());
  FormulaTrace trace{.answer = formula.substr(0, equals)};
  std::erase(trace.answer, ' ');
  const Rows rows =
      rowsOf(table, !table.find(trace.answer) && table.find("time_s") && table.findWords("run"));
  const std::string text = equals < formula.size() ? formula.substr(equals + 1) : "";
  FormulaReader reader(text, rows);
  if (!rows.find(trace.answer)) reader.fail("has no column " + trace.answer + " to explain");
  const Linear model = reader.read();
  if (reader.columns.contains(trace.answer)) reader.fail("has its answer on the right-hand side");
  reader.columns.insert(trace.answer);
  for (const std::string& name : reader.columns) requireWhole({name, *rows.find(name)});
  VectorXd y = *rows.find(trace.answer);
  if (const auto constant = model.find(""); constant != model.end()) y -= constant->second;
  MatrixXd base(y.size(), 0);
  for (const auto& [name, column] : model) {
    if (name.empty()) continue;
    base.conservativeResize(Eigen::NoChange, base.cols() + 1);
    base.rightCols(1) = column;
  }
  if (base.cols() == 0 || y.size() < base.cols() + 3 || !base.allFinite() || !y.allFinite() ||
      base.colPivHouseholderQr().rank() < base.cols())
    reader.fail("has no parameter, or parameters that " + std::to_string(y.size()) + " rows cannot separate");
  trace.mean = rows.find(trace.answer)->mean();
  trace.scheme = table.findWords("run") ? "runs" : "rows";
  const std::vector<Column> candidates = candidatesOf(rows, reader.columns, y);
  describe(FormulaSearch(y, rows, base, candidates, options), model, base, trace);
  return trace;
}

}  // namespace talus::terramech
