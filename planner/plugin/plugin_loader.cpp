#include <cmath>
#include <cstring>
#include <functional>
#include <new>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include <boost/dll/shared_library.hpp>
#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

#include <talus/common/common.hpp>
#include <talus/planner/plugin/global_planner.hpp>
#include <talus/planner/plugin/plugin_planner.hpp>
#include <talus/terramech/contact/load_transfer.hpp>

namespace talus::planner {

namespace {

constexpr char kCameThrough = 'k', kMemory = 'm';

// Loads a library, creates its planner and unloads the library, in a child process. A damaged or foreign
// library may end the process, by a signal or by the dynamic linker's exit, or never return; kCameThrough is
// then not returned. Output of library and linker is discarded.
std::string tried(const std::function<void()>& load) {
  silenceStreams();
  try {
    load();
  } catch (const std::bad_alloc&) {  // without the memory limit the parent would not fail
    return {kMemory};
  } catch (...) {  // the parent gets and reports the same error
  }
  return {kCameThrough};
}

ChildAnswer trial(const std::string& path, const std::function<void()>& load, double trial_s) {
  try {
    return inChild([&] { return tried(load); },
                   {.seconds = trial_s, .bytes = 1, .memory = kMostPluginMemory});
  } catch (const std::runtime_error& e) {
    throw InputError({path, std::string("cannot be tried: ") + e.what(), "free some memory"});
  }
}

void requireLoadable(const std::string& path, const std::function<void()>& load, double trial_s) {
  const ChildAnswer answer = trial(path, load, trial_s);
  if (answer.end == ChildAnswer::End::TooLate) {
    std::ostringstream reason;
    reason << "does not end being loaded and unloaded within " << trial_s << " s";
    throw InputError(
        {path, reason.str(), "fix what its constructors and destructors wait for, or do without it"});
  }
  if (answer.bytes == std::string{kMemory})
    throw InputError({path, "needs more memory to be loaded than a plugin may have",
                      "report this to its author, or remove the plugin"});
  if (answer.bytes == std::string{kCameThrough}) return;
  const std::string how = answer.signal != 0 ? std::string(::strsignal(answer.signal))
                                             : "exit code " + std::to_string(answer.exit_code);
  throw InputError({path, "ends the process that loads it (" + how + ")",
                    "it is truncated, damaged or of another machine: rebuild it"});
}

}  // namespace

void silenceStreams() {
  const int nowhere = ::open("/dev/null", O_WRONLY);
  if (nowhere < 0) return;
  ::dup2(nowhere, STDOUT_FILENO);
  ::dup2(nowhere, STDERR_FILENO);
}

namespace {

// Reason of the dynamic linker. Boost always reports "Bad file descriptor".
std::string linkerReason(const std::string& path) {
  const char* said = ::dlerror();
  std::string reason = said != nullptr ? said : "it is none";
  if (reason.starts_with(path + ": ")) reason.erase(0, path.size() + 2);
  return reason;
}

}  // namespace

boost::dll::shared_library openedLibrary(const std::string& path) {
  checkInput(path);
  boost::dll::fs::error_code error;
  if (!boost::dll::fs::is_regular_file(path, error))
    throw InputError({path, "no such file", "name a plugin's shared library (.so)"});
  boost::dll::shared_library library;
  // A path without a folder would be searched for in the system's library folders.
  const boost::dll::fs::path absolute = boost::dll::fs::absolute(path);
  library.load(absolute, error);
  if (error || !library.is_loaded())
    throw InputError({path, "cannot be loaded as a shared library: " + linkerReason(absolute.string()),
                      "name a plugin (.so) that is built for this machine"});
  return library;
}

namespace {

void requireInterface(const boost::dll::shared_library& library, const std::string& path) {
  if (!library.has("talus_planner") || !library.has("talus_planner_interface"))
    throw InputError({path, "exports no talus_planner", "export one with TALUS_EXPORT_PLANNER"});
  const int built_for = library.get_alias<const int>("talus_planner_interface");
  if (built_for != kPlannerInterfaceVersion)
    throw InputError({path,
                      "built for planner interface " + std::to_string(built_for) + ", this program has " +
                          std::to_string(kPlannerInterfaceVersion),
                      "rebuild the plugin against the installed talus"});
}

// A planner of a shared library, which stays loaded for the lifetime of the planner. Fields of a request that
// the planner does not honour are refused here, so that no plugin can ignore them.
class Loaded final : public GlobalPlanner {
 public:
  Loaded(std::shared_ptr<boost::dll::shared_library> library, std::unique_ptr<GlobalPlanner> planner)
      : library_(std::move(library)), planner_(std::move(planner)) {}

  PlannerCapabilities capabilities() const override { return planner_->capabilities(); }
  void configure(const PlannerSettings& settings) override { planner_->configure(settings); }
  void set_map(std::shared_ptr<const costmap::CostGrid> map) override { planner_->set_map(std::move(map)); }
  void update(std::shared_ptr<const costmap::CostGrid> newer) override { planner_->update(std::move(newer)); }
  Route plan(const PlanRequest& request) override {
    requireHonoured(request, planner_->capabilities());
    return planner_->plan(request);
  }
  std::unique_ptr<GlobalPlanner> create() const override {
    return std::make_unique<Loaded>(library_, planner_->create());
  }

 private:
  // The planner must be destroyed before the library that contains its code.
  std::shared_ptr<boost::dll::shared_library> library_;
  std::unique_ptr<GlobalPlanner> planner_;
};

std::unique_ptr<GlobalPlanner> loaded(const std::string& path) {
  auto library = std::make_shared<boost::dll::shared_library>(openedLibrary(path));
  requireInterface(*library, path);
  auto planner = library->get_alias<GlobalPlanner>("talus_planner").create();
  return std::make_unique<Loaded>(std::move(library), std::move(planner));
}

}  // namespace

std::unique_ptr<GlobalPlanner> loadPlugin(const std::string& path, double trial_s) {
  requireLoadable(
      path, [&] { loaded(path); }, trial_s);
  return loaded(path);
}

namespace {

[[noreturn]] void outOfRange(const std::string& field, double value, const std::string& bound) {
  std::ostringstream text;
  text << "PlanRequest: " << field << " = " << value << ", must be " << bound;
  throw std::invalid_argument(text.str());
}

void requireFinite(const std::string& field, const maps::Point& place) {
  if (!std::isfinite(place.x_m)) outOfRange(field + ".x_m", place.x_m, "finite");
  if (!std::isfinite(place.y_m)) outOfRange(field + ".y_m", place.y_m, "finite");
}

void requireRanges(const PlanRequest& request) {
  requireFinite("start", request.start);
  requireFinite("goal", request.goal);
  for (const maps::Point& goal : request.other_goals) requireFinite("other_goals", goal);
  for (const maps::Point& via : request.via) requireFinite("via", via);
  const auto finite = [](const char* field, const std::optional<double>& heading_rad) {
    if (heading_rad && !std::isfinite(*heading_rad)) outOfRange(field, *heading_rad, "finite");
  };
  finite("start_heading_rad", request.start_heading_rad);
  finite("goal_heading_rad", request.goal_heading_rad);
  if (!(request.gap >= 0 && request.gap < 1)) outOfRange("gap", request.gap, "at least 0 and below 1");
  if (!(request.tolerance_m >= 0)) outOfRange("tolerance_m", request.tolerance_m, ">= 0");
  if (request.kinematics && !terramech::isTurningRadius(request.kinematics->turning_radius_m))
    outOfRange("kinematics.turning_radius_m", request.kinematics->turning_radius_m, "0 or 0.001 to 1000");
  if (!request.risk_limit) return;
  const RiskLimit& risk = *request.risk_limit;
  if (!(risk.immobilisation > 0 && risk.immobilisation < 1))
    outOfRange("risk_limit.immobilisation", risk.immobilisation, "above 0 and below 1");
  if (!(risk.correlation_length_m > 0))
    outOfRange("risk_limit.correlation_length_m", risk.correlation_length_m, "> 0");
}

}  // namespace

void requireHonoured(const PlanRequest& request, const PlannerCapabilities& offers) {
  const auto refuse = [&offers](bool asked, bool honoured, const char* field) {
    if (asked && !honoured)
      throw std::invalid_argument(std::string("PlanRequest: ") + field + " is not honoured by planner '" +
                                  offers.planner + "' of " + offers.name +
                                  "; configure one that does, or leave it out");
  };
  refuse(!request.via.empty(), offers.via_points, "via");
  refuse(!request.other_goals.empty(), offers.several_goals, "other_goals");
  refuse(request.start_heading_rad.has_value(), offers.headings, "start_heading_rad");
  refuse(request.goal_heading_rad.has_value(), offers.headings, "goal_heading_rad");
  refuse(request.kinematics.has_value(), offers.turning_radius, "kinematics");
  refuse(request.kinematics && !request.kinematics->may_reverse, offers.reversing,
         "kinematics.may_reverse = false");
  refuse(request.chassis != nullptr, offers.chassis, "chassis");
  refuse(request.risk_limit.has_value(), offers.risk_limit, "risk_limit");
  requireRanges(request);
}

const PlannerSettings& validated(const PlannerSettings& settings) {
  if (settings.threads < 1)
    throw std::invalid_argument("PlannerSettings: threads = " + std::to_string(settings.threads) +
                                ", must be >= 1");
  if (!(settings.time_limit_s > 0))
    throw std::invalid_argument("PlannerSettings: time_limit_s = " + std::to_string(settings.time_limit_s) +
                                ", must be > 0");
  return settings;
}

}  // namespace talus::planner
