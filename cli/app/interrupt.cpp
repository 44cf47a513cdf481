#include <ctime>

#include <pthread.h>
#include <unistd.h>

#include <talus/cli/app/context.hpp>
#include <talus/cli/app/interrupt.hpp>
#include <talus/common/output_file.hpp>

namespace talus::cli {
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

}  // namespace talus::cli
