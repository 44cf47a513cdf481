#pragma once

#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <talus/cli/draw/plot.hpp>
#include <talus/terramech/effects/channel_reading.hpp>

namespace talus::cli {

/// Predictions of rows x channels under a name.
using NamedPredictions = std::pair<std::string, Eigen::MatrixXd>;

/// One channel of rows, predicted over measured: on the dashed line both agree. Rows without a measurement are left out.
Plot agreementPlot(terramech::Channel channel, const Eigen::MatrixXd& measured,
                   const std::vector<NamedPredictions>& predictions);

}  // namespace talus::cli
