#pragma once

#include <vector>

#include <talus/planner/simulation/drive/traverse_simulation.hpp>

namespace talus::planner {

/// Errors of a map's predictions along a drive.
struct PredictionErrors {
  int steps = 0;              ///< number of steps
  double slip_rmse = 0.0;     ///< root mean square slip error over all steps [-]
  double energy_rmse = 0.0;   ///< RMS error of energy per metre, relative to the mean true value [-]
  double energy_error = 0.0;  ///< (predicted - true) / true energy of the whole drive [-]
};

/// Log of the steps of a simulated drive; pass record() as SimulationOptions::on_step.
class TraverseLog {
 public:
  /// Appends a step.
  void record(const TraverseStep& step) { steps_.push_back(step); }

  /// All recorded steps in order.
  const std::vector<TraverseStep>& steps() const noexcept { return steps_; }

  /// Errors over the recorded steps; zeros without steps or if the true energy is not positive.
  PredictionErrors errors() const;

 private:
  std::vector<TraverseStep> steps_;
};

}  // namespace talus::planner
