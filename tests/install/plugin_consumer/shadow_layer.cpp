// A layer of somebody else: shadow west of x = 10 costs 20 J/m, nobody may go beyond x = 38; and, by the word in SHADOW,
// every way in which a layer can go wrong.
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <talus/planner/plugin/plugin_export.hpp>

namespace shadow {

class Layer final : public talus::CostSource {
 public:
  std::vector<float> over(const talus::maps::Grid& grid) const override {
    const char* word = std::getenv("SHADOW");
    const std::string how = word == nullptr ? "" : word;
    if (how == "prints") {
      std::puts("from the layer");
      std::fputs("and more\n", stderr);
      std::fflush(nullptr);
      throw std::runtime_error("after that");
    }
    if (how == "throws") throw std::runtime_error("no sun\ntoday");
    if (how == "crashes") std::abort();
    if (how == "huge") return std::vector<float>(std::size_t{1} << 40U);
    std::vector<float> cells;
    for (int row = 0; row < grid.height; ++row)
      for (int column = 0; column < grid.width; ++column) {
        const double x_m = grid.centre({column, row}).x_m;
        cells.push_back(x_m > 38.0 ? std::numeric_limits<float>::infinity() : x_m < 10.0 ? 20.0F : 0.0F);
      }
    if (how == "short") cells.pop_back();
    if (how == "negative") cells.back() = -1.0F;
    if (how == "beyond") cells.back() = 1e30F;
    if (how == "unknown") cells.assign(cells.size(), std::numeric_limits<float>::quiet_NaN());
    return cells;
  }
};

}  // namespace shadow

TALUS_EXPORT_LAYER(shadow::Layer)
