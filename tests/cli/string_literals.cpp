#include "string_literals.hpp"

#include <regex>

namespace talus::cli {

std::vector<std::string> stringLiterals(const std::string& source) {
  // Alternatives that are skipped come first, so that a quote within them does not begin a literal.
  static const std::regex piece(R"re(//[^\n]*|/\*[^]*?\*/|#include[^\n]*|'(?:\\.|[^'\\])'|\d'(?=\d))re"
                                R"re(|R"\(([^]*?)\)"|"((?:\\.|[^"\\])*)"|[^\s"'/]+|/)re");
  std::vector<std::string> literals;
  bool joined = false;  // whether a directly following literal continues the last one
  for (auto at = source.cbegin(); at != source.cend();) {
    std::smatch found;
    if (!std::regex_search(at, source.cend(), found, piece)) break;
    at = found[0].second;
    if (found[2].matched && joined)
      literals.back() += found[2];
    else if (found[1].matched || found[2].matched)
      literals.push_back(found[1].matched ? found[1] : found[2]);
    const bool comment = found.str().starts_with("//") || found.str().starts_with("/*");
    joined = found[2].matched || (comment && joined);
  }
  return literals;
}

}  // namespace talus::cli
