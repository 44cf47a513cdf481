#include <boost/dll/shared_library.hpp>

#include <talus/planner/plugin/plugin_loader.hpp>

namespace talus::planner {
namespace {

boost::dll::shared_library opened(const std::string& path) {
  boost::dll::fs::error_code error;
  if (!boost::dll::fs::is_regular_file(path, error))
    throw InputError({path, "no such file", "name a planner's shared library (.so)"});
  boost::dll::shared_library library;
  // A path without a folder would be searched for in the system's library folders instead.
  library.load(boost::dll::fs::absolute(path), error);
  if (error || !library.is_loaded())
    throw InputError(
        {path, "cannot be loaded as a shared library: " + error.message(), "rebuild it for this machine"});
  return library;
}

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

// Declared in this order so that the planner goes before the code it runs.
struct Loaded {
  boost::dll::shared_library library;
  std::unique_ptr<GlobalPlanner> planner;
};

}  // namespace

std::shared_ptr<GlobalPlanner> loadPlugin(const std::string& path) {
  auto loaded = std::make_shared<Loaded>();
  loaded->library = opened(path);
  requireInterface(loaded->library, path);
  loaded->planner = loaded->library.get_alias<GlobalPlanner>("talus_planner").create();
  GlobalPlanner* planner = loaded->planner.get();
  return {std::move(loaded), planner};
}

}  // namespace talus::planner
