#pragma once

#include <vector>

#include <Eigen/Core>

#include <talus/terramech/calibration/noise/whitening.hpp>
#include <talus/terramech/calibration/table/trial.hpp>

namespace talus::terramech {

/// Unit number of each row, from 0; rows of a unit share an error. Units are whole runs, or stretches of 16,
/// 8 or 4 rows of a run in order of time: the choice of maximum likelihood for `left` (rows x kChannels,
/// residuals without smooths of the columns), by a factor of at least twenty. On a drive, units are moments.
/// Stretches are not used without a time column, or if slip, load or similar columns depend on time (except
/// on a drive). Empty without runs and stretches.
std::vector<int> runUnits(const Trial& trial, const Whitening& whitening, const Eigen::MatrixXd& left);

/// Mean of each unit in every row and channel, weighted by 1 / std^2. NaN values are ignored and become 0.
Eigen::MatrixXd unitMeans(const Eigen::MatrixXd& residual, const Eigen::MatrixXd& std,
                          const std::vector<int>& unit);

/// Returns the initial covariance of a run's error for a search: independent errors of the size of a row's
/// error.
RunError roughRunError(const Whitening& whitening);

}  // namespace talus::terramech
