#include <algorithm>
#include <string>
#include <vector>

#include <talus/terramech/calibration/noise/input_calibration.hpp>
#include <talus/terramech/calibration/noise/run_units.hpp>
#include <talus/terramech/calibration/noise/sensor_noise.hpp>
#include <talus/terramech/calibration/search/calibrated_rows.hpp>
#include <talus/terramech/numerics/median.hpp>

namespace talus::terramech {

Eigen::VectorXd CalibratedRows::sinkages_m() const {
  Eigen::VectorXd z(level_.rows());
  for (int row = 0; row < trial_.rows(); ++row)
    z[row] = level_(row, static_cast<int>(Channel::Sinkage)) * trial_.denominator(row, Channel::Sinkage);
  return z;
}

void CalibratedRows::backToMeasured() {
  for (std::size_t row = 0; row < trial_.states.size(); ++row) {
    setSlip(trial_.states[row], trial_.slip[row]);
    trial_.states[row].load_N = trial_.load_N[row];
  }
}

/// The stated errors. An error of the load that is not stated has the scatter about set loads as its prior.
StatedSensors CalibratedRows::knownSensors(const RefinedModel& model) const {
  StatedSensors sensors = model.stated;
  const auto set = setLoads(trial_);
  if (set && !sensors.load_N) sensors.load_N = set->scatter * medianOf(trial_.load_N);
  return sensors;
}

void CalibratedRows::settle(const Eigen::MatrixXd& noise_alone, const Eigen::MatrixXd& level,
                            const InputSlopes& measured_slopes, RefinedModel& model, SolvedContacts& solved) {
  backToMeasured();
  model.noise = fitNoise(trial_, noise_alone, level, measured_slopes, knownSensors(model));
  calibrateInputs(trial_, model.noise);
  level_ = predictRows(model, trial_, solved);
  residual_ = trial_.measured - level_;  // (T1)
  const InputSlopes slopes = inputSlopes(model, trial_, solved);
  by_slip_.reset();
  const Eigen::VectorXd shared = sharedSlipStd(trial_, model.noise);
  if (shared.size() > 0) by_slip_ = shared.asDiagonal() * slopes.by_slip;
  whitening_ = terramech::whitening(trial_, level_, slopes, model.noise);
}

void CalibratedRows::shareWithin(Eigen::MatrixXd smooth, const Eigen::MatrixXd& level,
                                 const InputSlopes& measured_slopes, RefinedModel& model,
                                 SolvedContacts& solved) {
  std::vector<std::string> timeless;
  for (const std::string& column : noiseColumns(trial_))
    if (column != "time_s") timeless.push_back(column);
  const std::vector<int> unit = runUnits(trial_, whitening_, withoutSmooth(trial_, residual_, timeless));
  if (!unit.empty()) {  // excludes the shared error from the noise of single rows
    const double rows = trial_.rows(), kept = rows - (*std::max_element(unit.begin(), unit.end()) + 1);
    smooth -= unitMeans(smooth, whitening_.std, unit);
    if (kept > 4.0) settle(std::sqrt(rows / kept) * smooth, level, measured_slopes, model, solved);
  }
  whitening_.common.unit = unit;
  if (unit.empty()) return;
  whitening_.common.by_soil = soilFactors(model, trial_, level_, solved);
  whitening_.common.run = roughRunError(whitening_);
}

void CalibratedRows::calibrate(RefinedModel& model, SolvedContacts& solved) {
  backToMeasured();
  const Eigen::MatrixXd level = predictRows(model, trial_, solved);
  const InputSlopes slopes = inputSlopes(model, trial_, solved);
  const Eigen::MatrixXd measured = trial_.measured - level;
  // If the slip varies more than any possible error, no estimate of the error is needed.
  const SensorNoise unlimited{.slip_relative = 1.0};
  // A smooth of the measured loads would absorb their errors about the set loads.
  if (const auto set = setLoads(trial_))
    for (std::size_t r = 0; r < trial_.states.size(); ++r)
      trial_.states[r].load_N = set->load_N[static_cast<Eigen::Index>(r)];
  Eigen::MatrixXd smooth = withoutSmooth(trial_, measured, noiseColumns(trial_));
  if (!inputsAreSeen(trial_, unlimited)) {
    const Eigen::MatrixXd left = withoutSmooth(trial_, measured, allButSlip(trial_));
    if (!inputsAreSeen(trial_, fitNoise(trial_, left, level, slopes, model.stated))) smooth = left;
  }
  settle(smooth, level, slopes, model, solved);
  shareWithin(smooth, level, slopes, model, solved);
  white_ = whitening_.apply(residual_);
}

void CalibratedRows::setRunError(const RunError& run) {
  whitening_.common.run = run;
  white_ = whitening_.apply(residual_);
}

void CalibratedRows::compare(const RefinedModel& model, SolvedContacts& solved) {
  level_ = predictRows(model, trial_, solved);
  residual_ = trial_.measured - level_;
  white_ = whitening_.apply(residual_);
}

}  // namespace talus::terramech
