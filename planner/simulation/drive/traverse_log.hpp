#pragma once

#include <vector>

#include <talus/planner/simulation/drive/traverse_simulation.hpp>

namespace talus::planner {

/// Errors of the predictions of a map along a drive.
struct PredictionErrors {
  int steps = 0;           ///< number of steps of the drive
  double slip_rmse = 0.0;  ///< root mean square error of the predicted slip over all steps [-]
  /// Root mean square error of energy per metre, over the mean true energy per metre [-].
  double energy_rmse = 0.0;
  double energy_error = 0.0;  ///< (predicted - true) / true energy of the whole drive [-]
};

/// Log of the steps of a simulated drive. The function record() is called by SimulationOptions::on_step.
class TraverseLog {
 public:
  /// Appends a step.
  void record(const TraverseStep& step) { steps_.push_back(step); }

  /// Returns all recorded steps in order.
  const std::vector<TraverseStep>& steps() const noexcept { return steps_; }

  /// Returns the prediction errors over the recorded steps. The errors are 0 if there are no steps or if the
  /// true energy is not positive.
  PredictionErrors errors() const;

 private:
  std::vector<TraverseStep> steps_;
};

}  // namespace talus::planner
