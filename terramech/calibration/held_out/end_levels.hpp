#pragma once

#include <string>
#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/calibration/search/trace_result.hpp>
#include <talus/terramech/io/model_file.hpp>

/// Extrapolation error of a model: the outermost level of a column is held out and predicted from the other
/// levels.
namespace talus::terramech {

/// Returns true if the refined model has effects that the base lacks.
bool hasCorrections(const TraceResult& result);

/// Errors at both ends of slip, slip angle, load and the columns of effects, for columns with at least three
/// levels. The held-out end is the outermost level if there are at most eight levels, otherwise the outermost
/// tenth of the rows. If there are effects, ends of up to half of the rows are also held out: the levels with
/// at most half of the rows, or the outermost half. Parameters are refitted without the held-out rows.
std::vector<EndLevel> endLevels(const TraceResult& result, const TraceOptions& options,
                                const ProgressMonitor& watch = {});

/// Limits the extrapolation of effects. Outside the trained rows the formula of an effect applies up to the
/// held-out ends of its column that the formula predicted; beyond, the effect is constant. Without a
/// predicted end the effect is constant from the edge of the rows on.
void boundEffects(RefinedModel& model, const Trial& trial, const std::vector<EndLevel>& ends);

/// Ranges of the columns for predictions, and the growth of the error outside each range: the rate by which
/// the errors at the end levels exceed the floor, proportional to the distance, by least squares over the
/// rows of the ends on one side (ours).
std::vector<TrainedRange> trainedRanges(const Trial& trial, const std::vector<EndLevel>& ends,
                                        const ChannelErrors& floor);

}  // namespace talus::terramech
