#pragma once

#include <cstddef>
#include <vector>

#include <talus/terramech/calibration/search/trace_search.hpp>

namespace talus::terramech {

/// Other causes for accepted candidate number `k` of a search: the best form and the best curve of each column, and other
/// forms of its own column, fitted in its place beside the other effects. At most three, of different columns or forms, best
/// first; their gains are counted as TraceSearch::gainOf(k).
std::vector<RivalCause> rivalsOf(const TraceSearch& search, std::size_t k);

/// Those of `ranked` that a model without any accepted candidate may lack: at most three, of different columns or forms.
std::vector<RivalCause> rivalsOf(const TraceSearch& search, const std::vector<Explanation>& ranked);

}  // namespace talus::terramech
