#include <chrono>
#include <memory>
#include <utility>

#include <CLI/CLI.hpp>
#include <cli/context.hpp>
#include <cli/site_options.hpp>
#include <costmap/ground_class.hpp>
#include <costmap/map_file.hpp>
#include <costmap/octomap_surface.hpp>
#include <terramech/soil_library.hpp>

namespace talus::cli {
namespace {

using costmap::TraversabilityMap;

class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

struct Defaults {
  const char* rover;
  const char* soil;
};

// What drives and what is driven on where the user says nothing, by body; local maps count as Earth.
Defaults defaultsFor(const maps::ElevationMap& map) {
  const std::string body = map.georeference ? map.georeference->body() : "Earth";
  if (body == "Moon") return {"lunar_micro", "lunar_nominal"};
  if (body == "Mars") return {"mer", "mars_blocky"};
  return {"fido", "testbed_topsoil"};
}

std::vector<costmap::GroundClass> groundClasses(const SiteOptions& options, const terramech::Rover& rover,
                                                const std::string& soil) {
  if (options.soils.empty() || (options.layers.terrain.empty() && !options.soil.empty()))
    return {costmap::groundClass(0, terramech::loadSoilPrior(soil), rover)};
  std::vector<costmap::GroundClass> classes;
  for (const auto& [number, prior] : terramech::loadTerrainClasses(options.soils))
    classes.push_back(costmap::groundClass(number, prior, rover));
  return classes;
}

maps::ElevationMap readDem(const SiteOptions& options, const Context& context) {
  if (costmap::octomapType(options.map.path)) return costmap::octomapSurface(options.map.path);
  return readMap(options.map, context);
}

costmap::MapLayers readSite(const SiteOptions& options, const Context& context) {
  costmap::MapLayers site;
  site.elevation = readDem(options, context);
  Layers layers = readLayers(options.layers, site.elevation);
  site.classes = std::move(layers.classes);
  site.rock_abundance = std::move(layers.rock_abundance);
  site.keep_out = std::move(layers.keep_out);
  return site;
}

std::shared_ptr<const costmap::GroundModel> groundModel(const SiteOptions& options,
                                                        const maps::ElevationMap& map) {
  const Defaults defaults = defaultsFor(map);
  const terramech::Rover rover = terramech::loadRover(options.rover.empty() ? defaults.rover : options.rover);
  const std::string soil = options.soil.empty() ? defaults.soil : options.soil;
  return std::make_shared<costmap::GroundModel>(costmap::GroundModel::Parts{
      .rover = rover, .classes = groundClasses(options, rover, soil), .policy = options.policy});
}

void requireSoils(const SiteOptions& options) {
  if (!options.layers.terrain.empty() && options.soils.empty())
    throw InputError(
        {options.layers.terrain, "terrain classes without soils", "pass --soils FILE with a soil per class"});
}

std::vector<std::string> inputsOf(const SiteOptions& options) {
  std::vector<std::string> inputs;
  for (const std::string& path :
       {options.map.path, options.map_file, options.layers.terrain, options.soils, options.layers.rocks})
    if (!path.empty()) inputs.push_back(path);
  inputs.insert(inputs.end(), options.layers.keep_out.begin(), options.layers.keep_out.end());
  return inputs;
}

// The map file to go on from: --map, or a DEM that is one.
std::string savedMap(const SiteOptions& options) {
  if (!options.map_file.empty()) return options.map_file;
  return costmap::octomapType(options.map.path) == "TraversabilityTree" ? options.map.path : "";
}

void bindPolicy(CLI::App& command, costmap::DrivePolicy& policy) {
  const char* group = "Policy";
  command
      .add_flag("--allow-dangerous", policy.allow_dangerous, "drive dangerous ground that can give the pull")
      ->group(group);
  command.add_flag("!--avoid-marginal", policy.allow_marginal, "refuse marginal ground too")->group(group);
  command.add_flag("--allow-unknown", policy.allow_unknown, "treat cells without data as flat ground")
      ->group(group);
  command
      .add_option("--risk", policy.max_immobilisation,
                  "refuse ground that is likelier than this to hold the rover")
      ->check(CLI::Range(0.0, 1.0))
      ->type_name("ALPHA")
      ->group(group);
  command.add_option("--risk-weight", policy.risk_weight_J, "joules that losing the rover is worth")
      ->type_name("J")
      ->group(group);
  command.add_option("--time-weight", policy.time_weight_W, "joules that a second is worth")
      ->type_name("W")
      ->group(group);
  command.add_option("--slope-margin", policy.slope_margin_rad, "doubt about the slope in the category rule")
      ->type_name("RAD")
      ->group(group);
}

}  // namespace

void addSiteOptions(CLI::App& command, SiteOptions& options) {
  addMapOptions(command, options.map);
  addLayerOptions(command, options.layers);
  command.add_option("--map", options.map_file, "belief map to go on from (MAP.ot)")->type_name("MAP.ot");
  command.add_option("--rover", options.rover, "rover: library name or YAML")->type_name("NAME|FILE");
  command.add_option("--soil", options.soil, "soil of ground without a class: library name or YAML")
      ->type_name("NAME|FILE");
  command.add_option("--soils", options.soils, "soils of the terrain classes")->type_name("FILE");
  command.add_option("--footprint", options.footprint_radius_m, "radius over which slope is measured")
      ->type_name("METRES");
  bindPolicy(command, options.policy);
}

Site buildSite(const SiteOptions& options, const Context& context) {
  const Stopwatch load;
  if (const std::string saved = savedMap(options); !saved.empty()) {
    TraversabilityMap map = costmap::readMap(saved, context.workers(), context.watch("reading the map"));
    return {.map = std::move(map), .inputs = inputsOf(options), .load_s = load.seconds(), .costmap_s = 0.0};
  }
  requireSoils(options);
  costmap::MapLayers layers = readSite(options, context);
  auto model = groundModel(options, layers.elevation);
  const double load_s = load.seconds();
  const Stopwatch build;
  TraversabilityMap map(std::move(layers), std::move(model),
                        {.footprint_radius_m = options.footprint_radius_m, .threads = context.workers()},
                        context.watch("costmap"));
  return {.map = std::move(map), .inputs = inputsOf(options), .load_s = load_s, .costmap_s = build.seconds()};
}

}  // namespace talus::cli
