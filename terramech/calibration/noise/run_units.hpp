#pragma once

#include <vector>

#include <Eigen/Core>

#include <talus/terramech/calibration/noise/whitening.hpp>
#include <talus/terramech/calibration/table/trial.hpp>

namespace talus::terramech {

/// Returns the unit number of each row, from 0. The rows of a unit share an error. Units are whole runs, or
/// stretches of 16, 8 or 4 rows of a run in order of time. The choice is that of maximum likelihood for the
/// residuals `left` (rows x kChannels, without their smooth dependence on columns); stretches must be more
/// likely by a factor of at least twenty. On a rover's own drive, units are moments (rows of all wheels at
/// one time). Stretches are not used without a time column, or if slip, load or similar columns depend on
/// time (except on a drive). Returns an empty vector without runs and stretches.
std::vector<int> runUnits(const Trial& trial, const Whitening& whitening, const Eigen::MatrixXd& left);

/// Returns in every row and channel the mean of the row's unit, weighted by 1 / std^2. NaN values are ignored
/// and become 0.
Eigen::MatrixXd unitMeans(const Eigen::MatrixXd& residual, const Eigen::MatrixXd& std,
                          const std::vector<int>& unit);

/// Returns an initial covariance of a run's error for a search: independent components of the size of a row's
/// error.
RunError roughRunError(const Whitening& whitening);

}  // namespace talus::terramech
