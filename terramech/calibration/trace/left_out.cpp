#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include <Eigen/SVD>

#include <talus/common/common.hpp>
#include <talus/terramech/calibration/held_out/held_out.hpp>
#include <talus/terramech/calibration/trace/left_out.hpp>
#include <talus/terramech/numerics/functions.hpp>
#include <talus/terramech/strength/strength_lines.hpp>

namespace talus::terramech {
namespace {

std::string textOf(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

bool isNumber(const std::string& text, double& value) {
  std::istringstream in(text);
  return static_cast<bool>(in >> value) && in.eof();
}

bool close(double a, double b) {
  return std::abs(a - b) <= 1e-3 * std::max(std::abs(a), std::abs(b)) + 1e-9;
}

/// Marks the rows that satisfy a rule.
template <class Rule>
std::vector<char> rowsWhere(const Trial& trial, const Rule& rule) {
  std::vector<char> rows;
  for (const WheelState& s : trial.states) rows.push_back(rule(s));
  return rows;
}

/// Splits a list of values separated by commas. A value in double quotes may contain commas, and doubled
/// quotes for a quote, as in a CSV field.
std::vector<std::string> wordsOf(const std::string& values) {
  std::vector<std::string> words;
  for (std::size_t at = 0; at <= values.size();) {
    std::string word;
    if (at < values.size() && values[at] == '"') {
      std::size_t end = at + 1;
      for (; end < values.size() && (values[end] != '"' || values[end + 1] == '"'); ++end) {
        word += values[end];
        if (values[end] == '"') ++end;
      }
      if (end >= values.size() || (end + 1 < values.size() && values[end + 1] != ','))
        throw InputError({"--hold-out " + values, "a quoted value does not end with a quote and a comma",
                          "write \"V\", and two quotes for one inside"});
      at = end + 2;
    } else {
      const std::size_t end = std::min(values.find(',', at), values.size());
      word = values.substr(at, end - at);
      at = end + 1;
    }
    words.push_back(std::move(word));
  }
  return words;
}

LeftOut ofWords(const Trial& trial, const std::string& column, const std::string& values,
                const std::vector<std::string>& words) {
  return {column + " = " + values, rowsWhere(trial, [&](const WheelState& s) {
            return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
              double v = 0.0;
              return s.label(column) == word || (isNumber(word, v) && close(s.covariate(column), v));
            });
          })};
}

bool isText(const Trial& trial, const std::string& column) {
  return std::any_of(trial.states.begin(), trial.states.end(),
                     [&](const WheelState& s) { return !s.label(column).empty(); });
}

// Rows with the given values or range. Ranges apply to numeric columns only, because text values may contain
// two dots.
LeftOut ofValues(const Trial& trial, const std::string& column, const std::string& values) {
  const auto dots = isText(trial, column) ? std::string::npos : values.find("..");
  if (dots != std::string::npos && values.front() != '"') {
    double low = -1e300, high = 1e300;
    const std::string from = values.substr(0, dots), to = values.substr(dots + 2);
    if ((!from.empty() && !isNumber(from, low)) || (!to.empty() && !isNumber(to, high)))
      throw InputError({"--hold-out " + column + "=" + values, "the ends of the range are no numbers",
                        "write LOW..HIGH, LOW.. or ..HIGH"});
    return {column + " = " + values, rowsWhere(trial, [&](const WheelState& s) {
              const double v = s.covariate(column);
              return v >= low && v <= high;
            })};
  }
  return ofWords(trial, column, values, wordsOf(values));
}

std::vector<LeftOut> eachLevel(const Trial& trial, const std::string& column) {
  std::set<std::string> words;
  std::vector<double> values;
  for (const WheelState& s : trial.states) {
    if (!s.label(column).empty()) words.emplace(s.label(column));
    if (std::isfinite(s.covariate(column))) values.push_back(s.covariate(column));
  }
  std::vector<LeftOut> all;
  for (const std::string& word : words) all.push_back(ofWords(trial, column, word, {word}));
  if (!all.empty() || values.empty()) return all;
  std::sort(values.begin(), values.end());
  // Levels are separated by more than a hundredth of the range.
  const double apart = 0.01 * (values.back() - values.front());
  std::vector<std::pair<double, double>> levels;
  for (double v : values) {
    if (levels.empty() || v - levels.back().second > apart) levels.push_back({v, v});
    levels.back().second = v;
  }
  if (levels.size() > 12) {
    levels.clear();
    for (std::size_t k = 0; k < 10; ++k)
      levels.push_back({values[k * values.size() / 10], values[(k + 1) * values.size() / 10 - 1]});
  }
  for (const auto& [low, high] : levels)
    all.push_back({column + " = " + textOf(low) + (high - low > apart ? " to " + textOf(high) : ""),
                   rowsWhere(trial, [&, low = low, high = high](const WheelState& s) {
                     const double v = s.covariate(column);
                     return v >= low && v <= high;
                   })});
  return all;
}

/// Columns and their squares, divided by their scatter over the seen rows.
Eigen::MatrixXd features(const Trial& trial, const Trial& seen) {
  std::vector<Eigen::VectorXd> columns{Eigen::VectorXd::Ones(trial.rows())};
  for (const std::string& name : seen.covariates) {
    PairMoments m;
    for (const WheelState& s : seen.states)
      if (const double v = s.covariate(name); std::isfinite(v)) m.add(v, 0.0);
    if (!(m.xx > 0.0)) continue;
    const double mean = m.x, std = std::sqrt(m.xx / m.weight);
    Eigen::VectorXd x(trial.rows());
    for (int row = 0; row < trial.rows(); ++row) {
      const double v = trial.states[static_cast<std::size_t>(row)].covariate(name);
      x[row] = std::isfinite(v) ? (v - mean) / std : 0.0;
    }
    columns.push_back(x);
    columns.push_back(x.cwiseAbs2());
  }
  Eigen::MatrixXd all(trial.rows(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) all.col(static_cast<Eigen::Index>(k)) = columns[k];
  return all;
}

/// Ridge regression with the strength that minimises n |y - H y|^2 / (n - tr H)^2.
Eigen::VectorXd ridge(const Eigen::MatrixXd& x, const Eigen::VectorXd& y) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(x, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::VectorXd& s = svd.singularValues();
  const Eigen::VectorXd u = svd.matrixU().transpose() * y;
  double best = 1e300;
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(x.cols());
  for (double lambda = 1e-4; lambda < 1e5; lambda *= 3.0) {
    const Eigen::ArrayXd share = s.array().square() / (s.array().square() + lambda);
    const double left =
        y.squaredNorm() - u.squaredNorm() + ((1.0 - share) * u.array()).matrix().squaredNorm();
    const double score = left / std::pow(static_cast<double>(y.size()) - share.sum(), 2);
    if (score >= best) continue;
    best = score;
    weights = svd.matrixV() * (u.array() * s.array() / (s.array().square() + lambda)).matrix();
  }
  return weights;
}

ChannelErrors regressionErrors(const Trial& seen, const Trial& unseen) {
  const Eigen::MatrixXd x = features(seen, seen), at = features(unseen, seen);
  Eigen::MatrixXd predicted = Eigen::MatrixXd::Constant(unseen.rows(), kChannels, std::nan(""));
  for (int c = 0; c < kChannels; ++c) {
    std::vector<Eigen::Index> there;
    for (Eigen::Index row = 0; row < x.rows(); ++row)
      if (std::isfinite(seen.measured(row, c))) there.push_back(row);
    if (!there.empty()) predicted.col(c) = at * ridge(x(there, Eigen::all), seen.measured(there, c));
  }
  return rmseOf(predicted, unseen);
}

}  // namespace

std::vector<LeftOut> leftOut(const Trial& trial, const std::string& request, const std::string& source) {
  const auto equals = request.find('=');
  const std::string column = request.substr(0, equals);
  const bool known = std::any_of(trial.states.begin(), trial.states.end(), [&](const WheelState& s) {
    return !s.label(column).empty() || std::isfinite(s.covariate(column));
  });
  if (!known)
    throw InputError({source, "has no column " + column, "name one of its columns with --hold-out"});
  auto all = equals == std::string::npos
                 ? eachLevel(trial, column)
                 : std::vector<LeftOut>{ofValues(trial, column, request.substr(equals + 1))};
  for (const LeftOut& part : all) {
    const auto count = std::count(part.rows.begin(), part.rows.end(), 1);
    if (count == 0) throw InputError({source, "has no row with " + part.what, "give values of the column"});
    if (count == trial.rows())
      throw InputError({source, "has only rows with " + part.what, "hold out a part of them"});
  }
  return all;
}

LeftOutErrors traceWithout(const RefinedModel& base, const Trial& trial, const LeftOut& left,
                           const TraceOptions& options, const ProgressMonitor& watch) {
  std::vector<char> kept;
  for (char row : left.rows) kept.push_back(!row);
  const Trial seen = subset(trial, kept), unseen = subset(trial, left.rows);
  const TraceResult result = traceResiduals(base, seen, options, watch);
  LeftOutErrors errors{.what = left.what, .rows = unseen.rows()};
  for (const TracedEffect& e : result.effects)
    errors.effects.push_back(e.chosen.candidate.parts.front().name + " (" + e.chosen.candidate.covariate() +
                             ")");
  SolvedContacts solved;
  errors.trial = unseen;
  errors.base_predicted = predictRows(result.base, unseen, solved);
  errors.predicted = predictInScope(result, unseen);
  errors.base = rmseOf(errors.base_predicted, unseen);
  errors.refined = rmseOf(errors.predicted, unseen);
  errors.floor = result.noise_floor;
  Trial same = seen;  // restricted to the searched columns below
  same.covariates = result.trial.covariates;
  errors.regression = regressionErrors(same, unseen);
  return errors;
}

}  // namespace talus::terramech
