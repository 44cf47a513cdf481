#include <algorithm>
#include <array>
#include <map>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <yaml-cpp/yaml.h>

#include <talus/cli/app/texts.hpp>
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

std::vector<FileFormat> fileFormats() {
  const std::map<std::string, std::span<const terramech::FileKey>> library{
      {"Soil", terramech::soilKeys()},
      {"Rover", terramech::roverKeys()},
      {"Rover: wheels", terramech::wheelKeys()},
      {"Telemetry", terramech::telemetryKeys()}};
  std::vector<FileFormat> formats;
  for (const YAML::Node& format : texts()["formats"]) {
    const auto title = format["title"].as<std::string>();
    const auto found = library.find(title);
    formats.push_back(
        {title, format["about"].as<std::string>(), found == library.end() ? keysOf(title) : found->second});
  }
  return formats;
}

std::string formatsText() {
  std::string text =
      "A key or column has its unit as suffix; YAML files may use another of the same kind (cohesion_kPa).\n";
  for (const FileFormat& format : fileFormats()) {
    text += fmt::format("\n{}\n  {}\n", format.title, format.about);
    std::size_t width = 0;
    for (const terramech::FileKey& key : format.keys)
      width = std::max(width, std::string_view(key.name).size());
    for (const terramech::FileKey& key : format.keys)
      text += fmt::format("  {:<{}}  {}\n", key.name, width, key.meaning);
  }
  return text;
}

}  // namespace talus::cli
