#pragma once

#include <array>
#include <vector>

#include <talus/terramech/calibration/search/trace_result.hpp>

/// Refits of models to a subset of the rows, and errors on the other rows.
namespace talus::terramech {

/// Squared errors summed by channel; NaN is ignored.
class SquaredErrors {
 public:
  /// Adds residuals, rows x kChannels.
  void add(const Eigen::MatrixXd& residual);

  /// Root mean square by channel; NaN if nothing was added.
  ChannelErrors rmse() const;

 private:
  ChannelErrors sum_{};
  std::array<int, kChannels> count_{};
};

/// Base of a result, refitted to the rows marked by `train` by the method of the original fit: uses
/// rowsOfSoil() and the shared errors beside the base.
RefinedModel refittedBase(const TraceResult& result, const TraceOptions& options, std::vector<char> train);

/// Refined model of a result, refitted to these rows.
RefinedModel refittedModel(const TraceResult& result, const TraceOptions& options,
                           const std::vector<char>& train);

/// Errors with slip and load as measured.
ChannelErrors rmseAsMeasured(const RefinedModel& model, const Trial& trial);

/// Residuals (measured - predicted) with slip and load as measured, rows x kChannels.
Eigen::MatrixXd leftAsMeasured(const RefinedModel& model, const Trial& trial);

}  // namespace talus::terramech
