#pragma once

#include <string>

#include <talus/terramech/estimate/reading_errors.hpp>
#include <talus/terramech/estimate/soil_posterior.hpp>
#include <talus/terramech/io/wheel_rows.hpp>

namespace talus::terramech {

/// Whether one soil explains rows of every kind: one line that names the column of words (soil, run, ...)
/// whose groups of rows depart from the fit, each its own way, by half a standard deviation of the readings
/// and more and beyond chance; empty where none does.
std::string groupsThatDisagree(const WheelRows& rows, const SoilPosterior& posterior,
                               const ReadingErrors& noise);

}  // namespace talus::terramech
