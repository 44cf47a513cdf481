#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include <Eigen/Cholesky>

#include <talus/terramech/calibration/fit/model_fit.hpp>
#include <talus/terramech/calibration/noise/whitening.hpp>
#include <talus/terramech/calibration/trace/run_proposal.hpp>
#include <talus/terramech/contact/rim_contact.hpp>

namespace talus::terramech {
namespace {

std::string causeName(const Candidate& candidate) {
  const Effect& front = candidate.parts.front();
  return front.name + " (" + candidate.covariate() +
         (front.only_column.empty() ? "" : " = " + front.only_value) + ")";
}

Eigen::VectorXd inOneColumn(const Eigen::MatrixXd& rows) {
  Eigen::VectorXd all(rows.size());
  for (Eigen::Index row = 0; row < rows.rows(); ++row)
    for (Eigen::Index c = 0; c < rows.cols(); ++c) all[row * rows.cols() + c] = rows(row, c);
  return all;
}

/// Joint normal prediction of the measured readings of some rows, including the error common to a run.
struct JointPrediction {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};

/// Predictions of a model for the rows of a trial, and the joint distribution of any of the measured
/// readings.
class CauseOnRows {
 public:
  CauseOnRows(const RefinedModel& model, const SharedError& shared, const Trial& trial)
      : trial_(trial), model_(model), shared_(shared) {
    SolvedContacts solved;
    level_ = predictRows(model, trial, solved);
    slopes_ = inputSlopes(model, trial, solved);
    if (!shared.by_soil.empty()) by_soil_ = soilFactors(model, trial, level_, solved);
    const auto count = static_cast<Eigen::Index>(model.fitted.size());
    by_parameter_ = jacobian(model, trial, model.fitted, solved, inOneColumn);
    parameters_ =
        model.covariance.empty()
            ? Eigen::MatrixXd::Zero(count, count)
            : Eigen::MatrixXd(Eigen::Map<const Eigen::MatrixXd>(model.covariance.data(), count, count));
  }

  /// `readings`: indices row * kChannels + channel.
  JointPrediction of(const std::vector<Eigen::Index>& readings) const {
    const auto n = static_cast<Eigen::Index>(readings.size());
    JointPrediction joint{Eigen::VectorXd(n), Eigen::MatrixXd::Zero(n, n)};
    const Eigen::MatrixXd j = by_parameter_(readings, Eigen::all);
    joint.covariance = j * parameters_ * j.transpose();  // (T56)
    for (Eigen::Index a = 0; a < n; ++a) {
      const Eigen::Index reading = readings[static_cast<std::size_t>(a)];
      joint.mean[a] = level_(reading / kChannels, reading % kChannels);
      for (Eigen::Index b = 0; b < n; ++b)
        joint.covariance(a, b) += readingCovariance(reading, readings[static_cast<std::size_t>(b)]);
    }
    return joint;
  }

 private:
  SharedVector sharedFactor(Eigen::Index reading) const {
    SharedVector f = SharedVector::Zero();
    f[reading % kChannels] = 1.0;
    if (!by_soil_.empty())
      f.tail<kShared - kChannels>() =
          by_soil_[static_cast<std::size_t>(reading / kChannels)].row(reading % kChannels).transpose();
    return f;
  }

  double readingCovariance(Eigen::Index a, Eigen::Index b) const {
    const auto row = static_cast<int>(a / kChannels), other = static_cast<int>(b / kChannels);
    double covariance = 0.0;
    if (row == other) {
      const double slip_std = model_.noise.slipStd(trial_.slip[static_cast<std::size_t>(row)]);
      covariance = rowCovariance(trial_, row, level_, slopes_, model_.noise, slip_std * slip_std,
                                 std::pow(model_.noise.load_relative, 2))(a % kChannels, b % kChannels);
    }
    if (!shared_.unit.empty() &&
        trial_.run[static_cast<std::size_t>(row)] == trial_.run[static_cast<std::size_t>(other)])
      covariance += sharedFactor(a).dot(shared_.run * sharedFactor(b));
    return covariance;
  }

  const Trial& trial_;
  const RefinedModel& model_;
  const SharedError& shared_;
  Eigen::MatrixXd level_, by_parameter_, parameters_;
  InputSlopes slopes_;
  std::vector<SoilFactor> by_soil_;
};

std::vector<Eigen::Index> readingsOf(const Trial& trial, int first_row, int rows) {
  std::vector<Eigen::Index> readings;
  for (int row = first_row; row < first_row + rows; ++row)
    for (int c = 0; c < kChannels; ++c)
      if (std::isfinite(trial.measured(row, c))) readings.push_back(row * kChannels + c);
  return readings;
}

/// Quantile `share` of the values of a column over the rows.
double quantile(const Trial& trial, const std::string& column, double share) {
  std::vector<double> values;
  for (const WheelState& s : trial.states)
    if (const double v = s.covariate(column); std::isfinite(v)) values.push_back(v);
  const auto at = static_cast<long>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

bool varies(const Trial& trial, const std::string& column) {
  return std::find(trial.covariates.begin(), trial.covariates.end(), column) != trial.covariates.end();
}

/// Columns that a run sets: those of the causes, and the load. The rim speed follows from travel speed and
/// slip.
std::vector<std::string> columnsToSet(const TraceResult& result) {
  std::set<std::string> columns{"load_N"};
  const auto add = [&](const Candidate& c) {
    for (const Effect& part : c.parts) {
      const std::string& column = part.only_column.empty() ? part.covariate : part.only_column;
      const auto star = column.find('*');
      columns.insert(column.substr(0, star));
      if (star != std::string::npos) columns.insert(column.substr(star + 1));
    }
  };
  for (const TracedEffect& e : result.effects) add(e.chosen.candidate);
  for (const RivalCause& r : result.rivals) add(r.explanation.candidate);
  if (columns.contains("rim_speed_mps") && varies(result.trial, "speed_mps")) columns.insert("speed_mps");
  if (columns.contains("speed_mps")) columns.erase("rim_speed_mps");
  columns.erase("slip");
  std::vector<std::string> kept;
  constexpr std::size_t kMost = 4;
  for (const std::string& column : columns)
    if (kept.size() < kMost && (varies(result.trial, column) ||
                                std::find(result.trial.groupings.begin(), result.trial.groupings.end(),
                                          column) != result.trial.groupings.end()))
      kept.push_back(column);
  return kept;
}

/// The states with a column set to the ends and the middle of its range, or to each of its text values.
std::vector<WheelState> withEachLevel(const std::vector<WheelState>& states, const Trial& trial,
                                      const std::string& column) {
  std::vector<WheelState> all;
  std::set<std::string> words;
  for (const WheelState& s : trial.states)
    if (!s.label(column).empty()) words.emplace(s.label(column));
  // For time only the greatest value is used, because a proposed run lies in the future.
  std::set<double> levels{quantile(trial, column, 1.0)};
  if (column != "time_s") levels.insert({quantile(trial, column, 0.0), quantile(trial, column, 0.5)});
  for (const WheelState& s : states) {
    for (const std::string& word : words) {
      all.push_back(s);
      for (auto& [key, text] : all.back().group)
        if (key == column) text = word;
    }
    if (!words.empty()) continue;
    for (const double level : levels) {
      all.push_back(s);
      all.back().setCovariate(column, level);
    }
  }
  return all;
}

/// Slips of the rows of each possible run: five slips in one run if measured runs vary in slip, otherwise one
/// run for each slip.
std::vector<std::vector<double>> slipsOf(const Trial& trial) {
  const double low = quantile(trial, "slip", 0.05), high = quantile(trial, "slip", 0.95);
  std::map<int, std::pair<double, double>> range;
  double widest = 0.0;
  for (std::size_t row = 0; row < trial.slip.size(); ++row) {
    auto& [least, most] = range.try_emplace(trial.run[row], trial.slip[row], trial.slip[row]).first->second;
    least = std::min(least, trial.slip[row]);
    most = std::max(most, trial.slip[row]);
    widest = std::max(widest, most - least);
  }
  constexpr int kSlips = 5;
  std::vector<double> slips;
  for (int k = 0; k < kSlips; ++k) slips.push_back(low + k * (high - low) / (kSlips - 1));
  if (widest > 0.5 * (high - low)) return {slips};
  std::vector<std::vector<double>> alone;
  for (const double slip : slips) alone.push_back({slip});
  return alone;
}

/// The row with the median load.
WheelState middleRow(const Trial& trial) {
  const double load_N = quantile(trial, "load_N", 0.5);
  return *std::min_element(trial.states.begin(), trial.states.end(),
                           [&](const WheelState& a, const WheelState& b) {
                             return std::abs(a.load_N - load_N) < std::abs(b.load_N - load_N);
                           });
}

/// All runs that may be proposed, one after the other, with the measured channels of the table.
Trial possibleRuns(const TraceResult& result, std::size_t& rows_a_run) {
  const Trial& trial = result.trial;
  std::vector<WheelState> settings{middleRow(trial)};
  for (const std::string& column : columnsToSet(result)) settings = withEachLevel(settings, trial, column);
  Trial runs;
  int run = 0;
  for (const WheelState& setting : settings)
    for (const std::vector<double>& slips : slipsOf(trial)) {
      rows_a_run = slips.size();
      for (const double slip : slips) {
        runs.states.push_back(setting);
        WheelState& s = runs.states.back();
        s.slip = slip;
        if (std::isfinite(s.speed_mps) && std::isfinite(s.rim_speed_mps))
          s.rim_speed_mps = s.speed_mps / std::max(travelRatio(slip), 1e-3);
        runs.slip.push_back(slip);
        runs.load_N.push_back(s.load_N);
        runs.run.push_back(run);
      }
      ++run;
    }
  runs.measured = Eigen::MatrixXd::Constant(runs.rows(), kChannels, std::nan(""));
  for (int c = 0; c < kChannels; ++c)
    if (trial.has(static_cast<Channel>(c))) runs.measured.col(c).setZero();
  runs.slip_variance = runs.load_variance = Eigen::VectorXd::Zero(runs.rows());
  return runs;
}

/// Bhattacharyya distance of two normal distributions.
double distance(const JointPrediction& a, const JointPrediction& b) {
  const Eigen::LDLT<Eigen::MatrixXd> middle((0.5 * (a.covariance + b.covariance)).eval());
  const Eigen::VectorXd apart = a.mean - b.mean;
  const auto logDeterminant = [](const Eigen::LDLT<Eigen::MatrixXd>& of) {
    return of.vectorD().array().max(1e-300).log().sum();
  };
  // (T57)
  return 0.125 * apart.dot(middle.solve(apart)) +
         0.5 * (logDeterminant(middle) -
                0.5 * (logDeterminant(a.covariance.ldlt()) + logDeterminant(b.covariance.ldlt())));
}

RunPrediction meanOf(const std::string& cause, const JointPrediction& joint, const Trial& runs,
                     const std::vector<Eigen::Index>& readings) {
  RunPrediction p{.cause = cause};
  for (int c = 0; c < kChannels; ++c) {
    Eigen::VectorXd weight = Eigen::VectorXd::Zero(joint.mean.size());
    for (std::size_t k = 0; k < readings.size(); ++k)
      if (readings[k] % kChannels == c)
        weight[static_cast<Eigen::Index>(k)] =
            runs.denominator(static_cast<int>(readings[k] / kChannels), static_cast<Channel>(c));
    const auto count = static_cast<double>((weight.array() != 0.0).count());
    p.mean[static_cast<std::size_t>(c)] = weight.dot(joint.mean) / count;
    p.std[static_cast<std::size_t>(c)] = std::sqrt(weight.dot(joint.covariance * weight)) / count;
  }
  return p;
}

/// Selection among the possible runs.
class RunChoice {
 public:
  RunChoice(const std::vector<Cause>& causes, const std::vector<CauseOnRows>& models, const Trial& runs,
            int rows_a_run)
      : causes_(causes), models_(models), runs_(runs), length_(rows_a_run) {
    for (int run = 0; run < runs.rows() / length_; ++run) {
      std::vector<JointPrediction> joint;
      for (const CauseOnRows& model : models)
        joint.push_back(model.of(readingsOf(runs, run * length_, length_)));
      std::vector<double>& own = distances_.emplace_back();
      for (std::size_t a = 0; a < joint.size(); ++a)
        for (std::size_t b = a + 1; b < joint.size(); ++b) own.push_back(distance(joint[a], joint[b]));
    }
  }

  /// Numbers of the selected runs, in the order of selection.
  std::vector<int> best(int count) const {
    std::vector<double> apart(distances_.front().size(), 0.0);
    std::vector<int> chosen;
    const int possible = static_cast<int>(distances_.size());
    while (static_cast<int>(chosen.size()) < std::min(count, possible)) {
      int best = -1;
      for (int run = 0; run < possible; ++run)
        if (std::find(chosen.begin(), chosen.end(), run) == chosen.end() &&
            (best < 0 || confusion(apart, run) < confusion(apart, best)))
          best = run;
      chosen.push_back(best);
      for (std::size_t pair = 0; pair < apart.size(); ++pair)
        apart[pair] += distances_[static_cast<std::size_t>(best)][pair];
    }
    return chosen;
  }

  ProposedRun described(int run) const {
    const WheelState& setting = runs_.states[static_cast<std::size_t>(run * length_)];
    ProposedRun one;
    for (const std::string& column : stateColumns())
      if (column != "slip" && column != "rim_speed_mps" && std::isfinite(setting.covariate(column)))
        one.columns.emplace_back(column, setting.covariate(column));
    for (const auto& [column, value] : setting.extra)
      if (std::isfinite(value)) one.columns.emplace_back(column, value);
    for (const auto& [column, text] : setting.group)
      if (column != "run") one.groups.emplace_back(column, text);
    one.predictions = predictions(run * length_, length_);
    for (int row = run * length_; row < (run + 1) * length_; ++row) {
      one.slip.push_back(runs_.slip[static_cast<std::size_t>(row)]);
      one.row_predictions.push_back(predictions(row, 1));
    }
    return one;
  }

 private:
  /// Logarithm of the sum over pairs of exp(-B) after a run; the logarithm keeps the order if all B are
  /// large.
  double confusion(const std::vector<double>& apart, int run) const {
    const std::vector<double>& own = distances_[static_cast<std::size_t>(run)];
    double least = apart[0] + own[0], sum = 0.0;
    for (std::size_t pair = 1; pair < apart.size(); ++pair) least = std::min(least, apart[pair] + own[pair]);
    for (std::size_t pair = 0; pair < apart.size(); ++pair) sum += std::exp(least - apart[pair] - own[pair]);
    return std::log(sum) - least;  // (T58)
  }

  std::vector<RunPrediction> predictions(int first_row, int rows) const {
    std::vector<RunPrediction> all;
    const std::vector<Eigen::Index> readings = readingsOf(runs_, first_row, rows);
    for (std::size_t k = 0; k < causes_.size(); ++k)
      all.push_back(meanOf(causes_[k].name, models_[k].of(readings), runs_, readings));
    return all;
  }

  const std::vector<Cause>& causes_;
  const std::vector<CauseOnRows>& models_;
  const Trial& runs_;
  int length_;
  std::vector<std::vector<double>> distances_;  ///< for each run and pair of causes
};

}  // namespace

std::vector<Cause> causesOf(const TraceResult& result) {
  constexpr std::size_t kMost = 4;
  std::string traced;
  std::set<std::string> equal;
  for (const TracedEffect& e : result.effects) {
    traced += (traced.empty() ? "" : " + ") + causeName(e.chosen.candidate);
    for (const Explanation& other : e.equal) equal.insert(causeName(other.candidate));
  }
  std::vector<Cause> causes{{traced.empty() ? "no effect" : traced, result.refined}};
  for (const RivalCause& r : result.rivals) {
    const std::string name = causeName(r.explanation.candidate);
    if (causes.size() == kMost || (!equal.empty() && !equal.contains(name))) continue;
    causes.push_back({r.in_place_of.empty() ? name : name + " in place of " + r.in_place_of, r.model});
  }
  return causes;
}

std::vector<ProposedRun> proposeRuns(const TraceResult& result, int count) {
  const std::vector<Cause> causes = causesOf(result);
  if (causes.size() < 2) return {};
  std::size_t rows_a_run = 1;
  const Trial runs = possibleRuns(result, rows_a_run);
  std::vector<CauseOnRows> models;
  for (const Cause& cause : causes) models.emplace_back(cause.model, result.shared, runs);
  const RunChoice choice{causes, models, runs, static_cast<int>(rows_a_run)};
  std::vector<ProposedRun> proposed;
  for (const int run : choice.best(count)) proposed.push_back(choice.described(run));
  return proposed;
}

std::vector<CauseScore> scoreCauses(const TraceResult& result, const Trial& measured) {
  std::vector<CauseScore> scores;
  const std::vector<Eigen::Index> readings = readingsOf(measured, 0, measured.rows());
  Eigen::VectorXd read = inOneColumn(measured.measured)(readings);
  for (const Cause& cause : causesOf(result)) {
    const JointPrediction joint = CauseOnRows{cause.model, result.shared, measured}.of(readings);
    const Eigen::LDLT<Eigen::MatrixXd> solver(joint.covariance);
    const Eigen::VectorXd off = read - joint.mean;
    scores.push_back(
        {cause.name, -0.5 * (off.dot(solver.solve(off)) + solver.vectorD().array().log().sum() +
                             static_cast<double>(off.size()) * std::log(2.0 * std::numbers::pi))});
  }
  double most = scores.front().log_likelihood, sum = 0.0;
  for (const CauseScore& s : scores) most = std::max(most, s.log_likelihood);
  for (CauseScore& s : scores) sum += s.probability = std::exp(s.log_likelihood - most);  // (T59)
  for (CauseScore& s : scores) s.probability /= sum;
  return scores;
}

}  // namespace talus::terramech
