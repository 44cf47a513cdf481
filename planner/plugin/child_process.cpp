#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <talus/planner/plugin/child_process.hpp>

#ifdef __linux__
#include <sys/prctl.h>
#endif

namespace talus::planner {
namespace {

using Clock = std::chrono::steady_clock;

void sendAll(int pipe, const std::string& bytes) {
  const char* from = bytes.data();
  std::size_t left = bytes.size();
  while (left > 0) {
    const ssize_t sent = write(pipe, from, left);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return;
    from += sent;
    left -= static_cast<std::size_t>(sent);
  }
}

void limitMemory(std::uint64_t memory) {
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const rlim_t most = pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)) + memory;
  const rlimit limit{most, most};
  setrlimit(RLIMIT_AS, &limit);
}

[[noreturn]] void work(const std::function<std::string()>& work, const ChildLimits& limits, int pipe,
                       [[maybe_unused]] pid_t parent) {
#ifdef __linux__
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);  // the parent ended before prctl()
#endif
  dup2(STDERR_FILENO, STDOUT_FILENO);  // standard output is reserved for the program
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  for (const int number : {SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT, SIGINT, SIGTERM})
    signal(number, SIG_DFL);
  if (limits.memory > 0) limitMemory(limits.memory);
  try {
    sendAll(pipe, work());
  } catch (...) {  // the parent then reports Died
    _exit(1);
  }
  _exit(0);
}

ChildAnswer::End received(int pipe, const ChildLimits& limits, Clock::time_point begin,
                          const ProgressMonitor& watch, std::string& bytes) {
  constexpr int kLook_ms = 20;
  char part[65536];
  for (;;) {
    pollfd ready{.fd = pipe, .events = POLLIN, .revents = 0};
    while (poll(&ready, 1, kLook_ms) <= 0) {
      if (watch.stopped()) return ChildAnswer::End::Stopped;
      if (std::chrono::duration<double>(Clock::now() - begin).count() > limits.seconds)
        return ChildAnswer::End::TooLate;
    }
    const ssize_t got = read(pipe, part, sizeof part);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return ChildAnswer::End::Answered;
    bytes.append(part, static_cast<std::size_t>(got));
    if (bytes.size() > limits.bytes) return ChildAnswer::End::TooMuch;
  }
}

// Waits for the end of a child after its pipe was closed; the child may continue to run.
ChildAnswer::End awaited(pid_t child, const ChildLimits& limits, Clock::time_point begin,
                         const ProgressMonitor& watch) {
  siginfo_t ended{};
  while (waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         ended.si_pid == 0) {
    if (watch.stopped()) return ChildAnswer::End::Stopped;
    if (std::chrono::duration<double>(Clock::now() - begin).count() > limits.seconds)
      return ChildAnswer::End::TooLate;
    poll(nullptr, 0, 1);
  }
  return ChildAnswer::End::Answered;
}

}  // namespace

ChildAnswer inChild(const std::function<std::string()>& job, const ChildLimits& limits,
                    const ProgressMonitor& watch) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error(std::string("no pipe to a process: ") + std::strerror(errno));
  const auto begin = Clock::now();
  const pid_t parent = getpid(), child = fork();
  if (child < 0) {
    close(ends[0]);
    close(ends[1]);
    throw std::runtime_error(std::string("no process can be made: ") + std::strerror(errno));
  }
  if (child == 0) {
    close(ends[0]);
    work(job, limits, ends[1], parent);
  }
  close(ends[1]);
  ChildAnswer answer;
  answer.end = received(ends[0], limits, begin, watch, answer.bytes);
  close(ends[0]);
  if (answer.end == ChildAnswer::End::Answered) answer.end = awaited(child, limits, begin, watch);
  if (answer.end != ChildAnswer::End::Answered) kill(child, SIGKILL);
  rusage used{};
  int status = 0;
  while (wait4(child, &status, 0, &used) < 0 && errno == EINTR) {
  }
  answer.megabytes = static_cast<double>(used.ru_maxrss) / 1024.0;
  if (answer.end == ChildAnswer::End::Answered && !(WIFEXITED(status) && WEXITSTATUS(status) == 0)) {
    answer.end = ChildAnswer::End::Died;
    answer.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    answer.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
  }
  if (answer.end != ChildAnswer::End::Answered) answer.bytes.clear();
  return answer;
}

}  // namespace talus::planner
