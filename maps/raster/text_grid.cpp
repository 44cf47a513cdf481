#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <fstream>
#include <string_view>
#include <system_error>

#include <talus/common/input_error.hpp>
#include <talus/maps/raster/text_grid.hpp>

namespace talus::maps {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 20;
constexpr std::size_t kLongest = 400;  // no number is so long

// Decimal commas are GDAL's, too.
bool isNumber(std::string_view word) {
  if (word.size() > kLongest) return false;
  std::string text(word);
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
  if (std::ranges::count(text, ',') == 1 && text.find('.') == text.npos) std::ranges::replace(text, ',', '.');
  std::string_view rest = text;
  if (rest.starts_with('+') || rest.starts_with('-')) rest.remove_prefix(1);
  for (const std::string_view known : {"nan", "inf", "infinity", "1.#inf", "1.#ind", "1.#qnan", "1.#snan"})
    if (rest == known) return true;
  if (rest.starts_with('+') || rest.starts_with('-')) return false;
  double value = 0.0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
  return error != std::errc::invalid_argument && end == rest.data() + rest.size();
}

bool isKey(std::string_view word) {
  return !word.empty() && std::isalpha(static_cast<unsigned char>(word.front())) != 0 && !isNumber(word);
}

// Names of the header come before the first value, each with a number.
class Words {
 public:
  explicit Words(const std::string& path) : path_(path) {}

  void take(std::string_view word, std::size_t line) {
    if (header_ && !value_of_key_ && isKey(word)) {
      value_of_key_ = true;
      return;
    }
    if (!value_of_key_) header_ = false;
    value_of_key_ = false;
    if (isNumber(word)) return;
    throw InputError({path_ + ":" + std::to_string(line),
                      "'" + std::string(word.substr(0, 40)) + "' is not a number",
                      "write the NODATA_value, or nan, where nothing is known"});
  }

 private:
  const std::string& path_;
  bool header_ = true, value_of_key_ = false;
};

}  // namespace

void refuseWordsInGrid(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string piece(kPiece, '\0'), word;
  Words words(path);
  std::size_t line = 1;
  while (file.read(piece.data(), static_cast<std::streamsize>(piece.size())), file.gcount() > 0)
    for (const char c : std::string_view(piece.data(), static_cast<std::size_t>(file.gcount()))) {
      const bool between = c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\0';
      if (!between && word.size() <= kLongest) word += c;
      if (between && !word.empty()) {
        words.take(word, line);
        word.clear();
      }
      line += c == '\n' ? 1U : 0U;
    }
  if (!word.empty()) words.take(word, line);
}

}  // namespace talus::maps
