#pragma once

#include <array>
#include <string>
#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/calibration/noise/run_likelihood.hpp>
#include <talus/terramech/calibration/search/trace_result.hpp>
#include <talus/terramech/io/model_file.hpp>

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

/// Returns true if the refined model has effects that the base model does not have.
bool hasCorrections(const TraceResult& result);

/// Returns the errors at both ends of each column: slip, slip angle, load and the columns of effects, if the
/// column has at least three levels. An end is the outermost level if there are at most eight levels,
/// otherwise the outermost tenth of the rows. If the refined model has effects, larger ends of up to half of
/// the rows are held out as well: the outermost levels with together at most half of the rows, or the
/// outermost half. The parameters are refitted without the held-out rows.
std::vector<EndLevel> endLevels(const TraceResult& result, const TraceOptions& options,
                                const ProgressMonitor& watch = {});

/// Limits the extrapolation of the effects of a model. Outside the range of the rows, the formula of an
/// effect applies up to the farthest held-out end of its column that the formula predicted; beyond this
/// distance the effect is constant. If the formula predicted no end, the effect is constant outside the range
/// of the rows.
void boundEffects(RefinedModel& model, const Trial& trial, const std::vector<EndLevel>& ends);

/// Returns the range of each column in the rows, with the growth of the prediction error outside the range
/// (ours). The growth is proportional to the distance from the range. Its rate is fitted by least squares to
/// the errors at the ends of one side that exceed `floor`, the rms sensor error per channel.
std::vector<TrainedRange> trainedRanges(const Trial& trial, const std::vector<EndLevel>& ends,
                                        const ChannelErrors& floor);

/// Returns the scope of a trace result. The scope contains the channels in which the refined model has no
/// larger errors on result.held_out than the base model, the ranges of the columns in the rows, and the
/// distances beyond each range up to which the errors result.ends do not contradict the effects significantly
/// (unlimited without a contradiction).
ModelScope scopeOf(const TraceResult& result);

/// Replaces errors of the refined model by those of the base model at ends whose errors contradict the effects.
void keepConfirmed(std::vector<EndLevel>& ends, const ChannelErrors& floor);

/// Returns the predictions of the refined model within its scope, rows x kChannels. Outside the scope the
/// predictions return to those of the base model.
Eigen::MatrixXd predictInScope(const TraceResult& result, const Trial& rows);

}  // namespace talus::terramech
