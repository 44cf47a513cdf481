#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>
#include <vector>

#include <talus/terramech/calibration/table/closure_offset.hpp>

namespace talus::terramech {
namespace {

constexpr double kAccuracy = 0.03;  // error of the relation over soils [-]

struct Split {
  double inside = 0.0, outside = 0.0, squares = 0.0;  // sums of errors, and of squared errors inside the
                                                      // group
  int in = 0, out = 0;
  double meanStd() const {
    const double mean = inside / in, variance = std::max(0.0, squares / in - mean * mean) * in / (in - 1.0);
    return std::hypot(std::sqrt(variance / in), kAccuracy / std::numbers::sqrt3);
  }
  double gap() const { return in >= 4 && out >= 4 ? std::abs(inside / in - outside / out) : 0.0; }
};

Split splitBy(const std::vector<double>& errors, const std::vector<char>& member) {
  Split s;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (!std::isfinite(errors[i])) continue;
    (member[i] ? s.inside : s.outside) += errors[i];
    ++(member[i] ? s.in : s.out);
    if (member[i]) s.squares += errors[i] * errors[i];
  }
  return s;
}

}  // namespace

std::vector<double> closureErrors(const Trial& trial) {
  std::vector<double> errors;
  for (int row = 0; row < trial.rows(); ++row) {
    const double pull = trial.measured(row, 0), z = trial.measured(row, 1), torque = trial.measured(row, 2);
    const double entry = std::acos(std::clamp(1.0 - z, 0.0, 1.0 - 1e-9));
    const double arc = std::sin(0.25 * entry) / (0.25 * entry);
    // (T47)
    errors.push_back(pull + std::tan(0.5 * entry) - arc * arc / std::cos(0.5 * entry) * torque);
  }
  return errors;
}

std::optional<ClosureOffset> findClosureOffset(const Trial& trial, std::uint64_t seed) {
  constexpr double kLeast = 2.0 * kAccuracy;
  constexpr int kShuffles = 1999;
  const std::vector<double> errors = closureErrors(trial);
  std::optional<ClosureOffset> found;
  std::vector<char> chosen;
  double widest = kLeast;
  for (const std::string& column : trial.groupings) {
    std::set<std::string> labels;
    for (const WheelState& s : trial.states) labels.emplace(s.label(column));
    for (const std::string& label : labels) {
      std::vector<char> member;
      for (const WheelState& s : trial.states) member.push_back(s.label(column) == label);
      const Split s = splitBy(errors, member);
      const bool off = s.in > 0 && s.out > 0 && std::abs(s.inside / s.in) > std::abs(s.outside / s.out);
      if (!off || s.gap() <= widest) continue;
      widest = s.gap();
      chosen = member;
      found = ClosureOffset{column, label, s.inside / s.in, s.meanStd(), 1.0};
    }
  }
  if (!found) return {};
  std::mt19937_64 random(seed);
  int as_wide = 0;
  for (int shuffle = 0; shuffle < kShuffles; ++shuffle) {
    for (std::size_t i = chosen.size(); i-- > 1;) std::swap(chosen[i], chosen[random() % (i + 1)]);
    as_wide += splitBy(errors, chosen).gap() >= widest * (1.0 - 1e-12);
  }
  found->p_value = (1.0 + as_wide) / (1.0 + kShuffles);
  return found->p_value <= 0.01 ? found : std::nullopt;
}

}  // namespace talus::terramech
