#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <talus/terramech/calibration/search/trace_result.hpp>

/// Reduction of a large table to a size that a search can process in bounded time.
namespace talus::terramech {

/// Marks a sample of at most `most` rows. The rows in order of runs and of the file are divided into `most`
/// equal stretches, and one row of each stretch is drawn at random: every run keeps its share, and periods of
/// the experiment are not aliased. For a drive, whole moments are drawn.
std::vector<char> rowSample(const Trial& trial, int most, std::uint64_t seed);

/// Returns the trial with at most options.most_columns additional columns, numeric and text together, in the
/// order of the table: the columns whose coarseCandidates() have the greatest gain on the residuals of
/// `base`. The other columns are listed in Trial::dropped and removed from the states. Kept columns with a
/// gain up to ln(columns / significance) are listed in Trial::chance; noise reaches this gain in some column
/// with a probability of at most `significance`.
Trial screenColumns(const RefinedModel& base, const Trial& trial, const TraceOptions& options,
                    const std::function<bool(double)>& go_on);

}  // namespace talus::terramech
