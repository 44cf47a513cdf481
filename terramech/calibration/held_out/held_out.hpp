#pragma once

#include <array>
#include <string>
#include <vector>

#include <talus/common/common.hpp>
#include <talus/terramech/calibration.hpp>
#include <talus/terramech/calibration/noise/run_likelihood.hpp>
#include <talus/terramech/terramech_io.hpp>

/// Refits the models of a trace result to a part of the rows, and computes errors on the other rows.
namespace talus::terramech {

/// Returns the base model of a result, refitted to the rows marked by `train` by the method of the original
/// fit: of these rows only those of rowsOfSoil() are used, with the errors shared by rows of a run.
RefinedModel refittedBase(const TraceResult& result, const TraceOptions& options, std::vector<char> train);

/// Returns the refined model of a result, refitted to the rows marked by `train`.
RefinedModel refittedModel(const TraceResult& result, const TraceOptions& options,
                           const std::vector<char>& train);

/// Replaces errors of the refined model by those of the base model in channels that the scope excludes.
void keepConfirmed(HeldOut& held, const ModelScope& scope);

/// Returns the errors on held-out rows for one partition of the rows, with slip and load as measured. The
/// errors of the refined model are those within result.scope (channels in which its effects are applied).
HeldOut holdOut(const TraceResult& result, const TraceOptions& options, const Folds& folds);

/// Returns the errors on held-out levels (rows with the same value of a column), for the column of each found
/// effect.
std::vector<HeldOut> holdOutLevels(const TraceResult& result, const TraceOptions& options);

/// Returns true if the refined model has effects that the base model does not have.
bool hasCorrections(const TraceResult& result);

/// Returns the errors at both ends of each column: slip, slip angle, load and the columns of effects, if the
/// column has at least three levels. An end is the outermost level if there are at most eight levels,
/// otherwise the outermost tenth of the rows. The parameters are refitted without the held-out rows.
std::vector<EndLevel> endLevels(const TraceResult& result, const TraceOptions& options,
                                const ProgressMonitor& watch = {});

/// Returns the model with effects that are constant outside the range of their column in the rows.
RefinedModel withinRows(RefinedModel model, const Trial& trial);

/// Returns the range of each column in the rows, with the growth of the prediction error outside the range
/// (ours). The growth is proportional to the distance from the range. Its rate is fitted by least squares to
/// the errors at the ends of one side that exceed `floor`, the rms sensor error per channel.
std::vector<TrainedRange> trainedRanges(const Trial& trial, const std::vector<EndLevel>& ends,
                                        const ChannelErrors& floor);

/// Returns the scope of a trace result: the channels in which the refined model has no larger errors on
/// result.held_out than the base model, and the ranges of the columns in the rows.
ModelScope scopeOf(const TraceResult& result);

/// Returns the predictions of the refined model within its scope, rows x kChannels. Outside the scope the
/// predictions return to those of the base model.
Eigen::MatrixXd predictInScope(const TraceResult& result, const Trial& rows);

}  // namespace talus::terramech
