#pragma once

#include <string>
#include <vector>

#include <talus/terramech/calibration.hpp>

namespace talus::cli {

/// Returns the reason for which the best candidate effect of the last round was rejected: its gain, and the
/// threshold or check that rejected it. Returns an empty text if no candidate had a gain.
std::string refusal(const terramech::TraceResult& result);

/// Returns the reason for which a fitted candidate effect was not selected.
std::string refusal(const terramech::TraceResult& result, const terramech::Explanation& rejected);

/// Returns the answer in one line: nothing missing; explained, or partly explained, by named effects; or
/// unexplained with the reason. The line includes the channel of the answer, its errors on held-out rows
/// before and after, and, for an unexplained residual, the measurement that would identify its cause.
std::string verdictText(const terramech::TraceResult& result, const terramech::Answer& answer);

/// Contribution of an effect (deviation from the base model that was found in data) to the refined model.
struct EffectRole {
  /// True if the effect changes predictions; false: the model predicts the same without the effect and the
  /// terms that it replaces.
  bool adds = true;
  std::vector<std::string> takes_back;  ///< soil parameters whose term in the base model the effect removes
};

/// Returns the contributions of all effects, in order. EffectRole::adds is true if a prediction of any row
/// changes by more than 1e-5 of the scale of its channel, which is ten times the difference between the two
/// contact solvers.
std::vector<EffectRole> rolesOf(const terramech::TraceResult& result);

/// Returns one line of text about an effect that adds nothing; empty for other effects.
std::string roleText(const EffectRole& role);

}  // namespace talus::cli
