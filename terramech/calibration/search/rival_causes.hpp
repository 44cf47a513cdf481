#pragma once

#include <cstddef>
#include <vector>

#include <talus/terramech/calibration/search/trace_search.hpp>

namespace talus::terramech {

/// Explanations in the place of an accepted candidate.
struct Replacements {
  TraceSearch without;              ///< search without the accepted candidate
  std::vector<Promise> promises;    ///< all candidates, best first
  std::vector<Explanation> ranked;  ///< the most promising candidates, fitted, best gain first
};

/// Screens and fits the candidates in the place of accepted candidate `k`. Their gains are comparable to
/// TraceSearch::gainOf(k).
Replacements replacementsOf(const TraceSearch& search, std::size_t k);

/// Returns alternative causes for an accepted candidate with the effects `own`: the best form and the best
/// curve of each other column, and other forms of the candidate's own column. Returns at most three causes of
/// different columns or forms, best first.
std::vector<RivalCause> rivalsOf(const Replacements& in, const std::vector<Effect>& own);

/// Returns alternative causes from `ranked` for a model without accepted candidates: at most three, of
/// different columns or forms.
std::vector<RivalCause> rivalsOf(const TraceSearch& search, const std::vector<Explanation>& ranked);

}  // namespace talus::terramech
