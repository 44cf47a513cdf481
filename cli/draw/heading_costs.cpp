#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include <nlohmann/json.hpp>

#include <talus/cli/draw/heading_costs.hpp>
#include <talus/cli/draw/page_layers.hpp>

namespace talus::cli {
namespace {

using costmap::CellCode;
using costmap::TravelCurve;

constexpr std::uint32_t kNoCurve = 65535;
constexpr int kImageWidth = 4096;         // browsers limit the height of an image
constexpr double kMostWord = 16777214.0;  // largest 24-bit value, less one for "refused"

/// Range of the cost-curve nodes within the limits of pitch and roll: index of the bin of the steepest
/// descent, number of bins in a row, and number of rows from the level row.
struct Nodes {
  int first_bin, bins, rows;

  explicit Nodes(const costmap::TravelCost::Limits& limits) {
    const auto bin = [](double along) {
      return static_cast<int>(std::floor(along * TravelCurve::kBinsPerUnit)) + TravelCurve::kBins / 2;
    };
    first_bin = std::max(0, bin(-limits.max_along));
    bins = std::min(TravelCurve::kBins - 1, bin(limits.max_along) + 1) - first_bin + 1;
    rows = static_cast<int>(limits.max_across * TravelCurve::kRowsPerUnit) + 2;
  }
};

/// Image of the costs [J/m] of all curves, as 24-bit words on a logarithmic scale. Word 0 is a refused
/// heading; word w > 0 is the cost low exp(span (w - 1)), with a relative error of a few millionths.
nlohmann::ordered_json tableOf(const std::vector<const TravelCurve*>& curves, const Nodes& nodes) {
  std::vector<double> costs;
  double low = INFINITY, high = 0.0;
  for (const TravelCurve* curve : curves)
    for (int row = 0; row < nodes.rows; ++row)
      for (int bin = 0; bin < nodes.bins; ++bin) {
        const float* its = curve->rows() + std::min(row, curve->lastRow()) * TravelCurve::kBins;
        const double cost = std::max(1e-6, static_cast<double>(its[nodes.first_bin + bin]));
        costs.push_back(cost);
        if (!std::isfinite(cost)) continue;
        low = std::min(low, cost);
        high = std::max(high, cost);
      }
  const double span = low < high ? std::log(high / low) : 1.0;
  Image image(kImageWidth, static_cast<int>(costs.size()) / kImageWidth + 1);
  std::ranges::fill(image.argb, 0xFF000000U);
  for (std::size_t i = 0; i < costs.size(); ++i)
    if (std::isfinite(costs[i]))
      image.argb[i] |=
          1U + static_cast<std::uint32_t>(std::round(std::log(costs[i] / low) / span * kMostWord));
  return {{"image", dataUri(image)},  {"width", image.width},
          {"height", image.height},   {"curves", curves.size()},
          {"first", nodes.first_bin}, {"bins", nodes.bins},
          {"rows", nodes.rows},       {"low", std::isfinite(low) ? low : 1.0},
          {"span", span / kMostWord}};
}

}  // namespace

nlohmann::ordered_json headingCostsOf(const Scene& scene) {
  if (!scene.costs) return nullptr;
  const costmap::TravelCost& cost = *scene.costs->cost;
  std::map<std::uint32_t, std::uint32_t> numbers;
  std::vector<const TravelCurve*> curves;
  const auto numberOf = [&](CellCode code) {
    if (code.curve() >= cost.curves().size()) return kNoCurve;
    const auto [known, added] = numbers.try_emplace(code.curve(), static_cast<std::uint32_t>(curves.size()));
    if (added) curves.push_back(&cost.curves()[code.curve()]);
    return known->second;
  };
  const auto gradient = [&](maps::Cell cell) {
    const CellCode code = scene.costs->codes[cell];
    return static_cast<std::uint32_t>((code.stepsX() & 4095) << 12 | (code.stepsY() & 4095));
  };
  const auto kind = [&](maps::Cell cell) {
    return numberOf(scene.costs->codes[cell]) | static_cast<std::uint32_t>(scene.costs->categories[cell])
                                                    << 16U;
  };
  nlohmann::ordered_json json{{"gradients", wordsUri(scene.grid(), gradient)},
                              {"kinds", wordsUri(scene.grid(), kind)}};
  json["table"] = tableOf(curves, Nodes(cost.limits()));
  json["most"] = {{"along", cost.limits().max_along}, {"across", cost.limits().max_across}};
  return json;
}

}  // namespace talus::cli
