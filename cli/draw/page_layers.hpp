#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include <nlohmann/json.hpp>

#include <talus/cli/draw/colour.hpp>
#include <talus/cli/draw/image.hpp>
#include <talus/cli/draw/scene.hpp>

namespace talus::cli {

/// Returns a number for the data of an HTML page: nine significant digits; null for NaN and infinity.
nlohmann::ordered_json number(double value);

/// Returns an image as a data URI of a PNG file.
std::string dataUri(const Image& image);

/// Returns a data URI of an image with 24 bits per cell, in red, green and blue; word(cell) returns the bits.
/// The top row is the northernmost row of the grid.
std::string wordsUri(const maps::Grid& grid, const std::function<std::uint32_t(maps::Cell)>& word);

/// Returns a colour as text "#rrggbb".
std::string hex(Colour colour);

/// Returns 32 colours of a scale in hexadecimal form, from low to high.
nlohmann::ordered_json coloursOf(Scale scale);

/// Returns the colour and label of each category.
nlohmann::ordered_json categoryLegend();

/// Returns the layers of a scene for an HTML page, allowed headings first. Each layer has a name, a coloured image,
/// a legend or a colour bar with range and unit, and the values that cli/page/probe.js shows: integers in
/// units of the layer's last decimal, or the shares of the four AllowedHeadings.
nlohmann::ordered_json layersOf(const Scene& scene);

/// Returns latitudes and longitudes [deg] on a square lattice over the scene, row by row from the south-west.
/// The lattice is refined until the interpolation error is less than a twentieth of a cell, or to 128
/// intervals. Returns null without a georeference.
nlohmann::ordered_json latticeOf(const Scene& scene);

}  // namespace talus::cli
