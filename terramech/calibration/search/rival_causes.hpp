#pragma once

#include <cstddef>
#include <vector>

#include <talus/terramech/calibration/search/trace_search.hpp>

namespace talus::terramech {

/// Returns alternative causes for accepted candidate `k` of a search: the best form and the best curve of
/// each other column, and other forms of the candidate's own column. Each alternative is fitted in place of
/// the candidate, together with the other effects. Returns at most three causes of different columns or
/// forms, best first. Their gains are comparable to TraceSearch::gainOf(k).
std::vector<RivalCause> rivalsOf(const TraceSearch& search, std::size_t k);

/// Returns alternative causes from `ranked` for a model without accepted candidates: at most three, of
/// different columns or forms.
std::vector<RivalCause> rivalsOf(const TraceSearch& search, const std::vector<Explanation>& ranked);

}  // namespace talus::terramech
