#pragma once

#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <talus/cli/draw/plot.hpp>
#include <talus/terramech/effects/channel_reading.hpp>

namespace talus::cli {

/// Name and values of predictions: one matrix row per table row, one matrix column per channel (measured
/// quantity).
using NamedPredictions = std::pair<std::string, Eigen::MatrixXd>;

/// Returns a plot of predicted over measured values of one channel; on the dashed line both are equal. Rows
/// without a measurement are omitted.
Plot agreementPlot(terramech::Channel channel, const Eigen::MatrixXd& measured,
                   const std::vector<NamedPredictions>& predictions);

}  // namespace talus::cli
