#include <array>
#include <cmath>
#include <fstream>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <talus/cli/draw/canvas.hpp>
#include <talus/cli/ground/category_files.hpp>
#include <talus/common/output_file.hpp>
#include <talus/maps/maps_io.hpp>

namespace talus::cli {
namespace {

using terramech::Category;

constexpr std::array kCategories{Category::Safe, Category::Marginal, Category::Dangerous, Category::Unknown};

std::uint8_t byteOf(double part) {
  return static_cast<std::uint8_t>(std::lround(255.0 * part));
}

// Grey value for map_server's trinary mode: free above 0.9, occupied below 0.35.
char greyOf(Category category, bool allow_marginal) {
  constexpr char kFree = '\xFE', kOccupied = '\x00', kUnknown = '\x80';
  if (category == Category::Safe || (category == Category::Marginal && allow_marginal)) return kFree;
  return category == Category::Unknown ? kUnknown : kOccupied;
}

// QGIS style with four category names; QGIS reads the file beside the GeoTIFF and would otherwise list all
// 256 palette entries.
std::string qgisStyle() {
  std::string entries;
  for (const Category category : kCategories)
    entries += fmt::format("<paletteEntry value=\"{}\" color=\"#{:06x}\" alpha=\"255\" label=\"{}\"/>\n",
                           static_cast<int>(category), pixel(colourOf(category)) & 0xFFFFFFU,
                           terramech::name(category));
  return "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>\n<qgis version=\"3.22\">\n<pipe>\n"
         "<rasterrenderer type=\"paletted\" band=\"1\" opacity=\"1\" alphaBand=\"-1\">\n<colorPalette>\n" +
         entries + "</colorPalette>\n</rasterrenderer>\n</pipe>\n</qgis>\n";
}

}  // namespace

std::filesystem::path categoryStyle(const std::filesystem::path& tif) {
  return std::filesystem::path(tif).replace_extension(".qml");
}

void writeCategories(const costmap::TraversabilityMap& map, const std::string& path) {
  std::vector<maps::NamedClass> classes;
  for (const Category category : kCategories) {
    const Colour colour = colourOf(category);
    classes.push_back({.name = terramech::name(category),
                       .colour = {byteOf(colour.red), byteOf(colour.green), byteOf(colour.blue)}});
  }
  const auto& georeference = map.elevation().georeference;
  OutputFile raster(path), style(categoryStyle(path));
  maps::writeGeoTiff({.path = path, .georeference = georeference ? &*georeference : nullptr, .into = &raster},
                     "category", map.costs().categories(), std::nullopt, classes);
  style.write(qgisStyle());
  raster.commit();
  style.commit();
}

std::filesystem::path nav2Picture(const std::filesystem::path& yaml) {
  return std::filesystem::path(yaml).replace_extension(".pgm");
}

void writeNav2Map(const costmap::TraversabilityMap& map, const std::string& yaml) {
  const maps::Grid& grid = map.grid();
  const maps::Raster<std::uint8_t> categories = map.costs().categories();
  const bool allow_marginal = map.model().parts().policy.allow_marginal;
  std::string picture = fmt::format("P5\n{} {}\n255\n", grid.width, grid.height);
  for (int row = grid.height - 1; row >= 0; --row)
    for (int column = 0; column < grid.width; ++column)
      picture += greyOf(static_cast<Category>(categories[{column, row}]), allow_marginal);
  OutputFile beside(nav2Picture(yaml)), file(yaml);
  beside.write(picture);
  file.write(
      fmt::format("image: {}\nresolution: {:.17g}\norigin: [{:.17g}, {:.17g}, 0.0]\nnegate: 0\n"
                  "occupied_thresh: 0.65\nfree_thresh: 0.1\nmode: trinary\n",
                  nlohmann::json(nav2Picture(yaml).filename().string()).dump(), grid.resolution_m,
                  grid.south_west.x_m, grid.south_west.y_m));
  beside.commit();
  file.commit();
}

}  // namespace talus::cli
