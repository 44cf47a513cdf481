#pragma once

#include <vector>

#include <talus/planner/simulation/drive/traverse_simulation.hpp>

namespace talus::planner {

/// How far a map's predictions were off along a drive.
struct PredictionErrors {
  int steps = 0;
  double slip_rmse = 0.0;     ///< over steps [-]
  double energy_rmse = 0.0;   ///< of a step's energy a metre, over the mean of the true one [-]
  double energy_error = 0.0;  ///< predicted less true energy of the whole drive, over the true one [-]
};

/// The steps of one simulated drive: give record() to SimulationOptions::on_step.
class DriveLog {
 public:
  void record(const DriveStep& step) { steps_.push_back(step); }

  const std::vector<DriveStep>& steps() const noexcept { return steps_; }

  PredictionErrors errors() const;

 private:
  std::vector<DriveStep> steps_;
};

}  // namespace talus::planner
