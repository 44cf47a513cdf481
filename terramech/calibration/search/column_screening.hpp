#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <talus/terramech/calibration/search/trace_result.hpp>

/// The part of a large table that a search can take in bounded time.
namespace talus::terramech {

/// Marks at most `most` rows, all where there are no more: the rows in the order of runs and of the file are cut into as
/// many equal stretches, of which one row each is drawn at random, so that every run keeps its share and no period
/// of a design meets that of the sample. Of a drive whole moments.
std::vector<char> rowSample(const Trial& trial, int most, std::uint64_t seed);

/// A trial with at most options.most_columns columns of one's own, numeric and text together: those whose coarseCandidates()
/// gain most on the residuals of `base`, by the gain of the search itself, in the table's order. The others are named
/// in Trial::dropped and left out of the states. Kept columns whose gain does not exceed ln(columns / significance),
/// which noise reaches in some column with probability `significance` at most, are in Trial::chance.
Trial screenColumns(const RefinedModel& base, const Trial& trial, const TraceOptions& options,
                    const std::function<bool(double)>& go_on);

}  // namespace talus::terramech
