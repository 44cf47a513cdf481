#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>

#include <Eigen/Eigenvalues>

#include <talus/common/limits.hpp>
#include <talus/common/nearest_name.hpp>
#include <talus/terramech/io/model_file.hpp>
#include <talus/terramech/io/soil_library.hpp>
#include <talus/terramech/numerics/functions.hpp>
#include <talus/terramech/terramech_io.hpp>

namespace talus::terramech {

namespace {

/// Returns why a row-major matrix is not a covariance; empty if the matrix is a covariance. A negative
/// variance would count as an exact value.
std::string faultOfCovariance(const std::vector<double>& values, std::size_t size) {
  const auto n = static_cast<Eigen::Index>(size);
  const Eigen::MatrixXd given = Eigen::Map<const Eigen::MatrixXd>(values.data(), n, n);
  constexpr double kRounding =
      1e-6;  // rounding tolerance of a correlation, for an inverse of condition number 1e10 and 17 digits in
             // the file
  Eigen::MatrixXd correlation = given;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (given(i, i) < 0.0)
      return "has the negative variance " + std::to_string(given(i, i)) + " in row " + std::to_string(i + 1);
    for (Eigen::Index k = 0; k < n; ++k) {
      const double scale = std::sqrt(given(i, i)) * std::sqrt(std::max(given(k, k), 0.0));
      if (std::abs(given(i, k) - given(k, i)) > kRounding * scale)
        return "is not symmetric in row " + std::to_string(i + 1);
      if (std::abs(given(i, k)) > (1.0 + kRounding) * scale)
        return "has a correlation beyond 1 in row " + std::to_string(i + 1);
      correlation(i, k) = scale > 0.0 ? given(i, k) / scale : 0.0;
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(correlation, Eigen::EigenvaluesOnly);
  if (n > 0 && !(solver.eigenvalues().minCoeff() >= -kRounding * static_cast<double>(n)))
    return "gives a combination of the parameters a negative variance (it is not positive semidefinite)";
  return "";
}

}  // namespace

void readFit(const YamlFields& root, RefinedModel& model) {
  for (const YamlFields& f : root.list("fitted")) {
    f.only({"effect", "index"});
    model.fitted.push_back({f.integer("effect"), f.integer("index")});
    const auto& p = model.fitted.back();
    const bool known =
        p.effect < 0
            ? p.index >= 0 && p.index < static_cast<int>(soilParameters().size())
            : p.effect < static_cast<int>(model.effects.size()) && p.index >= 0 &&
                  p.index <
                      static_cast<int>(model.effects[static_cast<std::size_t>(p.effect)].parameters.size());
    if (!known)
      f.refuse("index",
               "effect " + std::to_string(p.effect) + ", index " + std::to_string(p.index) +
                   " names no fitted parameter of this model",
               "fit it once more: talus trace --model-out");
    const auto same = [&](const FittedParameter& q) { return q.effect == p.effect && q.index == p.index; };
    if (std::ranges::count_if(model.fitted, same) > 1)
      f.refuse("index", "names a parameter of `fitted` a second time",
               "remove it, and its row of the covariance");
  }
  model.covariance = root.numbers("covariance", true);
  if (model.covariance.size() != model.fitted.size() * model.fitted.size())
    root.refuse("covariance",
                "covariance has " + std::to_string(model.covariance.size()) + " numbers, must have " +
                    std::to_string(model.fitted.size() * model.fitted.size()) +
                    ", the square of the number of fitted parameters",
                "fit it once more: talus trace --model-out");
  if (const std::string fault = faultOfCovariance(model.covariance, model.fitted.size()); !fault.empty())
    root.refuse("covariance", "covariance " + fault, "write the model by talus trace --model-out");
}

void setSoil(RefinedModel& model, const SoilPrior& prior) {
  model.soil = prior.mean;
  model.soil_prior_mean.clear();
  model.soil_prior_std.clear();
  const SoilDeviation& d = prior.deviation;
  for (const SoilParameter& p : soilParameters()) {
    model.soil_prior_mean[p.name] = p.get(prior.mean);
    for (const SoilField& field : soilFields())
      if (field.value == p.field && d.*field.deviation > 0.0)
        model.soil_prior_std[p.name] = d.*field.deviation;
  }
  const double width = model.wheel.value_or(Wheel{}).width_m;
  const double stiffness = std::hypot(d.cohesive_modulus / width, d.frictional_modulus);
  if (stiffness > 0.0) model.soil_prior_std["log_stiffness"] = stiffness / sinkageModulus(prior.mean, width);
}

namespace {

constexpr const char* kColumn[] = {"drawbar_pull_N", "sinkage_m", "torque_Nm", "side_force_N"};
constexpr const char* kRelative[] = {"drawbar_pull_relative", "sinkage_relative", "torque_relative",
                                     "side_force_relative"};

void readSoilInto(const YamlFields& root, RefinedModel& model) {
  setSoil(model, root.isMapping("soil") ? readSoil(root.fields("soil")) : loadSoilPrior(root.word("soil")));
}

/// Returns the initial soil of a fit if none is given.
Soil startingSoil() {
  return {.name = "fitted",
          .cohesion_Pa = 1000.0,
          .friction_angle_rad = 0.55,
          .sinkage_exponent = 1.0,
          .cohesive_modulus = 0.0,
          .frictional_modulus = 1e6,
          .shear_modulus_m = 0.015};
}

Wheel readWheel(const YamlFields& f) {
  f.only({"radius_m", "width_m", "grouser_height_m", "grouser_count"});
  Wheel wheel{f.number("radius_m"), f.number("width_m"), f.number("grouser_height_m", 0.0),
              f.integer("grouser_count", 0)};
  try {
    validate(wheel);
  } catch (const std::invalid_argument& e) {
    f.refuse(e);
  }
  return wheel;
}

std::optional<double> positive(const YamlFields& f, const char* name) {
  if (!f.has(name)) return {};
  const double value = f.number(name);
  if (!(value >= 0.0) || !std::isfinite(value))
    f.refuse(name, std::string(name) + " must be a standard deviation >= 0", "correct the value");
  return value;
}

StatedSensors readSensors(const YamlFields& f) {
  f.only({"load_N", "slip", "torque_Nm", "sinkage_m", "drawbar_pull_N", "side_force_N"});
  return {positive(f, "load_N"),    positive(f, "slip"),           positive(f, "torque_Nm"),
          positive(f, "sinkage_m"), positive(f, "drawbar_pull_N"), positive(f, "side_force_N")};
}

SensorNoise readNoise(const YamlFields& f) {
  SensorNoise noise;
  std::vector<std::string> known{"slip", "slip_relative", "load_relative"};
  for (int c = 0; c < kChannels; ++c) {
    known.emplace_back(kColumn[c]);
    known.emplace_back(kRelative[c]);
  }
  f.only(known);
  const auto deviation = [&](const char* name) { return positive(f, name).value_or(0.0); };
  for (std::size_t c = 0; c < kChannels; ++c) {
    noise.absolute[c] = deviation(kColumn[c]);
    noise.relative[c] = deviation(kRelative[c]);
  }
  noise.slip_absolute = deviation("slip");
  noise.slip_relative = deviation("slip_relative");
  noise.load_relative = deviation("load_relative");
  return noise;
}

Channel readChannel(const YamlFields& f) {
  const std::string word = f.word("channel");
  for (Channel c : kAllChannels)
    if (word == name(c)) return c;
  f.refuse(
      "channel", "'" + word + "' is not a channel",
      "one of drawbar_pull_over_load, sinkage_over_radius, torque_over_load_radius, side_force_over_load");
}

Effect readEffect(const YamlFields& f) {
  f.only({"name", "covariate", "channel", "parameters", "knots", "only"});
  Effect effect;
  effect.name = f.word("name");
  effect.parameters = f.numbers("parameters");
  effect.knots = f.numbers("knots");
  if (f.has("only")) {
    effect.only_column = f.fields("only").word("column");
    effect.only_value = f.fields("only").word("value");
  }
  const EffectForm* form = findEffect(effect.name);
  if (!form && !effect.empirical()) {
    std::vector<std::string> names;
    for (const EffectForm& known : effectLibrary()) names.emplace_back(known.name);
    const std::string nearest = nearestName(effect.name, names);
    std::string all;
    for (const std::string& known : names) all += (all.empty() ? "" : ", ") + known;
    f.refuse("name", "no effect '" + effect.name + "'",
             nearest.empty() ? "name one of " + all : "did you mean " + nearest + "?");
  }
  effect.covariate = form ? f.word("covariate", form->covariate) : f.word("covariate");
  effect.channel = form && !f.has("channel") ? form->channel : readChannel(f);
  const std::size_t wanted = form ? form->parameters.size() : effect.knots.size();
  if (effect.parameters.size() != wanted || wanted == 0)
    if (!form || wanted != effect.parameters.size())
      f.refuse("parameters",
               "effect '" + effect.name + "' has " + std::to_string(effect.parameters.size()) +
                   " parameters, must have " + std::to_string(wanted),
               "write parameters: [..], one number each");
  try {
    for (std::size_t k = 0; form && k < form->parameters.size(); ++k)
      RangeCheck{effect.name}.within(form->parameters[k].name, effect.parameters[k],
                                     {form->parameters[k].low, form->parameters[k].high});
  } catch (const std::invalid_argument& e) {
    f.refuse(e);
  }
  if (form && !effect.knots.empty() && (effect.knots.size() != 2 || !(effect.knots[0] <= effect.knots[1])))
    f.refuse("knots", "knots of effect '" + effect.name + "' must be the two ends of its range, low <= high",
             "write knots: [low, high]");
  return effect;
}

/// Reads one number >= 0 per channel.
std::array<double, kChannels> readChannels(const YamlFields& f, const char* name) {
  const std::vector<double> values = f.numbers(name);
  if (values.size() != kChannels ||
      std::any_of(values.begin(), values.end(), [](double v) { return !(v >= 0.0); }))
    f.refuse(name, std::string(name) + " must be one number >= 0 for each channel",
             "write a list of " + std::to_string(kChannels));
  std::array<double, kChannels> all{};
  std::copy(values.begin(), values.end(), all.begin());
  return all;
}

std::vector<TrainedRange> readTrained(const YamlFields& root) {
  std::vector<TrainedRange> all;
  for (const YamlFields& f : root.list("trained")) {
    f.only({"column", "range", "below", "above", "reach_below", "reach_above"});
    const std::vector<double> range = f.numbers("range");
    if (range.size() != 2 || !(range[0] <= range[1]))
      f.refuse("range", "range must be two numbers, low <= high", "write range: [low, high]");
    TrainedRange one{.column = f.word("column"), .low = range[0], .high = range[1]};
    one.below = readChannels(f, "below");
    one.above = readChannels(f, "above");
    if (f.has("reach_below")) one.reach_below = readChannels(f, "reach_below");
    if (f.has("reach_above")) one.reach_above = readChannels(f, "reach_above");
    const auto same = [&](const TrainedRange& other) { return other.column == one.column; };
    if (std::ranges::any_of(all, same))
      f.refuse("column", "column '" + shortened(one.column) + "' is trained a second time", "keep one range");
    all.push_back(one);
  }
  return all;
}

/// Reads the model without corrections, and the channels to which corrections apply.
void readUncorrected(const YamlFields& f, ModelFile& file) {
  f.only({"soil", "effects", "kept"});
  RefinedModel base = file.model;
  base.fitted.clear();
  base.covariance.clear();
  readSoilInto(f, base);
  base.effects = readEffects(f);
  const auto kept = readChannels(f, "kept");
  for (std::size_t c = 0; c < kChannels; ++c) file.scope.kept[c] = kept[c] > 0.0;
  file.scope.base = std::move(base);
}

BaseModel readBase(const YamlFields& root) {
  const std::string word = root.word("model", "wong-reece");
  if (word == "wong-reece") return BaseModel::WongReece;
  if (word == "linear-formula") return BaseModel::LinearFormula;
  root.refuse("model", "no model '" + word + "'", "wong-reece or linear-formula");
}

}  // namespace

std::vector<Effect> readEffects(const YamlFields& root) {
  std::vector<Effect> effects;
  for (const YamlFields& f : root.list("effects")) effects.push_back(readEffect(f));
  return effects;
}

ModelFile unknownSoil() {
  ModelFile file;
  file.soil_given = false;
  file.model.soil = startingSoil();
  return file;
}

ModelFile loadModel(const std::string& path) {
  ModelFile file;
  const YamlFields root =
      std::filesystem::exists(path) ? YamlFields::file(path) : YamlFields::text("{}", path);
  const bool is_model = root.has("model") || root.has("effects") || root.has("sensors") || root.has("soil");
  if (!is_model) {
    setSoil(file.model, loadSoilPrior(path));
    return file;
  }
  root.only({"name", "soil", "model", "sensors", "wheel", "gravity_m_s2", "slip_along_travel", "effects",
             "noise", "fitted", "covariance", "trained", "base"});
  RefinedModel& model = file.model;
  model.base = readBase(root);
  if (root.has("wheel")) model.wheel = readWheel(root.fields("wheel"));
  model.gravity_m_s2 = root.number("gravity_m_s2", model.gravity_m_s2);
  if (model.gravity_m_s2 <= 0.0) root.refuse("gravity_m_s2", "gravity_m_s2 must be > 0", "correct it");
  file.soil_given = root.has("soil");
  if (file.soil_given)
    readSoilInto(root, model);
  else
    model.soil = startingSoil();
  model.slip_along_travel = root.flag("slip_along_travel", false);
  if (root.has("sensors")) model.stated = readSensors(root.fields("sensors"));
  if (root.has("noise")) model.noise = readNoise(root.fields("noise"));
  model.effects = readEffects(root);
  if (root.has("fitted")) readFit(root, model);
  file.scope.trained = readTrained(root);
  if (root.has("base")) readUncorrected(root.fields("base"), file);
  return file;
}

namespace {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

/// Returns the number, or 0 if its magnitude is too small for a file.
double readable(double value) {
  return std::abs(value) < 1.0 && !plausible(value) ? 0.0 : value;
}

class Writer {
 public:
  Writer() { out_.precision(17); }

  template <class T>
  Writer& operator<<(const T& value) {
    if constexpr (std::is_same_v<T, double>) return out_ << readable(value), *this;
    out_ << value;
    return *this;
  }

  void list(const char* key, const std::vector<double>& values) {
    out_ << key << ": [";
    for (std::size_t k = 0; k < values.size(); ++k) out_ << (k ? ", " : "") << readable(values[k]);
    out_ << "]";
  }

  std::string text() const { return out_.str(); }

 private:
  std::ostringstream out_;
};

/// Sets variances too small for a file to 0, with their covariances; the parameter is then exact.
std::vector<double> readableCovariance(std::vector<double> covariance, std::size_t count) {
  for (std::size_t k = 0; k < count; ++k)
    if (readable(covariance[k * count + k]) == 0.0)
      for (std::size_t j = 0; j < count; ++j) covariance[k * count + j] = covariance[j * count + k] = 0.0;
  return covariance;
}

void writeSoil(Writer& w, const Soil& s, const std::string& indent = "") {
  w << indent << "soil:\n" << indent << "  name: " << quoted(s.name) << "\n";
  for (const SoilField& field : soilFields())
    w << indent << "  " << field.name << ": " << s.*field.value << "\n";
}

void writeEffect(Writer& w, const Effect& e, const std::string& indent) {
  const EffectForm* form = findEffect(e.name);
  if (form) w << indent << "  # " << form->formula << "\n";
  w << indent << "  - name: " << e.name << "\n"
    << indent << "    covariate: " << quoted(e.covariate) << "\n"
    << indent << "    channel: " << name(e.channel) << "\n"
    << indent << "    ";
  w.list("parameters", e.parameters);
  if (form && !form->parameters.empty()) {
    w << "  #";
    for (const EffectParameter& p : form->parameters) w << ' ' << p.name << " [" << p.unit << ']';
  }
  if (!e.knots.empty()) {
    w << "\n" << indent << "    ";
    w.list("knots", e.knots);
  }
  if (!e.only_column.empty())
    w << "\n"
      << indent << "    only: {column: " << quoted(e.only_column) << ", value: " << quoted(e.only_value)
      << "}";
  w << "\n";
}

void writeEffects(Writer& w, const std::vector<Effect>& effects, const std::string& indent = "") {
  if (!effects.empty()) w << indent << "effects:\n";
  for (const Effect& e : effects) writeEffect(w, e, indent);
}

void writeNoise(Writer& w, const SensorNoise& n) {
  w << "noise:\n";
  for (std::size_t c = 0; c < kChannels; ++c)
    w << "  " << kColumn[c] << ": " << n.absolute[c] << "\n  " << kRelative[c] << ": " << n.relative[c]
      << "\n";
  w << "  slip: " << n.slip_absolute << "\n  slip_relative: " << n.slip_relative
    << "\n  load_relative: " << n.load_relative << "\n";
}

}  // namespace

std::string modelText(const RefinedModel& model, const ModelScope& scope) {
  Writer w;
  w << "model: " << (model.base == BaseModel::WongReece ? "wong-reece" : "linear-formula") << "\n";
  writeSoil(w, model.soil);
  if (model.wheel)
    w << "wheel: {radius_m: " << model.wheel->radius_m << ", width_m: " << model.wheel->width_m
      << ", grouser_height_m: " << model.wheel->grouser_height_m
      << ", grouser_count: " << model.wheel->grouser_count << "}\n";
  w << "gravity_m_s2: " << model.gravity_m_s2 << "\n";
  w << "slip_along_travel: " << (model.slip_along_travel ? "true" : "false") << "\n";
  writeEffects(w, model.effects);
  writeNoise(w, model.noise);
  if (!scope.trained.empty()) w << "trained:\n";
  for (const TrainedRange& t : scope.trained) {
    w << "  - column: " << quoted(t.column) << "\n    ";
    w.list("range", {t.low, t.high});
    w << "\n    ";
    w.list("below", {t.below.begin(), t.below.end()});
    w << "\n    ";
    w.list("above", {t.above.begin(), t.above.end()});
    w << "\n    ";
    w.list("reach_below", {t.reach_below.begin(), t.reach_below.end()});
    w << "\n    ";
    w.list("reach_above", {t.reach_above.begin(), t.reach_above.end()});
    w << "\n";
  }
  if (scope.base) {
    w << "base:\n";
    writeSoil(w, scope.base->soil, "  ");
    writeEffects(w, scope.base->effects, "  ");
    w.list("  kept", {scope.kept.begin(), scope.kept.end()});
    w << "  # channels in which held-out rows confirmed the corrections\n";
  }
  if (model.covariance.empty()) return w.text();
  w << "fitted:\n";
  for (const FittedParameter& p : model.fitted)
    w << "  - {effect: " << p.effect << ", index: " << p.index << "}\n";
  w.list("covariance", readableCovariance(model.covariance, model.fitted.size()));
  w << "\n";
  return w.text();
}

}  // namespace talus::terramech
