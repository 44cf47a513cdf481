#pragma once

#include <cstddef>
#include <optional>

#include <talus/terramech/calibration/search/trace_result.hpp>

/// Limits the use of traced effects to channels and ranges that held-out rows do not contradict.
namespace talus::terramech {

/// Scope of a result: channels in which the refined model errs no more than the base on result.held_out,
/// ranges of the rows, and the distance beyond each range up to which result.ends do not contradict the model
/// significantly (unlimited without a contradiction).
ModelScope scopeOf(const TraceResult& result);

/// Replaces errors of the refined model by those of the base where the scope excludes the corrections.
void keepConfirmed(HeldOut& held, const ModelScope& scope);
void keepConfirmed(std::vector<EndLevel>& ends, const ChannelErrors& floor);

/// Returns the index of the last effect found in a channel in which the effects increase the errors on
/// held-out rows; nullopt if no channel has larger errors.
std::optional<std::size_t> lastRefuted(const TraceResult& result);

/// Predictions of the refined model within its scope, rows x kChannels.
Eigen::MatrixXd predictInScope(const TraceResult& result, const Trial& rows);

}  // namespace talus::terramech
