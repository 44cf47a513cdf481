#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <talus/cli/draw/canvas.hpp>
#include <talus/cli/ground/file_formats.hpp>
#include <talus/cli/ground/ground_options.hpp>
#include <talus/cli/ground/mission.hpp>
#include <talus/common/output_file.hpp>
#include <talus/maps/maps_io.hpp>

namespace talus::cli {

namespace {

using terramech::Category;

// Grey value for map_server's trinary mode: free above 0.9, occupied below 0.35.
char greyOf(Category category, bool allow_marginal) {
  constexpr char kFree = '\xFE', kOccupied = '\x00', kUnknown = '\x80';
  if (category == Category::Safe || (category == Category::Marginal && allow_marginal)) return kFree;
  return category == Category::Unknown ? kUnknown : kOccupied;
}

// QGIS style of a band whose values 0 to 3 have the colours of the categories. QGIS reads the file beside the
// GeoTIFF and would otherwise list all 256 palette entries.
std::string qgisStyle(std::ptrdiff_t band, const std::array<const char*, 4>& names) {
  std::string entries;
  for (std::size_t i = 0; i < names.size(); ++i)
    entries += fmt::format("<paletteEntry value=\"{}\" color=\"#{:06x}\" alpha=\"255\" label=\"{}\"/>\n", i,
                           pixel(colourOf(static_cast<Category>(i))) & 0xFFFFFFU, names[i]);
  return fmt::format(
      "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>\n<qgis version=\"3.22\">\n<pipe>\n"
      "<rasterrenderer type=\"paletted\" band=\"{}\" opacity=\"1\" alphaBand=\"-1\">\n<colorPalette>\n{}"
      "</colorPalette>\n</rasterrenderer>\n</pipe>\n</qgis>\n",
      band, entries);
}

// Writes a GeoTIFF by `write(file)`, and its QGIS style beside it.
template <typename Write>
void writeStyled(const costmap::TraversabilityMap& map, const std::string& path, const std::string& qgis,
                 Write write) {
  const auto& georeference = map.elevation().georeference;
  OutputFile raster(path), style(std::filesystem::path(path).replace_extension(".qml"));
  write(
      maps::GeoTiff{.path = path, .georeference = georeference ? &*georeference : nullptr, .into = &raster});
  style.write(qgis);
  raster.commit();
  style.commit();
}

}  // namespace

void writeLayers(const costmap::TraversabilityMap& map, const std::string& path, int threads) {
  const std::vector<maps::Layer> layers = siteLayers(map, threads);
  const auto allowed = std::ranges::find(layers, "allowed_headings", &maps::Layer::name);
  writeStyled(map, path, qgisStyle(allowed - layers.begin() + 1, kAllowedNames),
              [&](const maps::GeoTiff& file) { maps::writeGeoTiff(file, layers); });
}

void writeCategories(const costmap::TraversabilityMap& map, const std::string& path) {
  std::array<const char*, 4> names{};
  std::vector<maps::NamedClass> classes;
  for (std::size_t i = 0; i < names.size(); ++i) {
    names[i] = terramech::name(static_cast<Category>(i));
    const auto rgb = pixel(colourOf(static_cast<Category>(i)));
    const auto part = [rgb](int shift) { return static_cast<std::uint8_t>(rgb >> shift); };
    classes.push_back({.name = names[i], .colour = {part(16), part(8), part(0)}});
  }
  writeStyled(map, path, qgisStyle(1, names), [&](const maps::GeoTiff& file) {
    maps::writeGeoTiff(file, "category", map.costs().categories(), std::nullopt, classes);
  });
}

void writeNav2Map(const costmap::TraversabilityMap& map, const std::string& yaml) {
  const maps::Grid& grid = map.grid();
  const maps::Raster<std::uint8_t> categories = map.costs().categories();
  const bool allow_marginal = map.model().parts().policy.allow_marginal;
  std::string picture = fmt::format("P5\n{} {}\n255\n", grid.width, grid.height);
  for (int row = grid.height - 1; row >= 0; --row)
    for (int column = 0; column < grid.width; ++column)
      picture += greyOf(static_cast<Category>(categories[{column, row}]), allow_marginal);
  const auto picture_path = std::filesystem::path(yaml).replace_extension(".pgm");
  OutputFile beside(picture_path), file(yaml);
  beside.write(picture);
  file.write(
      fmt::format("image: {}\nresolution: {:.17g}\norigin: [{:.17g}, {:.17g}, 0.0]\nnegate: 0\n"
                  "occupied_thresh: 0.65\nfree_thresh: 0.1\nmode: trinary\n",
                  nlohmann::json(picture_path.filename().string()).dump(), grid.resolution_m,
                  grid.south_west.x_m, grid.south_west.y_m));
  beside.commit();
  file.commit();
}

namespace {

using terramech::FileKey;

// Returns the number of a class and its soil, instead of a soil name.
std::span<const FileKey> classKeys() {
  static constexpr FileKey kKeys[] = {
      {"terrain_classes", "mapping of class numbers, 0 to 254, to soils; classes is the same"},
      {"soils", "list of soils that the classes name"},
  };
  return kKeys;
}

std::span<const FileKey> vectorFileKeys() {
  static constexpr FileKey kKeys[] = {
      {"GPKG",
       "GeoPackage, .gpkg: read, and written in the map's CRS with layers route, vertices and segments, "
       "which QGIS colours by category"},
      {"ESRI Shapefile", ".shp with what lies beside it: read"},
      {"FlatGeobuf", ".fgb: read"},
      {"GPX", ".gpx: read, and written of maps of Earth"},
      {"KML", ".kml: read, and written of maps of Earth"},
      {"MapInfo File", ".tab, .mif: read"},
      {"GeoJSON", ".geojson: read, and written in longitude and latitude of the map's body"},
      {"CSV",
       ".csv: columns x_m, y_m (x and y, easting and northing) or lat, lon, read as a path; written with a "
       "row for each vertex"},
  };
  return kKeys;
}

std::span<const FileKey> costCurveKeys() {
  static constexpr FileKey kKeys[] = {
      {"gradient_along", "rise over run along the heading, climbing > 0, -1 to 1, required"},
      {"gradient_across",
       "rise over run across the heading, left and right equal, 0 to 2; default: no effect"},
      {"class", "number of a terrain class, with `--terrain`"},
      {"cost_per_m", "cost of a horizontal metre, above 0; empty or inf: refused, required"},
  };
  return kKeys;
}

}  // namespace

std::vector<FileFormat> fileFormats() {
  return {
      {"Mission", "YAML file of `talus plan MISSION.yaml`; paths are relative to it.", missionKeys()},
      {"Mission: maps", "Mapping under `maps`.", missionMapKeys()},
      {"Mission: thresholds", "Mapping under `thresholds`.", thresholdKeys()},
      {"Soil",
       "YAML file, the keys at its root, under `soil`, or in each item of a list `soils`; a number or {mean: "
       ", std: }.",
       terramech::soilKeys()},
      {"Terrain classes",
       "YAML file of `--soils`; a soil is a name of the library, a file, or the keys of one.", classKeys()},
      {"Rover", "YAML file, the keys at its root or under `rover`.", terramech::roverKeys()},
      {"Rover: wheels", "Mapping under `wheels`; all wheels are equal.", terramech::wheelKeys()},
      {"Vector file",
       "Places, paths, keep-out areas and routes, by the driver of GDAL; read in any CRS of the map's body; "
       "a path has at most a million positions.",
       vectorFileKeys()},
      {"Telemetry", "CSV with a header row, columns in any order; others are kept as they are.",
       terramech::telemetryKeys()},
      {"Cost curve",
       "CSV of `--cost-curve` in any unit of cost, interpolated between the gradients and refused beyond "
       "them; costs "
       "must not fall across the slope.",
       costCurveKeys()},
  };
}

std::string formatsText() {
  std::string text =
      "A key or column has its unit as suffix; YAML files may use another of the same kind (cohesion_kPa).\n";
  for (const FileFormat& format : fileFormats()) {
    text += fmt::format("\n{}\n  {}\n", format.title, format.about);
    std::size_t width = 0;
    for (const FileKey& key : format.keys) width = std::max(width, std::string_view(key.name).size());
    for (const FileKey& key : format.keys)
      text += fmt::format("  {:<{}}  {}\n", key.name, width, key.meaning);
  }
  return text;
}

}  // namespace talus::cli
