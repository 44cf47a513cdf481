#pragma once

#include <string>
#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/calibration/search/trace_result.hpp>
#include <talus/terramech/io/model_file.hpp>

/// How far a model holds beyond the rows that it comes from: the outermost level of a column is held out and told by
/// the others.
namespace talus::terramech {

/// Whether the refined model has effects that the base lacks.
bool hasCorrections(const TraceResult& result);

/// Both ends of slip, slip angle, load and of the columns of effects, where they have three levels: the outermost
/// level where there are at most eight, else the outermost tenth of the rows; then, where there are effects, the levels that
/// hold at most half of the rows, or the outermost half. Parameters are fitted again without them.
std::vector<EndLevel> endLevels(const TraceResult& result, const TraceOptions& options,
                                const ProgressMonitor& watch = {});

/// An extrapolation is earned: beyond the trained rows an effect follows its law as far as that foretold held-out ends of
/// its column, and acts from there on as it does there; at their edge where it foretold none.
void boundEffects(RefinedModel& model, const Trial& trial, const std::vector<EndLevel>& ends);

/// What predictions need to know of the rows: the range of each column, and by how much the error grows beyond it,
/// at the rate that the end levels showed above the floor (in proportion to the distance, by least squares over the rows of
/// the ends of a side; ours).
std::vector<TrainedRange> trainedRanges(const Trial& trial, const std::vector<EndLevel>& ends,
                                        const ChannelErrors& floor);

}  // namespace talus::terramech
