#include <pthread.h>
#include <unistd.h>

#include <talus/cli/app/context.hpp>
#include <talus/cli/app/interrupt.hpp>

namespace talus::cli {

Interrupt::Interrupt() {
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
  listener_ = std::thread([this] { listen(); });
}

Interrupt::~Interrupt() {
  closing_ = true;
  // The listener has SIGTERM blocked and waits for it: this wakes it.
  // NOLINTNEXTLINE(bugprone-bad-signal-to-kill-thread)
  pthread_kill(listener_.native_handle(), SIGTERM);
  listener_.join();
}

void Interrupt::listen() {
  for (int signal = 0; sigwait(&signals_, &signal) == 0;) {
    if (closing_) return;
    if (!source_.request_stop()) _exit(Exit::kCancelled);
  }
}

}  // namespace talus::cli
