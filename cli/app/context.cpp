#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <pthread.h>
#include <unistd.h>

#include <talus/cli/app/context.hpp>
#include <talus/common/output_file.hpp>

namespace talus::cli {

namespace {

using Clock = std::chrono::steady_clock;

void draw(const std::string& text) {
  std::fputs(("\r" + text + "\033[K").c_str(), stderr);
}

}  // namespace

struct StatusLine::Phase {
  std::string what;
  Clock::time_point begin = Clock::now();
  std::atomic<double> fraction{0.0};
};

std::string progressText(std::string_view what, double fraction, double elapsed_s) {
  if (!(fraction > 0.0)) return fmt::format("{}, {:.0f} s so far", what, elapsed_s);
  const double done = std::fmin(fraction, 1.0);
  return fmt::format("{} [{:<30}] {:3.0f} %, {:.0f} s left", what,
                     std::string(static_cast<std::size_t>(done * 30.0), '#'), std::floor(100.0 * done),
                     elapsed_s * (1.0 - done) / done);
}

std::function<void(double)> StatusLine::begin(std::string_view what) {
  const std::shared_ptr<Phase> phase(new Phase{std::string(what)}, [this](const Phase* ended) {
    delete ended;
    erase();
  });
  const std::lock_guard lock(mutex_);
  phases_.push_back(phase);
  return [this, phase](double fraction) {
    phase->fraction = fraction;
    if (fraction >= 1.0) erase();
  };
}

void StatusLine::tick() {
  std::shared_ptr<Phase> phase;  // released after the lock
  const std::lock_guard lock(mutex_);
  while (!phases_.empty() && !(phase = phases_.back().lock())) phases_.pop_back();
  if (!phase || phase->fraction >= 1.0) return;
  const double elapsed_s = std::chrono::duration<double>(Clock::now() - phase->begin).count();
  if (elapsed_s < 0.5) return;
  draw(progressText(phase->what, phase->fraction, elapsed_s));
  drawn_ = true;
}

void StatusLine::erase() {
  // A child process, which has no thread that draws, may have a copy of a locked mutex.
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (lock && drawn_) draw("");
  if (lock) drawn_ = false;
}

namespace {

double cpuTime_s() noexcept {
  timespec used{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

}  // namespace

Interrupt::Interrupt() {
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
  listener_ = std::thread([this] { listen(); });
}

Interrupt::~Interrupt() {
  closing_ = true;
  // Wakes the listener thread, which has SIGTERM blocked and waits in sigtimedwait().
  // NOLINTNEXTLINE(bugprone-bad-signal-to-kill-thread)
  pthread_kill(listener_.native_handle(), SIGTERM);
  listener_.join();
}

void Interrupt::listen() {
  const timespec pause{.tv_sec = 0, .tv_nsec = 250'000'000L};
  int signal = 0;
  while ((signal = sigtimedwait(&signals_, nullptr, &pause)) <= 0) status_.tick();
  if (closing_) return;
  code_ = 128 + signal;
  source_.request_stop();
  watch();
}

void Interrupt::watch() {
  constexpr double kCpu_s = 0.4, kIdle_s = 1e-3;
  constexpr int kPiece_ms = 20, kPieces = 150, kIdlePieces = 15;
  const double from_s = cpuTime_s();
  double last_s = from_s;
  for (int piece = 0, idle = 0; (piece < kPieces && idle < kIdlePieces) || answered_; ++piece) {
    const timespec wait{.tv_sec = 0, .tv_nsec = kPiece_ms * 1'000'000L};
    const int signal = sigtimedwait(&signals_, nullptr, &wait);
    if (closing_) return;
    if (signal > 0) break;
    const double now_s = cpuTime_s();
    if (!answered_ && now_s - from_s > kCpu_s) break;
    idle = now_s - last_s < kIdle_s ? idle + 1 : 0;
    last_s = now_s;
  }
  removeUnfinishedFiles();
  status_.erase();
  printError("talus: cancelled\n");
  _exit(code_);
}

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

std::string shellWord(const std::string& word) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,:/@%";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

std::string oneLine(std::string_view text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) text.remove_suffix(1);
  std::string line;
  for (const char c : text) line += c == '\n' ? "; " : c == '\t' ? " " : std::string(1, c);
  return line;
}

}  // namespace talus::cli
