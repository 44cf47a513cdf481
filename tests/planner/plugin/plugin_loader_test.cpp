#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <poll.h>
#include <refused.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include <talus/common/common.hpp>
#include <talus/planner/plugin/global_planner.hpp>

#include "drawn_map.hpp"

namespace talus::planner {

namespace plugin_loader_test {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(PluginLoader, LoadsAPluginAndPlans) {
  const auto planner = loadPlugin(TALUS_PLUGIN);
  EXPECT_EQ(planner->capabilities().interface_version, kPlannerInterfaceVersion);
  EXPECT_THAT(planner->capabilities().planners, ::testing::Contains("field"));
  planner->set_map(testing::drawn({"....", ".##.", "...."}));
  PlanRequest request;
  request.start = {0.5, 1.5};
  request.goal = {3.5, 1.5};
  const Route route = planner->plan(request);
  ASSERT_EQ(route.status, RouteStatus::Found) << route.reason;
  EXPECT_EQ(route.planner, "field");
  EXPECT_GE(route.vertices.size(), 4u);  // Property: a detour around two cells has two turns or more
}

TEST(PluginLoader, LibraryStaysLoadedWhileItsPlannersExist) {
  std::unique_ptr<GlobalPlanner> another = loadPlugin(TALUS_PLUGIN)->create();
  another->set_map(testing::drawn({"....", "...."}));
  PlanRequest request;
  request.start = {0.5, 0.5};
  request.goal = {3.5, 0.5};
  EXPECT_EQ(another->plan(request).status, RouteStatus::Found);
}

TEST(PluginLoader, OtherInterfaceVersionIsRejected) {
  EXPECT_THAT([] { loadPlugin(TALUS_OTHER_PLUGIN); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("built for planner interface 99"),
                                              HasSubstr("this program has 9"), HasSubstr("rebuild"))));
}

// The dynamic linker ends the process without a signal if the table of relative relocations contains another
// kind of entry. The library is therefore tried in a child process.
TEST(PluginLoader, LibraryThatAbortsTheLinkerIsRejected) {
  std::ifstream file(TALUS_OTHER_PLUGIN, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  const auto word = [&](std::size_t at) {
    std::uint64_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
  };
  // Entries of 24 bytes with the kind in the middle: R_X86_64_RELATIVE is 8.
  std::size_t at = 0;
  while (at + 56 < bytes.size() && !(word(at) == 8 && word(at + 24) == 8 && word(at + 48) == 8)) at += 8;
  if (at + 56 >= bytes.size()) GTEST_SKIP() << "no such table on this machine";
  bytes[at] = 6;
  const std::string path = ::testing::TempDir() + "talus_damaged_plugin.so";
  std::ofstream(path, std::ios::binary) << bytes;
  EXPECT_THAT([&] { loadPlugin(path); },
              ThrowsMessage<InputError>(HasSubstr("ends the process that loads it (exit code 127)")));
  std::filesystem::remove(path);
}

// Property: a library that hangs while it is loaded or unloaded is rejected after a time limit.
TEST(PluginLoader, LibraryThatHangsOnLoadOrUnloadIsRejected) {
  for (const std::string path : {TALUS_ENDLESS_PLUGIN, TALUS_UNENDING_PLUGIN})
    EXPECT_THAT(
        [&] { loadPlugin(path, 0.2); },
        ThrowsMessage<InputError>(AllOf(HasSubstr(path), HasSubstr("within 0.2 s"), HasSubstr("fix"))));
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1) << "a child is left";
}

// Property: if the program is killed during a trial, the trial's child process ends as well.
TEST(PluginLoader, TrialProcessEndsWithTheProgram) {
  for (const int signal : {SIGTERM, SIGINT, SIGKILL}) {
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    const pid_t program = ::fork();
    if (program == 0) {
      ::setenv("TALUS_ENDLESS_PLUGIN", std::to_string(ends[1]).c_str(), 1);
      try {
        loadPlugin(TALUS_ENDLESS_PLUGIN, 60.0);
      } catch (...) {
      }
      ::_exit(0);
    }
    ::close(ends[1]);
    char byte = 0;
    ASSERT_EQ(::read(ends[0], &byte, 1), 1);  // the constructor is running
    ::kill(program, signal);
    ASSERT_EQ(::waitpid(program, nullptr, 0), program);
    pollfd closed{.fd = ends[0], .events = POLLIN, .revents = 0};
    EXPECT_EQ(::poll(&closed, 1, 10000), 1) << "the trial lives on after signal " << signal;
    EXPECT_TRUE(closed.revents & POLLHUP);
    ::close(ends[0]);
  }
}

TEST(PluginLoader, TruncatedLibraryIsRejected) {
  const auto cut = std::filesystem::temp_directory_path() / "talus_cut_plugin_test.so";
  const auto whole = std::filesystem::file_size(TALUS_PLUGIN);
  // The last bytes of the file hold symbols that loading does not need; with debug information they are most
  // of the file.
  for (const auto size : {whole / 100, whole / 30, whole / 10}) {
    std::filesystem::copy_file(TALUS_PLUGIN, cut, std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(cut, size);
    EXPECT_REFUSED(loadPlugin(cut.string()), InputError, "it is truncated, damaged or of another machine")
        << size;
  }
  std::filesystem::remove(cut);
}

TEST(PluginLoader, FilesThatAreNoPluginAreRejectedByName) {
  EXPECT_THAT([] { loadPlugin("/nowhere/planner.so"); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("/nowhere/planner.so"), HasSubstr("no such file"))));
  EXPECT_THROW(loadPlugin("/"), InputError);
  EXPECT_THROW(loadPlugin(""), InputError);
  const auto text = std::filesystem::temp_directory_path() / "talus_no_plugin_test.so";
  std::ofstream(text) << "not a library\n";
  EXPECT_THAT([&] { loadPlugin(text.string()); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("cannot be loaded as a shared library: "),
                                              Not(HasSubstr("Bad file descriptor")))));
  std::filesystem::remove(text);
  EXPECT_THAT([] { loadPlugin(TALUS_PLAIN_LIBRARY); },
              ThrowsMessage<InputError>(HasSubstr("exports no talus_planner")));
}

TEST(RequestCheck, EachUnsupportedFieldIsRejectedByName) {
  // Property: a request with one field set is accepted exactly if the planner declares the capability of
  // that field.
  struct Case {
    const char* field;
    void (*set)(PlanRequest&);
    void (*honour)(PlannerCapabilities&);
  };
  const Case cases[] = {
      {"via",
       [](PlanRequest& r) {
         r.via = {{1, 1}};
       },
       [](auto& c) { c.via_points = true; }},
      {"other_goals",
       [](PlanRequest& r) {
         r.other_goals = {{1, 1}};
       },
       [](auto& c) { c.several_goals = true; }},
      {"start_heading_rad", [](PlanRequest& r) { r.start_heading_rad = 0.0; },
       [](auto& c) { c.headings = true; }},
      {"goal_heading_rad", [](PlanRequest& r) { r.goal_heading_rad = 0.0; },
       [](auto& c) { c.headings = true; }},
      {"kinematics", [](PlanRequest& r) { r.kinematics = Kinematics{}; },
       [](auto& c) { c.turning_radius = true; }},
      {"may_reverse", [](PlanRequest& r) { r.kinematics = Kinematics{.may_reverse = false}; },
       [](auto& c) { c.turning_radius = c.reversing = true; }},
      {"risk_limit", [](PlanRequest& r) { r.risk_limit = RiskLimit{}; },
       [](auto& c) { c.risk_limit = true; }},
  };
  EXPECT_NO_THROW(requireHonoured({}, {}));
  for (const Case& c : cases) {
    PlanRequest request;
    c.set(request);
    PlannerCapabilities offers{.name = "made", .planner = "plain"};
    if (std::string(c.field) == "may_reverse") offers.turning_radius = true;
    EXPECT_THAT([&] { requireHonoured(request, offers); },
                ThrowsMessage<std::invalid_argument>(
                    AllOf(HasSubstr(c.field), HasSubstr("not honoured by planner 'plain' of made"))));
    c.honour(offers);
    EXPECT_NO_THROW(requireHonoured(request, offers)) << c.field;
  }
}

TEST(RequestCheck, ChassisIsRejectedIfUnsupported) {
  const maps::Raster<float> flat({.width = 4, .height = 4, .resolution_m = 1.0, .south_west = {}}, 0.0F);
  terramech::Rover rover;
  rover.wheelbase_m = rover.track_m = 0.5;
  PlanRequest request;
  request.chassis = std::make_shared<const Chassis>(flat, rover, Suspension::Rigid);
  EXPECT_THROW(requireHonoured(request, {}), std::invalid_argument);
  EXPECT_NO_THROW(requireHonoured(request, {.chassis = true}));
}

TEST(RequestCheck, ValuesOutOfRangeAreRejectedWithTheirBound) {
  const PlannerCapabilities all{.headings = true, .turning_radius = true, .risk_limit = true};
  const auto refused = [&all](const PlanRequest& request) { return [&] { requireHonoured(request, all); }; };
  PlanRequest request;
  request.start_heading_rad = NAN;
  EXPECT_THAT(refused(request),
              ThrowsMessage<std::invalid_argument>(HasSubstr("start_heading_rad = nan, must be finite")));
  request = {};
  request.goal.x_m = INFINITY;
  EXPECT_THAT(refused(request),
              ThrowsMessage<std::invalid_argument>(HasSubstr("goal.x_m = inf, must be finite")));
  request = {};
  request.via = {{1.0, NAN}};
  EXPECT_THROW(requireHonoured(request, {.via_points = true}), std::invalid_argument);
  request = {};
  request.tolerance_m = -1.0;
  EXPECT_THAT(refused(request),
              ThrowsMessage<std::invalid_argument>(HasSubstr("tolerance_m = -1, must be >= 0")));
  request = {};
  request.kinematics = Kinematics{.turning_radius_m = -2.0};
  EXPECT_THAT(refused(request), ThrowsMessage<std::invalid_argument>(HasSubstr("turning_radius_m = -2")));
  request.kinematics = Kinematics{.turning_radius_m = 1e-9};
  EXPECT_THAT(refused(request),
              ThrowsMessage<std::invalid_argument>(HasSubstr("must be 0 or 0.001 to 1000")));
  request = {};
  request.risk_limit = RiskLimit{.immobilisation = 1.0};
  EXPECT_THAT(refused(request), ThrowsMessage<std::invalid_argument>(HasSubstr("above 0 and below 1")));
}

}  // namespace plugin_loader_test

}  // namespace talus::planner
