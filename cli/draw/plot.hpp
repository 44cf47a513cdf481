#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <talus/cli/draw/canvas.hpp>
#include <talus/cli/draw/colour.hpp>

/// Charts of lines and points.
namespace talus::cli {

/// Data and style of one curve or one cloud of points.
struct Series {
  enum class Mark { Line, Points };

  std::string name = {};           ///< name in the legend; empty: no legend entry
  std::vector<double> x;           ///< in the unit of the axis
  std::vector<double> y;           ///< same length as x; a NaN interrupts the line
  std::vector<double> y_std = {};  ///< empty, or standard deviations: band (Line) or bars
  Mark mark = Mark::Line;
  bool dashed = false;
  std::optional<Colour> colour = {};  ///< empty: next distinguishable colour
};

/// One axis.
struct Axis {
  std::string label;               ///< includes the unit: "slip [-]"
  std::optional<double> low = {};  ///< empty: range of the data
  std::optional<double> high = {};
};

/// One chart.
struct Plot {
  std::string title;
  Axis x;
  Axis y;
  std::vector<Series> series;
};

/// Layout of several charts on a page.
struct PlotLayout {
  int columns = 2;
  int panel_width = 520;   ///< pixels
  int panel_height = 380;  ///< pixels
};

/// Draws the charts row by row and returns the bytes of a PNG or SVG file.
/// @throws std::invalid_argument when x, y or y_std of a series differ in length
std::string draw(const std::vector<Plot>& plots, Canvas::Kind kind, const PlotLayout& layout = {});

/// Writes the charts as PNG or, for the extension .svg, as SVG; the file appears complete or not at all.
/// @throws InputError when the file cannot be written
void save(const std::filesystem::path& path, const std::vector<Plot>& plots, const PlotLayout& layout = {});

}  // namespace talus::cli
