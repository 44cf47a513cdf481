// talus doctor: capabilities of this installation and the values in use.
#include <vector>

#include <cpl_string.h>
#include <gdal.h>
#include <ogr_srs_api.h>

#include <talus/cli/app/command.hpp>
#include <talus/common/limits.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/planner/route/problem.hpp>
#include <talus/terramech/terramech_io.hpp>

namespace talus::cli {
namespace {

using Json = nlohmann::ordered_json;

struct DoctorOptions {
  const CLI::App* program = nullptr;
};

void bind(CLI::App& command, DoctorOptions& options) {
  options.program = command.get_parent();
}

// A value and its origin.
Json inForce(const CLI::App& program, const char* option, const std::string& value) {
  return {{"value", value}, {"origin", program.get_option(option)->count() > 0 ? option : "default"}};
}

// Splits the wanted drivers into those that this GDAL provides and those that are missing.
Json driversOf(const std::vector<std::string>& wanted) {
  Json there = Json::array(), missing = Json::array();
  for (const std::string& name : wanted)
    (GDALGetDriverByName(name.c_str()) != nullptr ? there : missing).push_back(name);
  return {{"there", there}, {"missing", missing}};
}

bool findsProjData() {
  const maps::GdalErrors quiet;
  OGRSpatialReferenceH system = OSRNewSpatialReference(nullptr);
  const bool found = OSRImportFromEPSG(system, 2056) == OGRERR_NONE;
  OSRDestroySpatialReference(system);
  return found;
}

Json findings(const CLI::App& program, const Context& context) {
  maps::registerDrivers();
  int major = 0, minor = 0, patch = 0;
  OSRGetPROJVersion(&major, &minor, &patch);
  const std::vector<std::string> rasters = maps::rasterFormats();
  return {{"version", TALUS_VERSION},
          {"options",
           {{"threads", inForce(program, "--threads", std::to_string(context.workers()))},
            {"max_memory_GB", inForce(program, "--max-memory", fmt::format("{:.1f}", 1e-9 * memoryBudget()))},
            {"seed", inForce(program, "--seed", std::to_string(context.seed))}}},
          {"gdal", GDALVersionInfo("RELEASE_NAME")},
          {"proj", fmt::format("{}.{}.{}", major, minor, patch)},
          {"proj_data", findsProjData()},
          {"raster_drivers", driversOf(rasters)},
          {"vector_drivers", driversOf(maps::vectorFormats())},
#ifdef TALUS_MPI
          {"mpi", true},
#else
          {"mpi", false},
#endif
          {"planners", planner::plannerNames()},
          {"soils", terramech::librarySoils().size()},
          {"rovers", terramech::libraryRovers().size()}};
}

std::vector<std::string> faultsOf(const Json& found) {
  std::vector<std::string> faults;
  for (const char* kind : {"raster_drivers", "vector_drivers"})
    for (const std::string name : found[kind]["missing"])
      faults.push_back("GDAL lacks the driver " + name + ": install gdal-plugins, or unset GDAL_SKIP");
  if (!found["proj_data"].get<bool>())
    faults.emplace_back(
        "PROJ does not find proj.db, so that no EPSG code is known: install proj-data, or unset PROJ_LIB");
  return faults;
}

std::string words(const Json& list) {
  return list.empty() ? "none" : fmt::format("{}", fmt::join(list.get<std::vector<std::string>>(), ", "));
}

std::string textOf(const Json& found) {
  std::string text = fmt::format("talus           {}\n", found["version"].get<std::string>());
  for (const auto& [name, option] : found["options"].items())
    text += fmt::format("{:15} {} ({})\n", name, option["value"].get<std::string>(),
                        option["origin"].get<std::string>());
  text += fmt::format("GDAL, PROJ      {}, {}\n", found["gdal"].get<std::string>(),
                      found["proj"].get<std::string>());
  text += fmt::format("rasters         {}\n", words(found["raster_drivers"]["there"]));
  text += fmt::format("vector files    {}\n", words(found["vector_drivers"]["there"]));
  text += fmt::format("MPI             {}\n", found["mpi"].get<bool>() ? "built in" : "not built in");
  text += fmt::format("planners        {}\n", words(found["planners"]));
  return text + fmt::format("library         {} soils, {} rovers\n", found["soils"].get<int>(),
                            found["rovers"].get<int>());
}

int run(const DoctorOptions& options, Context& context) {
  Json found = findings(*options.program, context);
  const std::vector<std::string> faults = faultsOf(found);
  found["faults"] = faults;
  context.answer(found, textOf(found));
  for (const std::string& fault : faults) context.warn(fault);
  return faults.empty() ? Exit::kDone : Exit::kNo;
}

}  // namespace

void addDoctor(CLI::App& app, Context& context) {
  addCommand<DoctorOptions>(app, context, "doctor", bind, run);
}

}  // namespace talus::cli
