#pragma once

#include <vector>

#include <Eigen/Core>

#include <talus/terramech/calibration/noise/whitening.hpp>
#include <talus/terramech/calibration/table/trial.hpp>

namespace talus::terramech {

/// Number from 0 of the unit of each row whose error its rows share: whole runs, or stretches of 16, 8 or 4 rows
/// of them in the order of time, whichever is most likely of `left` (rows x kChannels, residuals without smooths
/// of the columns) by twenty times or more; on a drive, whole moments. No stretches where time is not known, or where
/// slip, load or the like follow it other than on a drive. Empty where there are no runs and no stretches.
std::vector<int> runUnits(const Trial& trial, const Whitening& whitening, const Eigen::MatrixXd& left);

/// The part of each row and channel that its unit shares: means weighted by 1 / std^2. NaN count for nothing
/// and become 0.
Eigen::MatrixXd unitMeans(const Eigen::MatrixXd& residual, const Eigen::MatrixXd& std,
                          const std::vector<int>& unit);

/// A covariance of a run's error to start a search from: that of independent errors as large as a row's.
RunError roughRunError(const Whitening& whitening);

}  // namespace talus::terramech
