#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <talus/cli/draw/canvas.hpp>

namespace talus::cli {

/// Charts of lines and points.

/// Data and style of one curve or of one cloud of points.
struct Series {
  enum class Mark { Line, Points };

  std::string name = {};  ///< name in the legend; empty: no legend entry
  std::vector<double> x;  ///< x values, in the unit of the axis
  std::vector<double> y;  ///< y values, as many as x values; a NaN interrupts the line
  Mark mark = Mark::Line;
  bool dashed = false;
  std::optional<Colour> colour = {};  ///< colour; empty: the next distinguishable colour
};

/// One axis of a chart.
struct Axis {
  std::string label;               ///< label with the unit: "slip [-]"
  std::optional<double> low = {};  ///< end of the axis at low values; empty: range of the data
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

/// Returns the charts, drawn row by row, as the bytes of a PNG or SVG file. @throws std::invalid_argument if
/// x and y of a series differ in length
std::string draw(const std::vector<Plot>& plots, Canvas::Kind kind, const PlotLayout& layout = {});

/// Writes the charts to a file, as SVG for the extension .svg and as PNG otherwise. The file appears complete
/// or not at all. @throws InputError if the file cannot be written
void save(const std::filesystem::path& path, const std::vector<Plot>& plots, const PlotLayout& layout = {});

/// Returns the text with characters escaped that HTML reads as markup.
std::string escaped(const std::string& text);

/// A self-contained HTML page of headings, paragraphs, tables and charts, in the order in which they are
/// added.
class HtmlReport {
 public:
  explicit HtmlReport(std::string title) : title_(std::move(title)) {}

  void heading(const std::string& text);
  void paragraph(const std::string& text);
  /// Adds a table, which scrolls where it is wider than the screen. Numeric cells are right-aligned.
  void table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows);
  /// Adds charts, which are shown side by side if the screen is wide enough.
  void charts(const std::vector<Plot>& plots);

  /// Returns the finished page.
  std::string html() const;

 private:
  std::string title_;
  std::string body_;
};

}  // namespace talus::cli
