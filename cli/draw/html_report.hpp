#pragma once

#include <string>
#include <vector>

#include <talus/cli/draw/plot.hpp>

namespace talus::cli {

/// Returns the text with the characters that HTML reads as markup escaped.
std::string escaped(const std::string& text);

/// A self-contained HTML page of headings, paragraphs, tables and charts, in the order they are added.
class HtmlReport {
 public:
  explicit HtmlReport(std::string title) : title_(std::move(title)) {}

  void heading(const std::string& text);
  void paragraph(const std::string& text);
  /// Adds a table. Numeric cells are right-aligned; on a phone each row of a wide table is a list of its
  /// columns.
  void table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows);
  /// Adds charts, side by side as far as the screen is wide enough.
  void charts(const std::vector<Plot>& plots);

  /// The finished page.
  std::string html() const;

 private:
  std::string title_;
  std::string body_;
  int wide_tables_ = 0;
};

}  // namespace talus::cli
