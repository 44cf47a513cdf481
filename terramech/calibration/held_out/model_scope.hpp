#pragma once

#include <string>
#include <vector>

#include <talus/common/common.hpp>
#include <talus/terramech/calibration/search/trace_result.hpp>
#include <talus/terramech/io/terramech_io.hpp>

/// Scope of a refined model: the channels and column ranges in which its effects (corrections of the base
/// model) are applied, because held-out rows do not contradict the effects there. For extrapolation, the rows with the outermost values
/// of a column (an end of the column) are held out and predicted by a model that is fitted to the other rows. A
/// level of a column is the set of rows with the same value.
namespace talus::terramech {

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
