#include <algorithm>
#include <cctype>
#include <cstdio>
#include <exception>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <talus/cli/app/context.hpp>
#include <talus/cli/app/status_line.hpp>

namespace talus::cli {
namespace {

// Returns true for what a terminal does not show but obeys: control characters except line break and tabulator,
// and the marks that turn the direction of writing.
bool isObeyed(char32_t c) {
  return (c < 0x20 && c != '\n' && c != '\t') || (c >= 0x7F && c < 0xA0) || c == 0x61C ||
         (c >= 0x200E && c <= 0x200F) || (c >= 0x2028 && c <= 0x202E) || (c >= 0x2066 && c <= 0x2069);
}

// Returns the text with blanks in place of what a terminal obeys. A byte that is not valid UTF-8 becomes
// U+FFFD, as in JSON.
std::string shown(std::string_view text) {
  const auto valid = nlohmann::json::parse(jsonText(std::string(text))).get<std::string>();
  std::string clean;
  for (std::size_t i = 0, size = 0; i < valid.size(); i += size) {
    const auto first = static_cast<unsigned char>(valid[i]);
    size = first < 0x80 ? 1 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
    char32_t c = size == 1 ? first : first & (0xFFU >> (size + 1));
    for (std::size_t k = 1; k < size; ++k) c = c << 6 | (static_cast<unsigned char>(valid[i + k]) & 0x3FU);
    clean.append(isObeyed(c) ? " " : valid.substr(i, size));
  }
  return clean;
}

void send(std::string_view text, std::FILE* stream) {
  const std::string clean = shown(text);
  std::fwrite(clean.data(), 1, clean.size(), stream);
}

}  // namespace

ProgressMonitor Context::watch(std::string_view what) const {
  ProgressMonitor watch{.progress = {}, .stop = stop};
  if (!quiet && status != nullptr && isatty(STDERR_FILENO) != 0) watch.progress = status->begin(what);
  return watch;
}

int Context::workers() const noexcept {
  return threads > 0 ? threads : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

void Context::warn(std::string_view text) const {
  if (status != nullptr) status->erase();
  if (!quiet) printError(fmt::format("talus: warning: {}\n", oneLine(text)));
}

void Context::answer(const nlohmann::ordered_json& result, std::string_view text) const {
  json ? printJson(result) : print(text);
}

std::string jsonText(const nlohmann::ordered_json& value, int indent) {
  return value.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

void printJson(const nlohmann::ordered_json& value) {
  print(value.dump(2, ' ', true, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

void print(std::string_view text) {
  send(text, stdout);
}

void printError(std::string_view text) noexcept {
  try {
    send(text, stderr);
  } catch (const std::exception&) {
    std::fputs("talus: no memory for a message\n", stderr);
  }
  std::fflush(stderr);
}

std::string oneLine(std::string_view text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) text.remove_suffix(1);
  std::string line;
  for (const char c : text) line += c == '\n' ? "; " : c == '\t' ? " " : std::string(1, c);
  return line;
}

}  // namespace talus::cli
