#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <talus/common/common.hpp>
#include <talus/terramech/calibration.hpp>
#include <talus/terramech/io/wheel_rows.hpp>
#include <talus/terramech/numerics/functions.hpp>
#include <talus/terramech/strength/strength_lines.hpp>
#include <talus/terramech/terramech_io.hpp>

namespace talus::terramech {
namespace {

double numberAt(const std::vector<double>* column, std::size_t row, double otherwise) {
  return column && std::isfinite((*column)[row]) ? (*column)[row] : otherwise;
}

WheelState stateAt(const Telemetry& t, std::size_t row, const RefinedModel& model) {
  constexpr double kUnknown = WheelState::kUnknown;
  WheelState s;
  s.wheel = model.wheel.value_or(Wheel{});
  s.gravity_m_s2 = model.gravity_m_s2;
  s.load_N = s.slip = kUnknown;
  for (const std::string& name : stateColumns())
    s.setCovariate(name, numberAt(t.find(name), row, s.covariate(name)));
  s.measured_torque_Nm = numberAt(t.find("torque_Nm"), row, kUnknown);
  s.measured_sinkage_m = numberAt(t.find("sinkage_m"), row, kUnknown);
  for (const auto& column : t.numbers)
    if (isOwnColumn(column.name) && !isAnswer(column.name) && !column.name.starts_with("predicted_"))
      s.extra.emplace_back(column.name, column.values[row]);
  for (const auto& column : t.words)
    if (!column.name.starts_with("predicted_")) s.group.emplace_back(column.name, column.values[row]);
  return s;
}

bool usable(const WheelState& s) {
  return std::isfinite(s.slip) && std::isfinite(s.load_N) && s.load_N > 0.0;
}

void needWheel(const Telemetry& t, const RefinedModel& model) {
  if (model.wheel || (t.find("wheel_radius_m") && t.find("wheel_width_m"))) return;
  throw InputError({t.source, "no wheel is known: columns wheel_radius_m and wheel_width_m are missing",
                    "add them, or pass --rover"});
}

/// Number of distinct finite values, at most `limit`.
std::size_t distinct(const std::vector<double>& values, std::size_t limit) {
  std::set<double> seen;
  for (double v : values)
    if (std::isfinite(v) && seen.insert(v).second && seen.size() >= limit) break;
  return seen.size();
}

std::vector<std::string> varyingCovariates(const std::vector<WheelState>& states) {
  std::vector<std::string> names = stateColumns(), varying;
  for (const auto& [name, value] : states.front().extra)
    if (name != "shear_modulus_m") names.push_back(name);
  for (const std::string& name : names) {
    std::vector<double> values;
    for (const WheelState& s : states) values.push_back(s.covariate(name));
    const auto present =
        std::count_if(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
    if (2 * present > static_cast<long>(values.size()) && distinct(values, 2) > 1) varying.push_back(name);
  }
  return varying;
}

std::vector<std::string> groupingColumns(const std::vector<WheelState>& states) {
  std::vector<std::string> columns;
  for (const auto& [name, unused] : states.front().group) {
    if (name == "run") continue;
    std::map<std::string_view, int> counts;
    for (const WheelState& s : states) ++counts[s.label(name)];
    int large = 0;
    for (const auto& [label, count] : counts) large += !label.empty() && count >= 4;
    if (counts.size() >= 2 && counts.size() <= 8 && large >= 2) columns.push_back(name);
  }
  return columns;
}

std::vector<int> runNumbers(const std::vector<WheelState>& states) {
  std::map<std::string_view, int> numbers;
  std::vector<int> run;
  int alone = 1'000'000;
  for (const WheelState& s : states) {
    const std::string_view label = s.label("run");
    run.push_back(label.empty() ? alone++
                                : numbers.try_emplace(label, static_cast<int>(numbers.size())).first->second);
  }
  return run;
}

// Moment number of each row. Rows of one run at one time form a moment and must be of different wheels; empty
// if some row violates this condition.
std::vector<int> momentNumbers(const std::vector<WheelState>& states) {
  std::map<std::pair<std::string_view, double>, std::set<std::string_view>> wheels;
  std::map<std::pair<std::string_view, double>, int> numbers;
  std::vector<int> moment;
  std::size_t rows = 0;
  for (const WheelState& s : states) {
    const std::pair key{s.label("run"), s.time_s};
    const std::string_view wheel = s.label("wheel");
    if (!std::isfinite(s.time_s) || wheel.empty() || !wheels[key].insert(wheel).second) return {};
    moment.push_back(numbers.try_emplace(key, static_cast<int>(numbers.size())).first->second);
    ++rows;
  }
  return rows >= 2 * numbers.size() ? moment : std::vector<int>{};
}

// Sets the drawbar pull over load, DP/W, in the first row of each moment to the total of the rover from the
// slope: at constant speed sum(DP) = tan(slope) sum(W), with loads normal to the ground.
void balance(Trial& trial) {
  std::set<int> seen;
  for (int row = 0; row < trial.rows(); ++row) {
    const auto r = static_cast<std::size_t>(row);
    if (seen.insert(trial.moment[r]).second)
      trial.measured(row, static_cast<int>(Channel::DrawbarPull)) = std::tan(trial.states[r].slope_rad);
  }
}

// For a drive without measured wheel pull the rover's total pull is used; the slope is then a measured answer
// and not a covariate.
void addMoments(Trial& trial) {
  if (trial.has(Channel::DrawbarPull)) return;
  trial.moment = momentNumbers(trial.states);
  if (trial.moment.empty()) return;
  balance(trial);
  std::erase(trial.covariates, "slope_rad");
  if (std::set<int>(trial.run.begin(), trial.run.end()).size() < 5) trial.run = trial.moment;
}

/// True if a column is a linear function of a reading, from which the reading was then computed (or which was
/// computed from the reading): such a column contains the reading's own error.
bool repeatsReading(const Trial& trial, const std::string& column) {
  constexpr double kOfRounding = 1e-6;  // greatest 1 - r^2 of a column of rounded numbers
  constexpr int kFewest = 6;
  for (int c = 0; c < kChannels; ++c) {
    PairMoments m;
    for (int row = 0; row < trial.rows(); ++row) {
      const double x = trial.states[static_cast<std::size_t>(row)].covariate(column),
                   y = trial.measured(row, c) * trial.denominator(row, static_cast<Channel>(c));
      if (std::isfinite(x) && std::isfinite(y)) m.add(x, y);
    }
    if (m.weight >= kFewest && m.xx > 0.0 && m.yy > 0.0 && 1.0 - m.xy * m.xy / (m.xx * m.yy) < kOfRounding)
      return true;
  }
  return false;
}

// Replaces the pull of the first wheel of each moment by that of the whole rover.
void pullTogether(const Trial& trial, Eigen::MatrixXd& scaled) {
  const int pull = static_cast<int>(Channel::DrawbarPull);
  const int moments = *std::max_element(trial.moment.begin(), trial.moment.end()) + 1;
  Eigen::VectorXd pull_N = Eigen::VectorXd::Zero(moments), load_N = Eigen::VectorXd::Zero(moments);
  for (int row = 0; row < trial.rows(); ++row) {
    const auto r = static_cast<std::size_t>(row);
    pull_N[trial.moment[r]] += scaled(row, pull) * trial.load_N[r];
    load_N[trial.moment[r]] += trial.load_N[r];
  }
  for (int row = 0; row < trial.rows(); ++row) {
    const int m = trial.moment[static_cast<std::size_t>(row)];
    scaled(row, pull) = pull_N[m] / load_N[m];
  }
}

}  // namespace

bool Trial::has(Channel channel) const {
  return measured.rows() > 0 && measured.col(static_cast<int>(channel)).array().isFinite().any();
}

double SharedError::soilVariance(int channel) const {
  double sum = 0.0;
  for (const SoilFactor& f : by_soil)
    sum += f.row(channel).transpose().cwiseAbs2().dot(run.diagonal().tail<kShared - kChannels>());
  return by_soil.empty() ? 0.0 : sum / static_cast<double>(by_soil.size());
}

double SharedError::variance(int channel) const {
  return run(channel, channel) + soilVariance(channel);
}

double Trial::denominator(int row, Channel channel) const {
  const auto r = static_cast<std::size_t>(row);
  const Reading units{.load_N = load_N[r], .radius_m = states[r].wheel.radius_m};
  return units.denominator(channel);
}

bool slipIsAlongTravel(const std::vector<WheelState>& states) {
  double along_travel = 0.0, in_plane = 0.0;
  int rows = 0;
  for (const WheelState& s : states) {
    if (std::abs(s.slip_angle_rad) < 0.1 || !(s.speed_mps > 0.0) || !(s.rim_speed_mps > 0.0)) continue;
    const auto slip = [&](double v) {
      return v <= s.rim_speed_mps ? 1.0 - v / s.rim_speed_mps : s.rim_speed_mps / v - 1.0;
    };
    along_travel += std::abs(slip(s.speed_mps) - s.slip);
    in_plane += std::abs(slip(s.speed_mps * std::cos(s.slip_angle_rad)) - s.slip);
    ++rows;
  }
  return rows > 2 && along_travel < 0.5 * in_plane;
}

std::vector<WheelState> statesOf(const Telemetry& t, const RefinedModel& model) {
  t.at("load_N");
  t.at("slip");
  needWheel(t, model);
  std::vector<WheelState> states;
  for (std::size_t row = 0; row < t.size(); ++row) states.push_back(stateAt(t, row, model));
  return states;
}

Trial makeTrial(const Telemetry& t, const RefinedModel& model) {
  const std::vector<WheelState> all = statesOf(t, model);
  Trial trial;
  std::vector<std::array<double, kChannels>> answers;
  for (std::size_t row = 0; row < all.size(); ++row) {
    if (!usable(all[row])) continue;
    const Reading units{.load_N = all[row].load_N, .radius_m = all[row].wheel.radius_m};
    std::array<double, kChannels> a{};
    bool any = false;
    for (std::size_t c = 0; c < kChannels; ++c) {
      a[c] = numberAt(t.find(kAnswers[c]), row, WheelState::kUnknown) /
             units.denominator(static_cast<Channel>(c));
      any |= std::isfinite(a[c]);
    }
    if (!any) continue;
    trial.states.push_back(all[row]);
    answers.push_back(a);
  }
  if (answers.empty())
    throw InputError(
        {t.source, "no row has load_N, slip and one of drawbar_pull_N, sinkage_m, torque_Nm", ""});
  trial.measured.resize(trial.rows(), kChannels);
  for (int row = 0; row < trial.rows(); ++row)
    for (int c = 0; c < kChannels; ++c)
      trial.measured(row, c) = answers[static_cast<std::size_t>(row)][static_cast<std::size_t>(c)];
  for (const WheelState& s : trial.states) {
    trial.load_N.push_back(s.load_N);
    trial.slip.push_back(s.slip);
  }
  trial.slip_variance = trial.load_variance = Eigen::VectorXd::Zero(trial.rows());
  trial.run = runNumbers(trial.states);
  trial.covariates = varyingCovariates(trial.states);
  std::erase_if(trial.covariates, [&](const std::string& column) {
    return isOwnColumn(column) && repeatsReading(trial, column);
  });
  trial.groupings = groupingColumns(trial.states);
  addMoments(trial);
  return trial;
}

Eigen::VectorXd covariateValues(const Trial& trial, const std::string& name,
                                const Eigen::VectorXd& sinkage_m) {
  if (name == "sinkage_m") return sinkage_m;
  Eigen::VectorXd x(trial.rows());
  for (int row = 0; row < trial.rows(); ++row)
    x[row] = trial.states[static_cast<std::size_t>(row)].covariate(name);
  return x;
}

std::vector<char> beyondAxle(const Trial& trial) {
  std::vector<char> sunk;
  for (int row = 0; row < trial.rows(); ++row)
    sunk.push_back(trial.measured(row, static_cast<int>(Channel::Sinkage)) >= 1.0);
  return sunk;
}

namespace {

// Removes the pull of moments of which some wheels are removed, because the pull of the rover is then
// unknown.
void dropBrokenMoments(const Trial& trial, const std::vector<char>& keep, Trial& part) {
  std::set<int> broken;
  for (std::size_t row = 0; row < trial.moment.size(); ++row)
    if (!keep[row]) broken.insert(trial.moment[row]);
  for (std::size_t row = 0; row < part.moment.size(); ++row)
    if (broken.contains(part.moment[row]))
      part.measured(static_cast<Eigen::Index>(row), static_cast<int>(Channel::DrawbarPull)) =
          WheelState::kUnknown;
}

}  // namespace

std::vector<char> rowsOfSoil(const Trial& trial) {
  std::vector<char> straight;
  for (const WheelState& s : trial.states) straight.push_back(std::abs(s.slip_angle_rad) < 0.1);
  if (std::count(straight.begin(), straight.end(), 1) < 20) straight.assign(straight.size(), 1);
  return straight;
}

Trial asMeasured(Trial trial) {
  for (std::size_t row = 0; row < trial.states.size(); ++row) {
    trial.states[row].slip = trial.slip[row];
    trial.states[row].load_N = trial.load_N[row];
  }
  return trial;
}

Trial subset(const Trial& trial, const std::vector<char>& keep) {
  Trial part;
  part.covariates = trial.covariates;
  part.groupings = trial.groupings;
  part.dropped = trial.dropped;
  part.chance = trial.chance;
  const auto count = static_cast<int>(std::count(keep.begin(), keep.end(), 1));
  part.measured.resize(count, kChannels);
  part.slip_variance.resize(count);
  part.load_variance.resize(count);
  int to = 0;
  for (int row = 0; row < trial.rows(); ++row) {
    const auto r = static_cast<std::size_t>(row);
    if (!keep[r]) continue;
    part.states.push_back(trial.states[r]);
    part.load_N.push_back(trial.load_N[r]);
    part.slip.push_back(trial.slip[r]);
    part.run.push_back(trial.run[r]);
    if (!trial.moment.empty()) part.moment.push_back(trial.moment[r]);
    part.measured.row(to) = trial.measured.row(row);
    part.slip_variance[to] = trial.slip_variance[row];
    part.load_variance[to] = trial.load_variance[row];
    ++to;
  }
  dropBrokenMoments(trial, keep, part);
  return part;
}

Eigen::MatrixXd predictRows(const RefinedModel& model, const Trial& trial, SolvedContacts& solved) {
  std::vector<Reading> readings = predict(model, trial.states, solved);
  Eigen::MatrixXd out(trial.rows(), kChannels);
  for (int row = 0; row < trial.rows(); ++row) {
    const auto r = static_cast<std::size_t>(row);
    readings[r].load_N = trial.load_N[r];
    for (int c = 0; c < kChannels; ++c) out(row, c) = readings[r].scaled(static_cast<Channel>(c));
  }
  if (!trial.moment.empty()) pullTogether(trial, out);
  return out;
}

ModelFile baseModel(const std::string& file, const std::string& rover) {
  ModelFile base = file.empty() ? unknownSoil() : loadModel(file);
  if (!rover.empty()) base.model.takeRover(loadRover(rover));
  return base;
}

ModelRows modelRows(Telemetry table, const RefinedModel& model) {
  leaveOutWithoutSlipAngle(table);
  const Trial all = makeTrial(table, model);
  const std::vector<char> sunk = beyondAxle(all);
  std::vector<char> above;
  for (const char row : sunk) above.push_back(!row);
  ModelRows rows{.model = model,
                 .trial = subset(all, above),
                 .beyond_axle = subset(all, sunk),
                 .rejected = std::move(table.rejected)};
  rows.model.slip_along_travel |= slipIsAlongTravel(rows.trial.states);
  return rows;
}

}  // namespace talus::terramech
