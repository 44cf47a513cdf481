#include <atomic>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>

#include <talus/cli/app/status_line.hpp>

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

}  // namespace talus::cli
