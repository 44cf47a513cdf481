#pragma once

#include <array>
#include <vector>

#include <talus/terramech/calibration/noise/folds.hpp>
#include <talus/terramech/calibration/search/trace_result.hpp>

/// Refits the models of a trace result to a part of the rows, and computes errors on the other rows.
namespace talus::terramech {

/// Mean squared error by channel, accumulated over several sets of rows; NaN is ignored.
class SquaredErrors {
 public:
  SquaredErrors() = default;
  explicit SquaredErrors(const Eigen::MatrixXd& residual) { add(residual); }
  /// Adds residuals, rows x kChannels.
  void add(const Eigen::MatrixXd& residual);

  /// Returns the root mean square of all residuals by channel; NaN for a channel without residuals.
  ChannelErrors rmse() const;

 private:
  ChannelErrors sum_{};
  std::array<int, kChannels> count_{};
};

/// Returns the base model of a result, refitted to the rows marked by `train` by the method of the original
/// fit: of these rows only those of rowsOfSoil() are used, with the errors shared by rows of a run.
RefinedModel refittedBase(const TraceResult& result, const TraceOptions& options, std::vector<char> train);

/// Returns the refined model of a result, refitted to the rows marked by `train`.
RefinedModel refittedModel(const TraceResult& result, const TraceOptions& options,
                           const std::vector<char>& train);

/// Returns the root mean square residual by channel, with slip and load as measured.
ChannelErrors rmseAsMeasured(const RefinedModel& model, const Trial& trial);

/// Replaces errors of the refined model by those of the base model in channels that the scope excludes.
void keepConfirmed(HeldOut& held, const ModelScope& scope);

/// Returns the errors on held-out rows for one partition of the rows. The errors of the refined model are
/// those within result.scope (channels and ranges in which its effects are applied).
HeldOut holdOut(const TraceResult& result, const TraceOptions& options, const Folds& folds);

/// Returns the errors on held-out levels (rows with the same value of a column), for the column of each found
/// effect.
std::vector<HeldOut> holdOutLevels(const TraceResult& result, const TraceOptions& options);

}  // namespace talus::terramech
