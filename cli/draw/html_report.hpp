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
