#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <talus/terramech/calibration/search/trace_result.hpp>

/// Reduces a large table to a size that a search for effects can process in bounded time.
namespace talus::terramech {

/// Marks a random sample of at most `most` rows. The rows, in order of runs and of the file, are divided into
/// `most` equal stretches, and one row of each stretch is drawn. Every run thereby keeps its share, and
/// periods of the experiment are not aliased. For a rover's own drive, whole moments (rows of all wheels at
/// one time) are drawn.
std::vector<char> rowSample(const Trial& trial, int most, std::uint64_t seed);

/// Returns the trial with at most options.most_columns additional columns (columns unknown to Talus), numeric
/// and text together, in the order of the table. The kept columns are those with the greatest gain of
/// coarseCandidates() on the residuals of `base`. The other columns are listed in Trial::dropped and removed
/// from the states. Kept columns with a gain up to ln(columns / significance) are listed in Trial::chance,
/// because noise reaches this gain in some column with a probability of at most `significance`. `go_on`
/// receives the completed share; a return value of false ends the screening.
Trial screenColumns(const RefinedModel& base, const Trial& trial, const TraceOptions& options,
                    const std::function<bool(double)>& go_on);

}  // namespace talus::terramech
