#pragma once

#include <talus/terramech/calibration/search/trace_result.hpp>

/// Scope of a refined model: the channels and column ranges in which its effects (corrections of the base
/// model) are applied, because held-out rows do not contradict the effects there.
namespace talus::terramech {

/// Returns the scope of a trace result. The scope contains the channels in which the refined model has no
/// larger errors on result.held_out than the base model, the ranges of the columns in the rows, and the
/// distances beyond each range up to which the errors result.ends do not contradict the effects significantly
/// (unlimited without a contradiction).
ModelScope scopeOf(const TraceResult& result);

/// Replace errors of the refined model by those of the base model: in channels that the scope excludes, and
/// at ends whose errors contradict the effects. `floor` is the rms sensor error per channel.
void keepConfirmed(HeldOut& held, const ModelScope& scope);
void keepConfirmed(std::vector<EndLevel>& ends, const ChannelErrors& floor);

/// Returns the predictions of the refined model within its scope, rows x kChannels. Outside the scope the
/// predictions return to those of the base model.
Eigen::MatrixXd predictInScope(const TraceResult& result, const Trial& rows);

}  // namespace talus::terramech
