// talus costmap DEM -o MAP.ot: builds a traversability map and writes it to files.

#include <talus/cli/app/command.hpp>
#include <talus/cli/draw/page.hpp>
#include <talus/cli/draw/scene.hpp>
#include <talus/cli/ground/file_formats.hpp>
#include <talus/cli/ground/mission.hpp>
#include <talus/costmap/costmap.hpp>
#include <talus/costmap/map/ground_curves.hpp>
#include <talus/costmap/surface/surface_shape.hpp>
#include <talus/costmap/surface/surface_tree.hpp>
#include <talus/maps/vector/vector_writer.hpp>

namespace talus::cli {
namespace {

struct CostmapOptions {
  GroundOptions ground;
  std::string output;
  std::string geotiff;
  std::string categories;
  std::string nav2;
  std::string png;
  std::string octovis;
  std::string unsafe;
};

void bind(CLI::App& command, CostmapOptions& options) {
  addGroundOptions(command, options.ground);
  addOutput(command, "-o,--output MAP.ot", options.output);
  addOutput(command, "--geotiff FILE.tif", options.geotiff);
  addOutput(command, "--categories FILE.tif", options.categories);
  addOutput(command, "--nav2 FILE.yaml", options.nav2);
  addOutput(command, "--png FILE.png", options.png);
  addOutput(command, "--octovis FILE.ot", options.octovis);
  addOutput(command, "--unsafe AREA.gpkg", options.unsafe);
}

void writeUnsafe(const costmap::TraversabilityMap& map, const std::string& path) {
  HeadingsOfCells headings(map);
  maps::Raster<std::uint8_t> unsafe(map.grid());
  costmap::forEachCell(costmap::allOf(map.grid()), [&](maps::Cell cell) {
    const AllowedHeadings allowed = headings.at(cell);
    unsafe[cell] = allowed == AllowedHeadings::None || allowed == AllowedHeadings::Unknown ? 1 : 0;
  });
  writeFile(path, maps::areaFile(map.elevation(), unsafe, "unsafe", path));
}

void writeOctovis(const costmap::TraversabilityMap& map, const std::string& path) {
  OutputFile file(path);
  costmap::PlaceBeliefs beliefs(map);
  const auto tree = costmap::colorTree({map.elevation().elevation_m, map.surface().keys()},
                                       [&](maps::Cell cell) { return beliefs.at(cell); });
  tree->write(file.stream());
  file.commit();
}

void writeFiles(const CostmapOptions& options, const costmap::TraversabilityMap& map,
                const Context& context) {
  if (!options.output.empty()) costmap::writeMap(map, options.output);
  if (!options.geotiff.empty()) writeLayers(map, options.geotiff, context.workers());
  if (!options.categories.empty()) writeCategories(map, options.categories);
  if (!options.nav2.empty()) writeNav2Map(map, options.nav2);
  if (!options.png.empty()) saveScene(sceneOf(map, {.title = map.elevation().source}), "", options.png);
  if (!options.octovis.empty()) writeOctovis(map, options.octovis);
  if (!options.unsafe.empty()) writeUnsafe(map, options.unsafe);
}

std::string costmapText(const Ground& site, const costmap::CategoryCounts& counts) {
  const auto share = [&](std::size_t n) {
    return 100.0 * static_cast<double>(n) / static_cast<double>(site.map.grid().size());
  };
  return fmt::format("cells       {} x {} of {:.6g} m, footprint diameter {:.3g} m\n", site.map.grid().width,
                     site.map.grid().height, site.map.grid().resolution_m,
                     2.0 * site.map.surface().footprintRadius_m()) +
         fmt::format("rover       {}\n", site.map.model().rover().name) +
         fmt::format(
             "safe        {:.1f} %\nmarginal    {:.1f} %\ndangerous   {:.1f} %\nunknown     {:.1f} %\n",
             share(counts.safe), share(counts.marginal), share(counts.dangerous), share(counts.unknown)) +
         fmt::format("run time    load {:.3f} s, costmap {:.3f} s\n", site.load_s, site.build_s);
}

nlohmann::ordered_json costmapJson(const Ground& site, const costmap::CategoryCounts& counts) {
  return {{"cells", site.map.grid().size()},
          {"categories",
           {{"safe", counts.safe},
            {"marginal", counts.marginal},
            {"dangerous", counts.dangerous},
            {"unknown", counts.unknown}}},
          {"seconds", site.load_s + site.build_s},
          {"seconds_load", site.load_s},
          {"seconds_costmap", site.build_s},
          {"rover", site.map.model().rover().name}};
}

int run(CostmapOptions& options, Context& context) {
  readMission(options.ground);
  for (const auto& [file, extension] :
       {std::pair{options.nav2, ".pgm"}, {options.categories, ".qml"}, {options.geotiff, ".qml"}})
    if (!file.empty() && !context.force)
      checkOutput(std::filesystem::path(file).replace_extension(extension), {options.ground.elevation.path});
  const Ground site = readGround(options.ground, context);
  if (context.stop.stop_requested()) return Exit::kCancelled;
  const costmap::CategoryCounts counts = site.map.costs().countCategories();
  writeFiles(options, site.map, context);
  context.answer(costmapJson(site, counts), costmapText(site, counts));
  return Exit::kDone;
}

}  // namespace

void addCostmap(CLI::App& app, Context& context) {
  addCommand<CostmapOptions>(app, context, "costmap", bind, run);
}

}  // namespace talus::cli
