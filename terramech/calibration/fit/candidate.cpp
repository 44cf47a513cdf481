#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <talus/terramech/calibration.hpp>
#include <talus/terramech/calibration/noise/sensor_noise.hpp>
#include <talus/terramech/numerics/functions.hpp>
#include <talus/terramech/strength/strength_lines.hpp>

namespace talus::terramech {
namespace {

/// Extent of a covariate over the rows.
struct Extent {
  double low, high, middle;  // middle: median
};

std::vector<double> finite(const Eigen::VectorXd& x) {
  std::vector<double> v;
  for (double value : x)
    if (std::isfinite(value)) v.push_back(value);
  std::sort(v.begin(), v.end());
  return v;
}

Extent extentOf(const Eigen::VectorXd& x) {
  const auto v = finite(x);
  return v.empty() ? Extent{0.0, 1.0, 0.5} : Extent{v.front(), v.back(), v[v.size() / 2]};
}

/// True for a rim speed that is proportional to the speed over ground (one level of slip). The effects of
/// both speeds cannot be distinguished; the rate forms then use the speed over ground.
bool isTwin(const Trial& trial, const std::string& column) {
  if (column != "rim_speed_mps") return false;
  PairMoments m;
  for (const WheelState& s : trial.states)
    if (const double ratio = s.speed_mps / s.rim_speed_mps; std::isfinite(ratio)) m.add(ratio, 0.0);
  return 2.0 * m.weight >= trial.rows() && m.xx < 1e-3 * m.x * m.x * m.weight;
}

class Collector {
 public:
  Collector(const Trial& trial, const Eigen::VectorXd& sinkage_m) : trial_(trial), sinkage_m_(sinkage_m) {}

  bool varies(const std::string& column) const {
    return !isTwin(trial_, column) &&
           std::find(trial_.covariates.begin(), trial_.covariates.end(), column) != trial_.covariates.end();
  }

  const std::vector<std::string>& covariates() const { return trial_.covariates; }

  Extent extent(const std::string& column) const {
    return extentOf(covariateValues(trial_, column, sinkage_m_));
  }

  /// Adds a form on a column, with some parameters set: pairs of parameter name and value.
  void add(const EffectForm& form, const std::string& column,
           std::initializer_list<std::pair<const char*, double>> starts = {}) {
    if (!trial_.has(form.channel) && !form.act) return;
    Effect effect;
    effect.name = form.name;
    effect.covariate = column;
    effect.channel = form.channel;
    Candidate candidate{{}, form.family, 0};
    for (const EffectParameter& p : form.parameters) {
      double value = p.typical;
      for (const auto& [name, start] : starts)
        if (std::string_view(name) == p.name) value = start;
      effect.parameters.push_back(p.fitted ? std::clamp(value, p.low, p.high) : value);
      candidate.parameters += p.fitted;
    }
    candidate.parts = {effect};
    all_.push_back(std::move(candidate));
  }

  /// Adds several forms as one candidate, at their typical sizes.
  void addTogether(const std::vector<const char*>& names) {
    const std::size_t first = all_.size();
    for (const char* name : names) {
      const EffectForm& form = *findEffect(name);
      add(form, form.covariate);
    }
    if (all_.size() < first + 2) return;
    Candidate whole = all_[first];
    for (std::size_t k = first + 1; k < all_.size(); ++k) {
      whole.parts.push_back(all_[k].parts.front());
      whole.parameters += all_[k].parameters;
    }
    all_.resize(first);
    all_.push_back(std::move(whole));
  }

  /// Repeats the last candidate for each single group of each text column.
  void repeatByGroup() {
    const Candidate whole = all_.back();
    for (const std::string& column : trial_.groupings) {
      std::set<std::string> labels;
      for (const WheelState& s : trial_.states) labels.emplace(s.label(column));
      for (const std::string& label : labels) {
        if (label.empty()) continue;
        Candidate one = whole;
        one.parts[0].only_column = column;
        one.parts[0].only_value = label;
        all_.push_back(std::move(one));
      }
    }
  }

  std::vector<Candidate> take() { return std::move(all_); }

 private:
  const Trial& trial_;
  const Eigen::VectorXd& sinkage_m_;
  std::vector<Candidate> all_;
};

using Rule = void (*)(Collector&, const EffectForm&);

void always(Collector& to, const EffectForm& form) {
  to.add(form, form.covariate);
}

void whereItVaries(Collector& to, const EffectForm& form) {
  if (to.varies(form.covariate)) to.add(form, form.covariate);
}

void rate(Collector& to, const EffectForm& form) {
  for (const char* column : {"speed_mps", "rim_speed_mps"})
    if (to.varies(column)) to.add(form, column, {{"v0", std::max(1e-4, to.extent(column).middle)}});
}

void passes(Collector& to, const EffectForm& form) {
  if (!to.varies("pass_index")) return;
  const double first = to.extent("pass_index").low;
  if (form.parameters.size() == 2) return to.add(form, "pass_index", {{"first", first}});
  for (double scale : {0.6, 2.0}) to.add(form, "pass_index", {{"p0", scale}, {"first", first}});
}

void hardLayer(Collector& to, const EffectForm& form) {
  const Extent z = to.extent("sinkage_m");
  for (double share : {0.15, 0.35, 0.55, 0.75})
    for (double modulus : {5e6, 3e7})
      to.add(form, "sinkage_m", {{"H", z.low + share * (z.high - z.low)}, {"k_h", modulus}});
}

void pile(Collector& to, const EffectForm& form) {
  for (double start : {0.1, 0.35, 0.55}) to.add(form, "slip", {{"i0", start}});
}

void sensor(Collector& to, const EffectForm& form) {
  to.add(form, form.covariate);
  to.repeatByGroup();
}

void lugs(Collector& to, const EffectForm& form) {
  if (to.extent("grouser_height_m").high > 0.0) to.add(form, form.covariate);
}

void drift(Collector& to, const EffectForm& form) {
  if (form.parameters.size() == 5 && to.varies("heading_rad"))  // periods of one turn and half a turn
    for (double period : {1.0, 0.5})
      for (double phase : {0.0, 1.57})
        to.add(form, "heading_rad",
               {{"start", 0.0}, {"span", 2.0 * std::numbers::pi}, {"period", period}, {"phase", phase}});
  // Adds all drift forms for time, and the linear form only for additional columns.
  for (const std::string& column : to.covariates()) {
    if (column != "time_s" && !(isOwnColumn(column) && form.parameters.size() == 3)) continue;
    const Extent x = to.extent(column);
    const double span = x.high - x.low;
    if (form.parameters.size() < 5) {
      to.add(form, column, {{"start", x.low}, {"span", span}});
      continue;
    }
    for (double period : {0.6, 1.0, 2.0})
      for (double phase : {0.0, 1.57})
        to.add(form, column, {{"start", x.low}, {"span", span}, {"period", period}, {"phase", phase}});
  }
}

/// Adds no candidate: these forms are candidates only in together().
void onlyTogether(Collector&, const EffectForm&) {}

/// Adds the form if the table has rows of a braked wheel, which alone determine the form.
void skid(Collector& to, const EffectForm& form) {
  if (to.extent("slip").low < -0.02) to.add(form, form.covariate);
}

Rule ruleOf(const EffectForm& form) {
  const std::string family = form.family, name = form.name;
  if (name == "rear_fill" || name == "bulldozing_ahead") return onlyTogether;
  if (family == "rate") return rate;
  if (family == "multipass") return passes;
  if (family == "hardpan") return hardLayer;
  if (family == "rear_pile") return pile;
  if (family == "drift") return drift;
  if (family == "grouser" || name == "slip_sinkage_reece") return lugs;
  if (name == "torque_offset" || name == "load_cell_tilt" || name == "sinkage_datum" || name == "slip_bias")
    return sensor;
  if (name == "skid_sinkage") return skid;
  if (family == "diameter" || family == "lateral_slip" || family == "load_transfer" ||
      name == "torque_offset_viscous")
    return whereItVaries;
  return always;
}

/// Adds, as one candidate, the forms that act simultaneously on a braked or sideways sliding wheel; each form
/// alone explains little.
void together(Collector& to) {
  const bool braked = to.extent("slip").low < -0.02, sideways = to.varies("slip_angle_rad");
  if (!braked && !sideways) return;
  std::vector<const char*> names;
  if (sideways) names = {"side_ploughing", "side_bulldozing_rough"};
  if (braked) names.push_back("skid_sinkage");
  names.push_back("slip_sinkage_linear");
  if (to.extent("grouser_height_m").high > 0.0) names.push_back("slip_sinkage_reece");
  for (const char* name : {"rear_fill", "bulldozing_ahead", "elastic_rebound"}) names.push_back(name);
  to.addTogether(names);
}

}  // namespace

std::vector<Candidate> libraryCandidates(const Trial& trial, const Eigen::VectorXd& sinkage_m) {
  Collector collector{trial, sinkage_m};
  for (const EffectForm& form : effectLibrary()) ruleOf(form)(collector, form);
  together(collector);
  return collector.take();
}

namespace {

Effect flatCurve(const char* name, const std::string& covariate, Channel channel,
                 const std::vector<double>& knots) {
  Effect curve;
  curve.name = name;
  curve.covariate = covariate;
  curve.channel = channel;
  curve.knots = knots;
  curve.parameters.assign(knots.size(), 0.0);
  return curve;
}

/// Returns a curve for each measured channel, and curves of soil stiffness and strength.
std::vector<Effect> curvesOf(const Trial& trial, const std::string& covariate,
                             const std::vector<double>& knots) {
  std::vector<Effect> all;
  for (const Channel channel : kAllChannels)
    if (trial.has(channel)) all.push_back(flatCurve("empirical", covariate, channel, knots));
  if (covariate == "slip_angle_rad") return all;
  all.push_back(flatCurve("empirical_stiffness", covariate, Channel::Sinkage, knots));
  all.push_back(flatCurve("empirical_strength", covariate, Channel::DrawbarPull, knots));
  return all;
}

void addCurves(const Trial& trial, const std::string& covariate, const std::vector<double>& knots,
               std::vector<Candidate>& all) {
  for (Effect& curve : curvesOf(trial, covariate, knots))
    all.push_back({{std::move(curve)}, "empirical", static_cast<int>(knots.size())});
}

/// Number of distinct pairs of run and value: a column that is constant within runs has one per run.
std::size_t independentValues(const Trial& trial, const Eigen::VectorXd& x) {
  std::set<std::pair<int, double>> values;
  for (Eigen::Index row = 0; row < x.size(); ++row)
    if (std::isfinite(x[row])) values.insert({trial.run[static_cast<std::size_t>(row)], x[row]});
  return values.size();
}

/// Returns the positions of a step: up to nine gaps between values at even shares of the rows. Each gap is
/// the widest within a twentieth of the rows.
std::vector<std::vector<double>> stepsOf(const Eigen::VectorXd& x) {
  const std::vector<double> v = finite(x);
  const int rows = static_cast<int>(v.size());
  std::set<std::pair<double, double>> gaps;
  for (int k = 1; k < 10 && rows > 20; ++k) {
    const int middle = k * rows / 10, reach = std::max(1, rows / 20);
    int widest = middle;
    for (int i = std::max(1, middle - reach); i <= std::min(rows - 1, middle + reach); ++i) {
      const auto width = [&](int j) {
        return v[static_cast<std::size_t>(j)] - v[static_cast<std::size_t>(j - 1)];
      };
      if (width(i) > width(widest)) widest = i;
    }
    const double low = v[static_cast<std::size_t>(widest - 1)], high = v[static_cast<std::size_t>(widest)];
    if (high > low) gaps.insert({low, high});
  }
  std::vector<std::vector<double>> knots;
  for (const auto& [low, high] : gaps) knots.push_back({low, high});
  return knots;
}

/// A constant for each group of a text column.
void addGroups(const Trial& trial, const std::string& column, std::vector<Candidate>& all) {
  std::set<std::string> labels;
  for (const WheelState& s : trial.states) labels.emplace(s.label(column));
  for (const Effect& shape : curvesOf(trial, "slip", {0.0})) {
    Candidate levels{{}, "empirical", static_cast<int>(labels.size())};
    for (const std::string& label : labels) {
      levels.parts.push_back(shape);
      levels.parts.back().only_column = column;
      levels.parts.back().only_value = label;
    }
    all.push_back(std::move(levels));
  }
}

/// Lines over products of an additional column that the effects `in` contain with another column: slip, load,
/// speed, or an additional one.
void addProducts(const Trial& trial, const std::vector<Effect>& in, std::vector<Candidate>& all) {
  const auto isIn = [&](const std::string& column) {
    return std::ranges::any_of(in, [&](const Effect& e) { return e.covariate == column; });
  };
  const auto& columns = trial.covariates;
  for (auto own = columns.begin(); own != columns.end(); ++own) {
    if (!isOwnColumn(*own)) continue;
    for (auto other = columns.begin(); other != columns.end(); ++other) {
      const bool set = *other == "slip" || *other == "load_N" || *other == "speed_mps";
      if (set ? !isIn(*own) : !isOwnColumn(*other) || other <= own || !(isIn(*own) || isIn(*other))) continue;
      const std::string product = *own + '*' + *other;  // (T30)
      const auto knots = quantileKnots(covariateValues(trial, product, {}), 2);
      if (knots.size() == 2) addCurves(trial, product, knots, all);
    }
  }
}

}  // namespace

double Candidate::logPrior() const {
  constexpr double kStep = -0.5 * 3.0;  // (T42) ln(1/20) = -3.0 in two steps
  if (empirical()) return kStep * (isProduct(covariate()) ? 3.0 : 2.0);
  const int further = parts.size() > 1 ? 0 : std::max(0, parameters - 1);  // forms found together: one by one
  return kStep * (0.5 * further + (family == "drift" ? 1.0 : 0.0));
}

Candidate formOf(const Effect& effect) {
  const EffectForm& form = *findEffect(effect.name);
  Candidate one{{effect}, form.family, 0};
  for (const EffectParameter& p : form.parameters) one.parameters += p.fitted;
  return one;
}

bool isProduct(const std::string& covariate) {
  return covariate.find('*') != std::string::npos;
}

bool isOwnColumn(const std::string& column) {
  const auto& known = stateColumns();
  return std::find(known.begin(), known.end(), column) == known.end();
}

double furtherQuestions(const Trial& trial) {
  const auto kept = std::count_if(trial.covariates.begin(), trial.covariates.end(), isOwnColumn) +
                    static_cast<long>(trial.groupings.size());
  return std::log1p(static_cast<double>(trial.dropped.size()) / std::max(1.0, static_cast<double>(kept)));
}

std::vector<Candidate> coarseCandidates(const Trial& trial, const std::string& column) {
  std::vector<Candidate> all;
  if (std::find(trial.groupings.begin(), trial.groupings.end(), column) != trial.groupings.end()) {
    addGroups(trial, column, all);
  } else {
    const auto knots = quantileKnots(covariateValues(trial, column, {}), 4);
    if (knots.size() > 1) addCurves(trial, column, knots, all);
  }
  std::erase_if(all, [](const Candidate& c) { return c.parts.front().name != "empirical"; });
  return all;
}

std::vector<Candidate> empiricalCandidates(const Trial& trial, const std::vector<Effect>& in) {
  std::vector<Candidate> all;
  for (const std::string& name : trial.covariates) {
    if (isTwin(trial, name)) continue;
    const Eigen::VectorXd x = covariateValues(trial, name, {});
    const std::size_t independent = independentValues(trial, x);
    std::size_t coarser = 1;
    for (int most : {2, 4, 7, 13}) {
      const auto knots = quantileKnots(x, most);  // (T29)
      if (knots.size() <= coarser || 4 * static_cast<int>(knots.size()) > trial.rows() ||
          3 * knots.size() > independent)
        continue;
      coarser = knots.size();
      addCurves(trial, name, knots, all);
    }
    if (name == "time_s" || name == "heading_rad" || isOwnColumn(name))
      for (const auto& knots : stepsOf(x))
        if (coarser > 2) addCurves(trial, name, knots, all);
  }
  addProducts(trial, in, all);
  for (const std::string& column : trial.groupings) addGroups(trial, column, all);
  return all;
}

}  // namespace talus::terramech
