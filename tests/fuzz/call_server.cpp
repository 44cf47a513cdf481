// Answers calls of the program without starting it for each: tests/fuzz/mutate_calls.py is its client. A request is one line of
// JSON on standard input, {"folder": F, "words": [W...]}; the call runs in a child of its own, in that folder, from the first
// line of the program on, with no input, its errors in F/.said and 20 s of CPU time. The answer is one line: the exit code, 128
// and the signal where one ended it, -1 where it took more than 120 s in all; the most memory it held [kB]; its CPU time [s].
#include <csignal>
#include <cstdio>
#include <iostream>
#include <string>
#include <vector>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <talus/cli/app/commands.hpp>

namespace {

constexpr rlim_t kCpu_s = 20;
constexpr unsigned kWall_s = 120;

void redirect(int stream, const char* path, int flags) {
  const int file = ::open(path, flags, 0600);
  if (file < 0 || ::dup2(file, stream) < 0) std::_Exit(99);
  ::close(file);
}

[[noreturn]] void call(const std::string& folder, const std::vector<std::string>& words) {
  const rlimit cpu{kCpu_s, kCpu_s}, core{0, 0};
  ::setrlimit(RLIMIT_CPU, &cpu);
  ::setrlimit(RLIMIT_CORE, &core);
  ::alarm(kWall_s);
  if (::chdir(folder.c_str()) != 0) std::_Exit(99);
  redirect(STDIN_FILENO, "/dev/null", O_RDONLY);
  redirect(STDOUT_FILENO, "/dev/null", O_WRONLY);
  redirect(STDERR_FILENO, ".said", O_WRONLY | O_CREAT | O_TRUNC);
  std::vector<const char*> arguments{"talus"};
  for (const std::string& word : words) arguments.push_back(word.c_str());
  arguments.push_back(nullptr);
  std::exit(talus::cli::run(static_cast<int>(words.size()) + 1, arguments.data(), talus::cli::addCommands));
}

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

int main() {
  for (std::string line; std::getline(std::cin, line);) {
    const nlohmann::json request = nlohmann::json::parse(line);
    const pid_t child = ::fork();
    if (child < 0) return 1;
    if (child == 0)
      call(request["folder"].get<std::string>(), request["words"].get<std::vector<std::string>>());
    int status = 0;
    rusage used{};
    if (::wait4(child, &status, 0, &used) != child) return 1;
    int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM) code = -1;
    std::printf("%d %ld %.3f\n", code, used.ru_maxrss, seconds(used.ru_utime) + seconds(used.ru_stime));
    std::fflush(stdout);
  }
}
