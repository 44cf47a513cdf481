#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include <talus/common/common.hpp>
#include <talus/planner/plugin/layer_plugin.hpp>
#include <talus/planner/plugin/plugin_export.hpp>
#include <talus/planner/plugin/plugin_planner.hpp>

namespace talus::planner {
namespace {

constexpr char kCells = 'c';

std::string asked(const std::string& file, const maps::Grid& grid) {
  const boost::dll::shared_library library = openedLibrary(file);
  if (!library.has("talus_layer") || !library.has("talus_layer_interface"))
    throw InputError({file, "exports no talus_layer", "export one with TALUS_EXPORT_LAYER"});
  const int built_for = library.get_alias<const int>("talus_layer_interface");
  if (built_for != kLayerInterfaceVersion)
    throw InputError({file,
                      "built for layer interface " + std::to_string(built_for) + ", this program has " +
                          std::to_string(kLayerInterfaceVersion),
                      "rebuild the plugin against the installed talus"});
  const std::vector<float> cells = library.get_alias<CostSource>("talus_layer").over(grid);
  if (cells.size() != grid.size())
    throw InputError(
        {file,
         "answered for " + std::to_string(cells.size()) + " cells, must be " + std::to_string(grid.size()),
         "report this to its author, or remove the plugin"});
  std::string bytes(1 + cells.size() * sizeof(float), kCells);
  std::memcpy(bytes.data() + 1, cells.data(), cells.size() * sizeof(float));
  return bytes;
}

}  // namespace

costmap::CostLayer layerFrom(const std::string& file, const std::string& name, const maps::Grid& grid) {
  const std::size_t size = grid.size() * sizeof(float);
  const std::string bytes = answerOf(
      file, [&] { return asked(file, grid); },
      {.seconds = 60.0, .bytes = size + 10 * kLongestPluginText, .memory = std::uint64_t{4} << 30}, {});
  if (bytes.size() != 1 + size || bytes[0] != kCells) failPlugin(file, "gave no whole layer");
  costmap::CostLayer layer{.name = name, .added_J_per_m = maps::Raster<float>(grid)};
  std::memcpy(layer.added_J_per_m.values().data(), bytes.data() + 1, size);
  for (const float v : layer.added_J_per_m.values()) {
    if (std::isnan(v) || v == INFINITY) continue;
    if (!(v >= 0.0F && v <= costmap::CostLayer::kMost_J_per_m))
      failPlugin(file, "answered with " + std::to_string(v) + " J/m, must be 0 to 1e6, infinite or NaN");
    layer.unseen_J_per_m = std::max(layer.unseen_J_per_m, v);
  }
  return layer;
}

}  // namespace talus::planner
