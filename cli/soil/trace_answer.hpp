#pragma once

#include <string>
#include <vector>

#include <talus/terramech/calibration/verdict/verdict.hpp>

namespace talus::cli {

/// Reason why the best candidate of the last round was rejected: its gain and the threshold or check that
/// rejected it. Empty if no candidate had a gain.
std::string refusal(const terramech::TraceResult& result);

/// Reason why a fitted candidate was not selected.
std::string refusal(const terramech::TraceResult& result, const terramech::Explanation& rejected);

/// The verdict in one line: nothing missing, explained by n effects, or unexplained with the reason. Includes
/// the rms residual of the answer's channel, and for an unexplained residual the measurement that would
/// identify its cause.
std::string verdictText(const terramech::TraceResult& result, const terramech::Answer& answer);

/// Contribution of an effect to the refined model.
struct EffectRole {
  bool adds = true;  ///< false: without the effect and its replaced terms the model predicts the same
  std::vector<std::string> takes_back;  ///< soil fields whose base-model term the effect removes
};

/// Roles of all effects in order. An effect adds if a prediction of any row changes by more than 1e-5 of the
/// scale of its channel, ten times the difference between the two contact solvers.
std::vector<EffectRole> rolesOf(const terramech::TraceResult& result);

/// Returns one line about an effect that adds nothing; empty for other effects.
std::string roleText(const EffectRole& role);

}  // namespace talus::cli
