#pragma once

#include <string>

#include <talus/terramech/estimate/soil_estimation.hpp>
#include <talus/terramech/io/wheel_rows.hpp>

namespace talus::terramech {

/// Tests whether one soil explains all groups of rows. Returns a line of text that names the text column
/// (soil, run, ...) whose groups deviate from the fit significantly and by at least half a standard deviation
/// of the readings. Returns an empty text if there is no such column.
std::string groupsThatDisagree(const WheelRows& rows, const SoilPosterior& posterior,
                               const ReadingErrors& noise);

}  // namespace talus::terramech
