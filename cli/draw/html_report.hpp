#pragma once

#include <string>
#include <vector>

#include <talus/cli/draw/plot.hpp>

namespace talus::cli {

/// Returns the text with characters escaped that HTML reads as markup.
std::string escaped(const std::string& text);

/// A self-contained HTML page of headings, paragraphs, tables and charts, in the order in which they are
/// added.
class HtmlReport {
 public:
  explicit HtmlReport(std::string title) : title_(std::move(title)) {}

  void heading(const std::string& text);
  void paragraph(const std::string& text);
  /// Adds a table. Numeric cells are right-aligned. On a narrow screen, each row of a wide table is shown as
  /// a list of its columns.
  void table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows);
  /// Adds charts, which are shown side by side if the screen is wide enough.
  void charts(const std::vector<Plot>& plots);

  /// Returns the finished page.
  std::string html() const;

 private:
  std::string title_;
  std::string body_;
  int wide_tables_ = 0;
};

}  // namespace talus::cli
