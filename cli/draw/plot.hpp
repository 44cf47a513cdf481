#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <talus/cli/draw/canvas.hpp>

namespace talus::cli {

/// Charts of lines and points, which a page draws with Vega (cli/page/report.js).

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
  bool logarithmic = false;  ///< true if the axis has a logarithmic scale; values <= 0 are not drawn
};

/// One chart.
struct Plot {
  std::string title;
  Axis x;
  Axis y;
  std::vector<Series> series;
};

/// A table: its header, then its rows.
using Table = std::vector<std::vector<std::string>>;

/// Returns a table as text with columns as wide as their widest cell. Numeric columns are right-aligned.
std::string tableText(const Table& table);

/// Returns a table as CSV.
std::string csvText(const Table& table);

/// A report of headings, paragraphs, tables and charts, in the order in which they are added: as a self-contained HTML
/// page, and as text for a terminal without title and charts.
class Report {
 public:
  explicit Report(std::string title) : title_(std::move(title)) {}

  void heading(const std::string& text);
  /// Adds a paragraph; line breaks in it are kept.
  void paragraph(const std::string& text);
  /// Adds a table, which scrolls where it is wider than the screen. Numeric cells are right-aligned.
  void table(const Table& table);
  /// Adds charts, which are shown side by side if the screen is wide enough, over a caption. Points that cover each
  /// other are left out. @throws std::invalid_argument if x and y of a series differ in length
  void charts(const std::vector<Plot>& plots, const std::string& caption = "");

  std::string html() const;
  const std::string& text() const noexcept { return text_; }

 private:
  std::string title_;
  std::string body_, text_;
  nlohmann::ordered_json charts_ = nlohmann::ordered_json::array();
};

}  // namespace talus::cli
