#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include <nlohmann/json.hpp>

#include <talus/cli/draw/colour.hpp>
#include <talus/cli/draw/image.hpp>
#include <talus/cli/draw/scene.hpp>

namespace talus::cli {

/// A number for a page: nine significant digits; null for NaN and infinity.
nlohmann::ordered_json number(double value);

/// The image as a PNG data URI.
std::string dataUri(const Image& image);

/// 24 bits per cell, stored in red, green and blue of an image; the top row is north.
std::string wordsUri(const maps::Grid& grid, const std::function<std::uint32_t(maps::Cell)>& word);

/// The colour as "#rrggbb".
std::string hex(Colour colour);

/// The 32 colours of a scale in hexadecimal, from low to high.
nlohmann::ordered_json coloursOf(Scale scale);

/// Colour and label of each category.
nlohmann::ordered_json categoryLegend();

/// Layers of a scene for the page, categories first. Each has a name, a coloured image, a legend or a colour
/// bar with range and unit, and the values that cli/page/probe.js shows: integers in units of the layer's
/// last decimal, or the shares of the four categories.
nlohmann::ordered_json layersOf(const Scene& scene);

/// Latitudes and longitudes [deg] on a square lattice over the scene, row by row from the south-west. The
/// lattice is refined until interpolation errs by less than a twentieth of a cell, or to 128 intervals; null
/// without a georeference.
nlohmann::ordered_json latticeOf(const Scene& scene);

}  // namespace talus::cli
