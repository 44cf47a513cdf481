#pragma once

#include <array>
#include <vector>

#include <talus/terramech/calibration/search/trace_result.hpp>

/// Models fitted again to a part of the rows, and their errors on the others.
namespace talus::terramech {

/// Squared errors summed by channel, NaN left out.
class SquaredErrors {
 public:
  /// Adds residuals, rows x kChannels.
  void add(const Eigen::MatrixXd& residual);

  /// Root mean square by channel; NaN where nothing was added.
  ChannelErrors rmse() const;

 private:
  ChannelErrors sum_{};
  std::array<int, kChannels> count_{};
};

/// The base of a result fitted again to the rows that `train` marks, as it was fitted to all of them: by rowsOfSoil() and
/// what rows share beside the base.
RefinedModel refittedBase(const TraceResult& result, const TraceOptions& options, std::vector<char> train);

/// Its refined model fitted again to those rows.
RefinedModel refittedModel(const TraceResult& result, const TraceOptions& options,
                           const std::vector<char>& train);

/// Errors at the slip and load as measured.
ChannelErrors rmseAsMeasured(const RefinedModel& model, const Trial& trial);

/// Residuals (measured - predicted) at the slip and load as measured, rows x kChannels.
Eigen::MatrixXd leftAsMeasured(const RefinedModel& model, const Trial& trial);

}  // namespace talus::terramech
