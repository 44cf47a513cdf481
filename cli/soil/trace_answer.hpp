#pragma once

#include <string>
#include <vector>

#include <talus/terramech/calibration/verdict/verdict.hpp>

namespace talus::cli {

/// Why what promised most in the last round was not accepted: what it gains, and the bound or check that refused it.
/// Empty where nothing promised any gain.
std::string refusal(const terramech::TraceResult& result);

/// Why a fitted candidate was not selected.
std::string refusal(const terramech::TraceResult& result, const terramech::Explanation& rejected);

/// The answer in one line: what is left, in which channel, over which column, which rows would decide.
std::string verdictText(const terramech::TraceResult& result, const terramech::Answer& answer);

/// What an effect of the refined model changes there.
struct EffectRole {
  bool adds = true;  ///< false: without it, and without what it takes back, the model predicts the same
  std::vector<std::string> takes_back;  ///< fields of the soil whose term in the base model it takes out
};

/// Of each effect, in order. An effect adds where a prediction of any row differs by more than 1e-5 of the scale of its
/// channel, ten times what the two solvers of the contact differ by.
std::vector<EffectRole> rolesOf(const terramech::TraceResult& result);

/// One line about an effect that adds nothing; empty for another.
std::string roleText(const EffectRole& role);

}  // namespace talus::cli
