#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include <nlohmann/json.hpp>

#include <talus/cli/draw/colour.hpp>
#include <talus/cli/draw/image.hpp>
#include <talus/cli/draw/scene.hpp>

namespace talus::cli {

/// A number of a page: nine significant digits; null for NaN.
nlohmann::ordered_json number(double value);

/// The image as a PNG in a URI.
std::string dataUri(const Image& image);

/// 24 bits of each cell as the red, green and blue of an image, the top row north.
std::string wordsUri(const maps::Grid& grid, const std::function<std::uint32_t(maps::Cell)>& word);

/// "#rrggbb".
std::string hex(Colour colour);

/// The 32 colours of a scale, from low to high.
nlohmann::ordered_json coloursOf(Scale scale);

/// The categories: colour and label of each.
nlohmann::ordered_json categoryLegend();

/// The layers of a scene for the page, categories first: name, image in colours, legend or bar with its ends and unit, and the
/// values that cli/page/probe.js shows: whole numbers of the layer's last decimal, or the shares of four categories.
nlohmann::ordered_json layersOf(const Scene& scene);

/// Latitudes and longitudes [deg] of a square lattice over the scene, row by row from the south west, so fine that what lies
/// half-way between its points is met within a twentieth of a cell (or 128 intervals); null without a georeference.
nlohmann::ordered_json latticeOf(const Scene& scene);

}  // namespace talus::cli
