#pragma once

#include <string>

#include <talus/terramech/estimate/reading_errors.hpp>
#include <talus/terramech/estimate/soil_posterior.hpp>
#include <talus/terramech/io/wheel_rows.hpp>

namespace talus::terramech {

/// Tests whether one soil explains all groups of rows. Returns one line with the text column (soil, run, ...)
/// whose groups deviate from the fit significantly and by at least half a standard deviation of the readings;
/// an empty text without such a column.
std::string groupsThatDisagree(const WheelRows& rows, const SoilPosterior& posterior,
                               const ReadingErrors& noise);

}  // namespace talus::terramech
