#include <cmath>

#include <talus/planner/simulation/drive/traverse_log.hpp>

namespace talus::planner {

PredictionErrors TraverseLog::errors() const {
  PredictionErrors e{.steps = static_cast<int>(steps_.size())};
  double slip = 0.0, energy = 0.0, expected_J = 0.0, true_J = 0.0, length_m = 0.0;
  for (const TraverseStep& s : steps_) {
    const double surface_m = s.length_m * std::hypot(1.0, s.gradient);
    slip += std::pow(s.expected_slip - s.truth.slip, 2);
    energy += std::pow(s.expected_energy_J_per_m - s.truth.energy_J_per_m, 2);
    expected_J += s.expected_energy_J_per_m * surface_m;
    true_J += s.truth.energy_J_per_m * surface_m;
    length_m += surface_m;
  }
  if (steps_.empty() || true_J <= 0.0) return e;
  const auto n = static_cast<double>(steps_.size());
  e.slip_rmse = std::sqrt(slip / n);
  e.energy_rmse = std::sqrt(energy / n) / (true_J / length_m);
  e.energy_error = expected_J / true_J - 1.0;
  return e;
}

}  // namespace talus::planner
