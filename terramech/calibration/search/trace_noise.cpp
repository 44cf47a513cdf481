#include <algorithm>
#include <cmath>

#include <talus/terramech/calibration/noise/input_calibration.hpp>
#include <talus/terramech/calibration/noise/run_units.hpp>
#include <talus/terramech/calibration/search/trace_search.hpp>

namespace talus::terramech {

void TraceSearch::backToMeasured() {
  for (std::size_t row = 0; row < trial_.states.size(); ++row) {
    setSlip(trial_.states[row], trial_.slip[row]);
    trial_.states[row].load_N = trial_.load_N[row];
  }
}

StatedSensors TraceSearch::knownSensors() const {
  StatedSensors sensors = model_.stated;
  if (!set_load_ || sensors.load_N) return sensors;
  std::vector<double> load = trial_.load_N;
  std::nth_element(load.begin(), load.begin() + static_cast<long>(load.size() / 2), load.end());
  sensors.load_N = set_load_->errorStd() * load[load.size() / 2];
  return sensors;
}

void TraceSearch::settle(const Eigen::MatrixXd& noise_alone, const Eigen::MatrixXd& level,
                         const InputSlopes& measured_slopes) {
  backToMeasured();
  model_.noise = fitNoise(trial_, noise_alone, level, measured_slopes, knownSensors());
  calibrateInputs(trial_, model_.noise, set_load_);
  level_ = predictRows(model_, trial_, solved_);
  residual_ = trial_.measured - level_;
  const InputSlopes slopes = inputSlopes(model_, trial_, solved_);
  by_slip_.reset();
  const Eigen::VectorXd shared = sharedSlipStd(trial_, model_.noise);
  if (shared.size() > 0) by_slip_ = shared.asDiagonal() * slopes.by_slip;
  whitening_ = whitening(trial_, level_, slopes, model_.noise);
}

void TraceSearch::shareWithin(Eigen::MatrixXd smooth, const Eigen::MatrixXd& level,
                              const InputSlopes& measured_slopes) {
  std::vector<std::string> timeless;
  for (const std::string& column : noiseColumns(trial_))
    if (column != "time_s") timeless.push_back(column);
  const std::vector<int> unit = runUnits(trial_, whitening_, withoutSmooth(trial_, residual_, timeless));
  if (!unit.empty()) {  // what rows share is no noise of theirs
    const double rows = trial_.rows(), kept = rows - (*std::max_element(unit.begin(), unit.end()) + 1);
    smooth -= unitMeans(smooth, whitening_.std, unit);
    if (kept > 4.0) settle(std::sqrt(rows / kept) * smooth, level, measured_slopes);
  }
  whitening_.unit = unit;
  if (unit.empty()) return;
  whitening_.run = roughRunError(whitening_);
  SolvedContacts solved = solved_;
  whitening_.run = runErrorOf(standing(model_, residual_, solved));
}

/// A smooth of measured loads would follow the errors about the set ones, and the noise would miss them: it is had from
/// the set loads.
void TraceSearch::findSetLoads(const Eigen::MatrixXd& measured, const InputSlopes& slopes) {
  std::vector<std::string> others = noiseColumns(trial_);
  std::erase(others, "load_N");
  set_load_ = nominalLoad(trial_, withoutSmooth(trial_, measured, others), slopes);
  for (int row = 0; set_load_ && row < trial_.rows(); ++row) {
    const auto r = static_cast<std::size_t>(row);
    trial_.states[r].load_N = set_load_->load_N(row, trial_.load_N[r]);
  }
}

void TraceSearch::refresh() {
  backToMeasured();
  const Eigen::MatrixXd level = predictRows(model_, trial_, solved_);
  const InputSlopes slopes = inputSlopes(model_, trial_, solved_);
  const Eigen::MatrixXd measured = trial_.measured - level;
  // Whatever its error, a slip that varies much is seen; only where that is in doubt must the error be known.
  const SensorNoise unlimited{.slip_relative = 1.0};
  const auto isSeen = [&](const SensorNoise& n) { return slipIsSeen(trial_, n) && speedIsSeen(trial_, n); };
  findSetLoads(measured, slopes);
  Eigen::MatrixXd smooth = withoutSmooth(trial_, measured, noiseColumns(trial_));
  if (!isSeen(unlimited)) {
    const Eigen::MatrixXd left = withoutSmooth(trial_, measured, allButSlip(trial_));
    if (!isSeen(fitNoise(trial_, left, level, slopes, model_.stated))) smooth = left;
  }
  settle(smooth, level, slopes);
  shareWithin(smooth, level, slopes);
  white_ = whitening_.apply(residual_);
  misfit_ = misfitOf(white_, trial_);
}

}  // namespace talus::terramech
