// talus generate KIND: generates an example site with all its layers.
#include <algorithm>
#include <array>
#include <filesystem>
#include <regex>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include <talus/cli/app/command.hpp>
#include <talus/common/limits.hpp>
#include <talus/maps/maps_io.hpp>
#include <talus/maps/sites/site_generator.hpp>

namespace talus::cli {
namespace {

struct GenerateOptions {
  std::string kind, size, output;
  maps::SiteOptions site;
};

// Soil of each class. The loose lunar soils are ours, weaker than the nominal soil within the ranges of
// [heiken_1991].
constexpr const char* kLunarSoils = R"(terrain_classes:
  1: lunar_nominal
  2: {name: lunar_loose, cohesion_Pa: 100, friction_angle_deg: 32, sinkage_exponent: 1.0, cohesive_modulus: 1000,
      frictional_modulus: 400000, shear_modulus_mm: 20, density_kg_m3: 1400}
  3: {name: lunar_very_loose, cohesion_Pa: 50, friction_angle_deg: 28, sinkage_exponent: 1.0, cohesive_modulus: 500,
      frictional_modulus: 150000, shear_modulus_mm: 25, density_kg_m3: 1250}
  4: bedrock
)";

constexpr const char* kMartianSoils = R"(terrain_classes:
  1: mars_crusty
  2: dry_sand
  3: mars_drift
  4: bedrock
)";

// Parses a size in cells, "512" or "512x400".
std::pair<int, int> parseSize(const std::string& text) {
  static const std::regex size(R"((\d{1,5})(x(\d{1,5}))?)");
  std::smatch found;
  if (std::regex_match(text, found, size)) {
    const int width = std::stoi(found[1]), height = found[3].matched ? std::stoi(found[3]) : width;
    if (std::min(width, height) >= 8 && std::max(width, height) <= 20000) return {width, height};
  }
  throw InputError({"--size " + text, "is not a size in cells", "write N or WIDTHxHEIGHT, 8 to 20000 each"});
}

// Adds a suffix to the file name: site.tif becomes site_classes.tif.
std::string beside(const std::string& output, const std::string& suffix) {
  std::filesystem::path path(output);
  return (path.parent_path() / (path.stem().string() + suffix)).string();
}

struct Paths {
  std::string map, classes, rocks, soils;
};

Paths pathsOf(const std::string& output) {
  return {output, beside(output, "_classes.tif"), beside(output, "_rocks.tif"),
          beside(output, "_soils.yaml")};
}

void write(const maps::Site& site, maps::SiteKind kind, const Paths& paths) {
  const maps::Georeference* georeference = &*site.map.georeference;
  OutputFile map(paths.map), classes(paths.classes), rocks(paths.rocks), soils(paths.soils);
  maps::writeGeoTiff({paths.map, georeference, &map}, {{"elevation", "m", site.map.elevation_m}});
  maps::writeGeoTiff({paths.classes, georeference, &classes}, "terrain class", site.classes, std::nullopt);
  maps::writeGeoTiff({paths.rocks, georeference, &rocks}, {{"rock abundance", "", site.rock_abundance}});
  soils.write(kind == maps::SiteKind::Craters ? kLunarSoils : kMartianSoils);
  for (OutputFile* file : {&map, &classes, &rocks, &soils}) file->commit();
}

constexpr std::array<std::pair<std::string_view, maps::SiteKind>, 3> kKinds{
    {{"craters", maps::SiteKind::Craters},
     {"dunes", maps::SiteKind::Dunes},
     {"rocks", maps::SiteKind::Rocks}}};

void bind(CLI::App& command, GenerateOptions& options) {
  std::vector<std::string> names;
  for (const auto& [name, kind] : kKinds) names.emplace_back(name);
  addOption(command, "KIND", options.kind)->required()->check(CLI::IsMember(names));
  addOption(command, "--size N", options.size);
  addOption(command, "--resolution METRES", options.site.resolution_m)->check(CLI::Range(0.01, 1000.0));
  addOutput(command, "-o,--output FILE.tif", options.output)->required();
}

maps::SiteOptions siteOf(const GenerateOptions& options, const Context& context) {
  maps::SiteOptions site = options.site;
  site.kind =
      std::ranges::find(kKinds, options.kind, &std::pair<std::string_view, maps::SiteKind>::first)->second;
  if (!options.size.empty()) std::tie(site.width, site.height) = parseSize(options.size);
  site.seed = context.seed;
  site.threads = context.workers();
  return site;
}

int run(const GenerateOptions& options, Context& context) {
  const maps::SiteOptions wanted = siteOf(options, context);
  const Paths paths = pathsOf(options.output);
  if (!context.force)
    for (const std::string& path : {paths.classes, paths.rocks, paths.soils})
      checkOutput(path, {options.output});
  const OutputFile folder_can_be_written(options.output);
  constexpr double kBytesPerCell = 32.0;  // measured
  requireMemory(kBytesPerCell * wanted.width * wanted.height, "--size");
  const maps::Site site = maps::generateSite(wanted, context.watch("site"));
  if (context.stop.stop_requested()) return Exit::kCancelled;
  write(site, wanted.kind, paths);
  context.answer({{"map", paths.map},
                  {"classes", paths.classes},
                  {"rocks", paths.rocks},
                  {"soils", paths.soils},
                  {"width", wanted.width},
                  {"height", wanted.height},
                  {"resolution_m", wanted.resolution_m},
                  {"seed", wanted.seed}},
                 fmt::format("{}\n{}\n{}\n{}\n", paths.map, paths.classes, paths.rocks, paths.soils));
  return Exit::kDone;
}

}  // namespace

void addGenerate(CLI::App& app, Context& context) {
  addCommand<GenerateOptions>(app, context, "generate", bind, run);
}

}  // namespace talus::cli
