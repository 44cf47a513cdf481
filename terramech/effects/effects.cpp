#include <algorithm>
#include <unordered_map>

#include <talus/terramech/effects/effects.hpp>

namespace talus::terramech {

const char* name(Channel channel) {
  switch (channel) {
    case Channel::DrawbarPull:
      return "drawbar_pull_over_load";
    case Channel::Sinkage:
      return "sinkage_over_radius";
    case Channel::Torque:
      return "torque_over_load_radius";
    case Channel::SideForce:
      return "side_force_over_load";
  }
  return "";
}

double Reading::denominator(Channel channel) const {
  switch (channel) {
    case Channel::Sinkage:
      return radius_m;
    case Channel::Torque:
      return load_N * radius_m;
    case Channel::DrawbarPull:
    case Channel::SideForce:
      break;
  }
  return load_N;
}

double Reading::scaled(Channel channel) const {
  switch (channel) {
    case Channel::DrawbarPull:
      return drawbar_pull_N / load_N;
    case Channel::Sinkage:
      return sinkage_m / radius_m;
    case Channel::Torque:
      return torque_Nm / (load_N * radius_m);
    case Channel::SideForce:
      return side_force_N / load_N;
  }
  return 0.0;
}

void Reading::addScaled(Channel channel, double value) {
  switch (channel) {
    case Channel::DrawbarPull:
      drawbar_pull_N += value * load_N;
      break;
    case Channel::Sinkage:
      sinkage_m += value * radius_m;
      break;
    case Channel::Torque:
      torque_Nm += value * load_N * radius_m;
      break;
    case Channel::SideForce:
      side_force_N += value * load_N;
      break;
  }
}

bool knowsPasses(std::span<const Effect> effects) {
  return std::any_of(effects.begin(), effects.end(),
                     [](const Effect& e) { return e.covariate == "pass_index"; });
}

const std::vector<EffectForm>& effectLibrary() {
  static const std::vector<EffectForm> library = [] {
    std::vector<EffectForm> all;
    for (auto part : {detail::contactEffects, detail::diggingEffects, detail::forceEffects,
                      detail::sensorEffects, detail::driftEffects})
      for (EffectForm& form : part()) all.push_back(std::move(form));
    return all;
  }();
  return library;
}

const EffectForm* findEffect(std::string_view name) {
  static const std::unordered_map<std::string_view, const EffectForm*> by_name = [] {
    std::unordered_map<std::string_view, const EffectForm*> all;
    for (const EffectForm& form : effectLibrary()) all.emplace(form.name, &form);
    return all;
  }();
  const auto found = by_name.find(name);
  return found == by_name.end() ? nullptr : found->second;
}

namespace {

/// Second derivatives at the knots of the natural cubic spline (tridiagonal system, Thomas' algorithm).
std::vector<double> curvatures(std::span<const double> x, std::span<const double> y) {
  const std::size_t n = x.size();
  std::vector<double> m(n, 0.0), upper(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double a = x[i] - x[i - 1], b = x[i + 1] - x[i];
    const double pivot = 2.0 * (a + b) - a * upper[i - 1];
    upper[i] = b / pivot;
    m[i] = (6.0 * ((y[i + 1] - y[i]) / b - (y[i] - y[i - 1]) / a) - a * m[i - 1]) / pivot;
  }
  for (std::size_t i = n; i-- > 2;) m[i - 1] -= upper[i - 1] * m[i];
  return m;
}

}  // namespace

NaturalSpline::NaturalSpline(std::vector<double> knots, std::vector<double> values)
    : knots_(std::move(knots)), values_(std::move(values)), curvatures_(curvatures(knots_, values_)) {}

double NaturalSpline::operator()(double x) const {
  const std::size_t n = knots_.size();
  if (n == 0) return 0.0;
  if (n == 1 || x <= knots_.front()) return values_.front();
  if (x >= knots_.back()) return values_.back();
  std::size_t i = 0;
  while (x > knots_[i + 1]) ++i;
  const double h = knots_[i + 1] - knots_[i], b = (x - knots_[i]) / h, a = 1.0 - b;
  return a * values_[i] + b * values_[i + 1] +
         ((a * a * a - a) * curvatures_[i] + (b * b * b - b) * curvatures_[i + 1]) * h * h / 6.0;
}

}  // namespace talus::terramech
