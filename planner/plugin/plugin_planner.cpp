#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <exception>
#include <fstream>
#include <new>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <talus/planner/bound/lower_bound.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/plugin/global_planner.hpp>
#include <talus/planner/plugin/plugin_export.hpp>
#include <talus/planner/plugin/plugin_planner.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/stop_check.hpp>

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
namespace talus::planner {

namespace {

using maps::Point;

constexpr double kSamePlace_m = 1e-6;

// Type codes: first byte of a result.
constexpr char kText = 't', kRoute = 'r', kInput = 'i', kThrown = 'x', kNoMemory = 'm';

}  // namespace

std::string oneLine(std::string text) {
  if (text.size() > kLongestPluginText) text.resize(kLongestPluginText);
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  return text;
}

namespace {

struct Head {
  RouteStatus status = RouteStatus::NoneFound;
  std::size_t vertices = 0;
};

std::string bytesOf(const Route& route) {
  const bool found = route.status == RouteStatus::Found;
  const Head head{route.status, found ? route.vertices.size() : 0};
  std::string bytes(1 + sizeof head, kRoute);
  std::memcpy(bytes.data() + 1, &head, sizeof head);
  if (!found) return bytes + oneLine(route.reason);
  if (head.vertices > PluginPlanner::kMostVertices) return bytes;
  for (const RouteVertex& vertex : route.vertices) {
    const double place[]{vertex.x_m, vertex.y_m};
    bytes.append(reinterpret_cast<const char*>(place), sizeof place);
  }
  return bytes;
}

// Runs plugin work in the child process; exceptions become text results.
std::string messageOf(const std::function<std::string()>& work) {
  silenceStreams();
  try {
    return work();
  } catch (const InputError& error) {
    return kInput + error.parts().where + '\n' + error.parts().reason + '\n' + error.parts().remedy;
  } catch (const std::bad_alloc&) {
    return std::string(1, kNoMemory);
  } catch (const std::exception& error) {
    return kThrown + oneLine(error.what());
  } catch (...) {
    return kThrown + std::string("something that is no std::exception");
  }
}

}  // namespace

void failPlugin(const std::string& file, const std::string& what) {
  throw InputError({file, what, "report this to its author, or remove the plugin"});
}

std::string answerOf(const std::string& file, const std::function<std::string()>& work,
                     const ChildLimits& limits, const ProgressMonitor& watch) {
  ChildAnswer answer = inChild([&] { return messageOf(work); }, limits, watch);
  switch (answer.end) {
    case ChildAnswer::End::Stopped:
      return {};
    case ChildAnswer::End::TooLate:
      failPlugin(file, "did not end within its time limit and was ended");
    case ChildAnswer::End::TooMuch:
      failPlugin(file, "answered with more than was requested");
    case ChildAnswer::End::Died:
      failPlugin(file, std::string("ended its process") +
                           (answer.signal != 0 ? std::string(" (") + strsignal(answer.signal) + ")" : ""));
    case ChildAnswer::End::Answered:
      break;
  }
  if (answer.bytes.empty()) failPlugin(file, "gave no answer");
  const std::string text = answer.bytes.substr(1);
  if (answer.bytes[0] == kNoMemory)
    failPlugin(file, limits.memory == 0
                         ? "takes more memory than there is"
                         : "takes more than " + std::to_string(limits.memory >> 20) + " MB of memory");
  if (answer.bytes[0] == kThrown) failPlugin(file, "threw an error: " + text);
  if (answer.bytes[0] == kInput) {
    const std::size_t first = text.find('\n'), second = text.find('\n', first + 1);
    throw InputError({oneLine(text.substr(0, first)), oneLine(text.substr(first + 1, second - first - 1)),
                      oneLine(text.substr(second + 1))});
  }
  return std::move(answer.bytes);
}

namespace {

PlanRequest requestOf(const Problem& problem, const ProgressMonitor& watch) {
  PlanRequest request{.start = problem.start,
                      .goal = problem.goal,
                      .other_goals = problem.other_goals,
                      .tolerance_m = problem.goal_tolerance_m,
                      .via = problem.via,
                      .start_heading_rad = problem.start_heading_rad,
                      .goal_heading_rad = problem.goal_heading_rad,
                      .prove = problem.prove,
                      .gap = problem.gap,
                      .watch = watch};
  if (problem.kinematics.turning_radius_m > 0.0 || !problem.kinematics.may_reverse)
    request.kinematics = problem.kinematics;
  return request;
}

bool near(Point a, Point b, double reach_m) {
  return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m) <= reach_m + kSamePlace_m;
}

// Returns the index of the goal at which a route ends; -1: none.
int goalOf(const Problem& problem, Point end) {
  if (near(end, problem.goal, problem.goal_tolerance_m)) return 0;
  for (std::size_t i = 0; i < problem.other_goals.size(); ++i)
    if (near(end, problem.other_goals[i], problem.goal_tolerance_m)) return static_cast<int>(i) + 1;
  return -1;
}

bool passes(const std::vector<Point>& points, const std::vector<Point>& via) {
  std::size_t at = 0;
  for (const Point& place : via) {
    while (at < points.size() && !near(points[at], place, 0.0)) ++at;
    if (at == points.size()) return false;
  }
  return true;
}

std::string text(Point p) {
  return std::to_string(p.x_m) + ',' + std::to_string(p.y_m);
}

// Compares the headings of the polyline, regardless of the headings stated by the plugin, with the requested
// headings and the turning radius; no check for a rover that turns in place. Chords represent arcs: each
// heading may deviate by half of the chord's change of heading, for chords of up to 0.4 of the radius; the
// rest of a longer chord is treated as straight.
std::string motionAgainst(const Problem& problem, const std::vector<Point>& points) {
  const double radius_m = problem.kinematics.turning_radius_m;
  if (!(radius_m > 0.0) || points.size() < 2) return {};
  struct Chord {
    double heading_rad, length_m;
    double bend_rad(double r_m) const { return std::asin(std::min(0.2, 0.5 * length_m / r_m)); }
  };
  std::vector<Chord> chords;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double dx = points[i].x_m - points[i - 1].x_m, dy = points[i].y_m - points[i - 1].y_m;
    if (std::hypot(dx, dy) > kSamePlace_m) chords.push_back({std::atan2(dy, dx), std::hypot(dx, dy)});
  }
  if (chords.empty()) return {};
  constexpr double kRounding_rad = 0.02;
  const bool reverse = problem.kinematics.may_reverse;
  const auto off = [reverse](double a, double b) {
    const double apart = std::abs(std::remainder(a - b, 2.0 * std::numbers::pi));
    return reverse ? std::min(apart, std::numbers::pi - apart) : apart;
  };
  const auto wrong = [&](const Chord& chord, const std::optional<double>& wanted) {
    return wanted && off(chord.heading_rad, *wanted) > chord.bend_rad(radius_m) + kRounding_rad;
  };
  if (wrong(chords.front(), problem.start_heading_rad)) return "it does not leave on the start heading";
  if (wrong(chords.back(), problem.goal_heading_rad)) return "it does not arrive on the goal heading";
  for (std::size_t i = 1; i < chords.size(); ++i)
    if (off(chords[i].heading_rad, chords[i - 1].heading_rad) >
        chords[i].bend_rad(radius_m) + chords[i - 1].bend_rad(radius_m) + kRounding_rad)
      return "it bends at turn " + std::to_string(i) + " by more than the turning radius allows";
  return {};
}

// Reason why the route of a plugin is refused; empty if the route is valid.
std::string heldAgainst(const Problem& problem, const std::vector<Point>& points) {
  if (!near(points.front(), problem.start, 0.0)) return "it begins at " + text(points.front());
  if (goalOf(problem, points.back()) < 0) return "it ends at " + text(points.back());
  if (!passes(points, problem.via)) return "it leaves out a via point";
  const double cells = length_m(points) / problem.map->grid().resolution_m;
  if (!(cells <= PluginPlanner::kMostCells))
    return "it is " + std::to_string(std::llround(cells)) + " cells long, must be at most " +
           std::to_string(PluginPlanner::kMostCells);
  if (const std::string motion = motionAgainst(problem, points); !motion.empty()) return motion;
  const auto found = violations(*problem.map, points, problem.watch);
  if (!found.empty()) return "at " + text(found.front().place) + " m: " + found.front().reason;
  return {};
}

}  // namespace

PluginPlanner::PluginPlanner(std::string file, std::string planner)
    : file_(std::move(file)), planner_(std::move(planner)) {
  const std::string bytes = answerOf(
      file_,
      [&] {
        const auto loaded = loadPlugin(file_);
        const PlannerCapabilities offers = loaded->capabilities();
        if (!planner_.empty() && std::ranges::find(offers.planners, planner_) == offers.planners.end()) {
          std::string all;
          for (const std::string& known : offers.planners) all += (all.empty() ? "" : ", ") + known;
          throw InputError({file_, "has no planner '" + planner_ + "'", "it offers " + all});
        }
        loaded->configure({.planner = planner_});
        const std::string chosen = loaded->capabilities().planner;
        return kText + oneLine(chosen.empty() ? offers.name : chosen + " of " + offers.name);
      },
      {.seconds = 10.0, .bytes = 10 * kLongestPluginText, .memory = kMostPluginMemory}, {});
  name_ = bytes.substr(1);
}

Plan PluginPlanner::unchecked(const Problem& problem) const {
  const std::string bytes = answerOf(
      file_,
      [&] {
        const auto loaded = loadPlugin(file_);
        loaded->configure({.planner = planner_,
                           .seed = problem.seed,
                           .threads = problem.threads,
                           .time_limit_s = problem.time_limit_s});
        loaded->set_map(problem.map);
        return bytesOf(loaded->plan(requestOf(problem, {})));
      },
      {.seconds = problem.time_limit_s + 1.0,
       .bytes = 2 * kLongestPluginText + 16 * kMostVertices,
       .memory = kMostPluginMemory},
      problem.watch);
  if (bytes.empty()) return failedPlan(RouteStatus::Cancelled, "cancelled before a route was found");
  Head head;
  if (bytes[0] != kRoute || bytes.size() < 1 + sizeof head) failPlugin(file_, "gave no route");
  std::memcpy(&head, bytes.data() + 1, sizeof head);
  if (head.vertices > kMostVertices)
    failPlugin(file_, "returned a route of " + std::to_string(head.vertices) + " vertices, must be at most " +
                          std::to_string(kMostVertices));
  if (head.status != RouteStatus::Found)
    return failedPlan(head.status == RouteStatus::NoRoute || head.status > RouteStatus::Cancelled
                          ? RouteStatus::NoneFound  // the plugin's status is no proof
                          : head.status,
                      name_ + ": " + bytes.substr(1 + sizeof head));
  Plan plan;
  plan.points.resize(head.vertices);
  if (head.vertices == 0) failPlugin(file_, "returned a route without a vertex");
  if (bytes.size() != 1 + sizeof head + head.vertices * sizeof(Point))
    failPlugin(file_, "gave no whole route");
  std::memcpy(plan.points.data(), bytes.data() + 1 + sizeof head, head.vertices * sizeof(Point));
  for (std::size_t i = 0; i < plan.points.size(); ++i)
    if (!std::isfinite(plan.points[i].x_m) || !std::isfinite(plan.points[i].y_m))
      failPlugin(file_, "returned a route whose vertex " + std::to_string(i) + " is " + text(plan.points[i]));
  plan.status = RouteStatus::Found;
  return plan;
}

Plan PluginPlanner::plan(const Problem& problem) const {
  Plan plan = unchecked(problem);
  if (plan.status != RouteStatus::Found) return plan;
  const std::string against = heldAgainst(problem, plan.points);
  if (problem.watch.stopped())
    return failedPlan(RouteStatus::Cancelled, "cancelled before the route was checked");
  if (!against.empty()) {
    plan =
        failedPlan(RouteStatus::NoneFound, "no route: the check refuses that of " + name_ + ": " + against);
    plan.refused = true;
    return plan;
  }
  plan.goal = static_cast<std::size_t>(goalOf(problem, plan.points.back()));
  plan.cost_J = MotionCost(problem.map).along(plan.points);
  const Segment ends{plan.points.front(), plan.points.back()};
  const bool one_leg = problem.prove && problem.via.empty() && problem.other_goals.empty();
  const auto proven_J = [&] {
    const AddedTime proof(plan.proof_s);
    return LowerBound()(problem.map, ends, 0.0, StopCheck(problem.watch), plan.cost_J);
  };
  const double bound_J = one_leg ? proven_J() : straightBound_J(*problem.map, ends, 0.0);
  plan.lower_bound_J = std::min(plan.cost_J, bound_J);
  return plan;
}

}  // namespace talus::planner
namespace talus::planner {

namespace {

constexpr char kCells = 'c';

std::string asked(const std::string& file, const maps::Grid& grid) {
  const boost::dll::shared_library library = openedLibrary(file);
  if (!library.has("talus_layer") || !library.has("talus_layer_interface"))
    throw InputError({file, "exports no talus_layer", "export one with TALUS_EXPORT_LAYER"});
  const int built_for = library.get_alias<const int>("talus_layer_interface");
  if (built_for != kLayerInterfaceVersion)
    throw InputError({file,
                      "built for layer interface " + std::to_string(built_for) + ", this program has " +
                          std::to_string(kLayerInterfaceVersion),
                      "rebuild the plugin against the installed talus"});
  const std::vector<float> cells = library.get_alias<CostSource>("talus_layer").over(grid);
  if (cells.size() != grid.size())
    throw InputError(
        {file,
         "answered for " + std::to_string(cells.size()) + " cells, must be " + std::to_string(grid.size()),
         "report this to its author, or remove the plugin"});
  std::string bytes(1 + cells.size() * sizeof(float), kCells);
  std::memcpy(bytes.data() + 1, cells.data(), cells.size() * sizeof(float));
  return bytes;
}

}  // namespace

costmap::CostLayer layerFrom(const std::string& file, const std::string& name, const maps::Grid& grid) {
  const std::size_t size = grid.size() * sizeof(float);
  const std::string bytes = answerOf(
      file, [&] { return asked(file, grid); },
      {.seconds = 60.0, .bytes = size + 10 * kLongestPluginText, .memory = std::uint64_t{4} << 30}, {});
  if (bytes.size() != 1 + size || bytes[0] != kCells) failPlugin(file, "gave no whole layer");
  costmap::CostLayer layer{.name = name, .added_J_per_m = maps::Raster<float>(grid)};
  std::memcpy(layer.added_J_per_m.values().data(), bytes.data() + 1, size);
  for (const float v : layer.added_J_per_m.values()) {
    if (std::isnan(v) || v == INFINITY) continue;
    if (!(v >= 0.0F && v <= costmap::CostLayer::kMost_J_per_m))
      failPlugin(file, "answered with " + std::to_string(v) + " J/m, must be 0 to 1e6, infinite or NaN");
    layer.unseen_J_per_m = std::max(layer.unseen_J_per_m, v);
  }
  return layer;
}

}  // namespace talus::planner
