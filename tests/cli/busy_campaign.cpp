#include "busy_campaign.hpp"

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <thread>

#include <sys/wait.h>
#include <unistd.h>

namespace talus::cli {
namespace {

struct Process {
  int parent = 0;
  bool program = false;
  double cpu_s = 0.0;
};

// Running processes. Fields of /proc/PID/stat by proc(5): 2 name in brackets, 4 parent, 14 and 15 CPU ticks.
std::map<int, Process> processes() {
  std::map<int, Process> all;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    std::ifstream file(entry.path() / "stat");
    std::string line;
    if (!std::getline(file, line)) continue;  // the process has ended
    const std::size_t open = line.find('('), close = line.rfind(')');
    if (open == std::string::npos || close == std::string::npos) continue;
    std::istringstream rest(line.substr(close + 1));
    std::string word;
    Process process{.program = line.substr(open + 1, close - open - 1) == "talus"};
    double ticks = 0.0, part = 0.0;
    rest >> word >> process.parent;
    for (int field = 5; field <= 15 && rest >> part; ++field)
      if (field >= 14) ticks += part;
    process.cpu_s = ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
    all[std::stoi(name)] = process;
  }
  return all;
}

int busyRuns(int ancestor) {
  const std::map<int, Process> all = processes();
  const auto below = [&](int pid) {
    for (auto at = all.find(pid); at != all.end(); at = all.find(at->second.parent))
      if (at->first == ancestor) return true;
    return false;
  };
  int busy = 0;
  for (const auto& [pid, process] : all) {
    const auto parent = all.find(process.parent);
    const bool run = process.program && parent != all.end() && parent->second.program;
    busy += run && process.cpu_s >= 0.5 && below(pid) ? 1 : 0;
  }
  return busy;
}

}  // namespace

int interruptedWhenBusy(const std::string& line, int runs) {
  const pid_t child = fork();
  if (child == 0) {
    execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
    _exit(127);
  }
  int status = 0;
  for (bool sent = false; waitpid(child, &status, WNOHANG) == 0;) {
    if (!sent && busyRuns(child) >= runs) sent = kill(child, SIGINT) == 0;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace talus::cli
