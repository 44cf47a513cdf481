#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <talus/cli/app/context.hpp>

namespace talus::cli {
namespace {

/// Progress bar of 30 marks. Redrawn only if its percentage changes; erased at 100 %.
class Bar {
 public:
  explicit Bar(std::string_view what) : what_(what) {}

  void operator()(double fraction) {
    const int percent = static_cast<int>(100.0 * std::fmin(std::fmax(fraction, 0.0), 1.0));
    if (percent == shown_) return;
    shown_ = percent;
    if (percent == 100) return erase();
    printError(fmt::format("\r{} [{:<30}] {:3d} %", what_,
                           std::string(static_cast<std::size_t>(percent * 30 / 100), '#'), percent));
  }

 private:
  static void erase() { printError("\r\033[K"); }

  std::string what_;
  int shown_ = -1;
};

}  // namespace

ProgressMonitor Context::watch(std::string_view what) const {
  ProgressMonitor watch{.progress = {}, .stop = stop};
  if (!quiet && isatty(STDERR_FILENO) != 0) watch.progress = Bar(what);
  return watch;
}

int Context::workers() const noexcept {
  return threads > 0 ? threads : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

void Context::warn(std::string_view text) const {
  if (!quiet) printError(fmt::format("talus: warning: {}\n", oneLine(text)));
}

std::string jsonText(const nlohmann::ordered_json& value, int indent) {
  return value.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

void printJson(const nlohmann::ordered_json& value) {
  print(jsonText(value, 2) + "\n");
}

void print(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stdout);
}

void printError(std::string_view text) noexcept {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

std::string oneLine(std::string_view text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) text.remove_suffix(1);
  std::string line;
  for (const char c : text) {
    if (c == '\n')
      line += "; ";
    else
      line += std::iscntrl(static_cast<unsigned char>(c)) != 0 ? ' ' : c;
  }
  // A byte that is not valid UTF-8 becomes U+FFFD, as in JSON.
  return nlohmann::json::parse(jsonText(line)).get<std::string>();
}

}  // namespace talus::cli
