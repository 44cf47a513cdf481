#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include <talus/cli/ground/file_formats.hpp>
#include <talus/cli/ground/mission.hpp>

namespace talus::cli {
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
