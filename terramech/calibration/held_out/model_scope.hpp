#pragma once

#include <cstddef>
#include <optional>

#include <talus/terramech/calibration/search/trace_result.hpp>

/// What was traced is used where, and as far as, held-out rows do not speak against it.
namespace talus::terramech {

/// Channels in which the refined model errs no more than the base on result.held_out; the ranges of the rows; and how far
/// beyond them result.ends do not speak against it, by more than chance: unlimited where none does.
ModelScope scopeOf(const TraceResult& result);

/// Errors as the refined model predicts: those of the base where the scope takes the corrections back.
void keepConfirmed(HeldOut& held, const ModelScope& scope);
void keepConfirmed(std::vector<EndLevel>& ends, const ChannelErrors& floor);

/// The last effect that was found in a channel whose held-out rows err more with the effects than with the base.
std::optional<std::size_t> lastRefuted(const TraceResult& result);

/// What the refined model predicts within its scope, rows x kChannels.
Eigen::MatrixXd predictInScope(const TraceResult& result, const Trial& rows);

}  // namespace talus::terramech
