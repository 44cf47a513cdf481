#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <talus/common/parallel_for.hpp>
#include <talus/planner/field/pooled_grid.hpp>
#include <talus/planner/route/heading_set.hpp>

namespace talus::planner {
namespace {

using costmap::CellCode;

constexpr std::size_t kMostCopies = 254;
constexpr double kSurchargeStep = 1.25;  // factor between levels
constexpr double kLeastShare = 1.0 / 3;  // smallest share of traversable cells
constexpr std::size_t kHeadings = 8;

// Copies of all curves at several surcharge levels, each costlier than the previous by the same factor.
class Levels {
 public:
  explicit Levels(const costmap::TravelCost& cost)
      : curves_(cost.curves().size()),
        levels_(std::clamp<std::size_t>(kMostCopies / std::max<std::size_t>(curves_, 1), 1, 8)) {}

  std::shared_ptr<const costmap::TravelCost> cost(const costmap::TravelCost& base) const {
    std::vector<costmap::TravelCurve> all;
    for (std::size_t level = 0; level < levels_; ++level)
      for (costmap::TravelCurve curve : base.curves()) {
        const auto factor = static_cast<float>(std::pow(kSurchargeStep, static_cast<double>(level)));
        for (float& value : curve.cost_J_per_m) value *= factor;
        if (curve.crossing && level > 0) {
          auto raised = std::make_shared<std::vector<float>>(*curve.crossing);
          for (float& value : *raised) value *= factor;
          curve.crossing = std::move(raised);
        }
        all.push_back(curve);
      }
    return std::make_shared<costmap::TravelCost>(base.limits(), std::move(all));
  }

  CellCode::Curve number(std::size_t curve, double surcharge) const {
    const double level = std::round(std::log(std::max(surcharge, 1.0)) / std::log(kSurchargeStep));
    return static_cast<CellCode::Curve>(
        curve + curves_ * static_cast<std::size_t>(std::min(level, static_cast<double>(levels_ - 1))));
  }

 private:
  std::size_t curves_, levels_;
};

class Pooling {
 public:
  Pooling(const costmap::CostGrid& map, int factor) : map_(map), factor_(factor), levels_(map.cost()) {
    for (std::size_t k = 0; k < kHeadings; ++k) {
      const double angle = 0.78539816339744831 * static_cast<double>(k);  // pi / 4
      headings_.emplace_back(map.cost(), costmap::Direction{std::cos(angle), std::sin(angle)});
    }
  }

  const Levels& levels() const noexcept { return levels_; }
  CellCode code(maps::Cell coarse) const;

 private:
  double mean(CellCode cell) const noexcept;  // mean over allowed headings; infinite if none is allowed

  const costmap::CostGrid& map_;
  int factor_;
  Levels levels_;
  std::vector<HeadingCost> headings_;
};

double Pooling::mean(CellCode cell) const noexcept {
  double sum = 0.0;
  int count = 0;
  for (const HeadingCost& heading : headings_)
    if (const float value = heading(cell); std::isfinite(value)) sum += static_cast<double>(value), ++count;
  return count > 0 ? sum / count : std::numeric_limits<double>::infinity();
}

CellCode Pooling::code(maps::Cell coarse) const {
  const maps::Grid& grid = map_.grid();
  double dz_dx = 0.0, dz_dy = 0.0, cost = 0.0;
  std::vector<int> curves(map_.cost().curves().size());
  int cells = 0, entered = 0;
  const int last_row = std::min((coarse.row + 1) * factor_, grid.height),
            last_column = std::min((coarse.column + 1) * factor_, grid.width);
  // Samples every second row, and in each sampled row every second cell, alternately even and odd ones.
  for (int row = coarse.row * factor_; row < last_row; row += 2)
    for (int column = coarse.column * factor_ + (row >> 1 & 1); column < last_column; column += 2) {
      const CellCode cell = map_.at({column, row});
      ++cells;
      const double here = mean(cell);
      if (!std::isfinite(here)) continue;
      ++entered;
      ++curves[cell.curve()];
      dz_dx += cell.dzDx();
      dz_dy += cell.dzDy();
      cost += here;
    }
  CellCode::Parts parts{.curve = CellCode::kBlocked};
  if (entered == 0 || entered < kLeastShare * cells) return CellCode(parts);
  const auto most = static_cast<std::size_t>(std::max_element(curves.begin(), curves.end()) - curves.begin());
  parts = {dz_dx / entered, dz_dy / entered, static_cast<CellCode::Curve>(most)};
  const double plain = mean(CellCode(parts)), share = static_cast<double>(entered) / cells;
  parts.curve = levels_.number(most, cost / entered / plain / share);
  return CellCode(parts);
}

}  // namespace

std::shared_ptr<const costmap::CostGrid> pooled(const costmap::CostGrid& map, int factor, int threads,
                                                const StopCheck& stop) {
  const maps::Grid& fine = map.grid();
  const maps::Grid coarse{(fine.width + factor - 1) / factor, (fine.height + factor - 1) / factor,
                          fine.resolution_m * factor, fine.south_west};
  const Pooling pooling(map, factor);
  maps::Raster<CellCode> cells(coarse);
  parallelFor(static_cast<std::size_t>(coarse.height), threads, [&](std::size_t k) {
    const int row = static_cast<int>(k);
    for (int column = 0; column < coarse.width && !stop(); ++column)
      cells[{column, row}] = pooling.code({column, row});
  });
  if (stop()) return nullptr;
  return std::make_shared<costmap::CostGrid>(costmap::flattened(cells, pooling.levels().cost(map.cost())));
}

std::shared_ptr<const costmap::CostGrid> repooled(const costmap::CostGrid& older,
                                                  const costmap::CostGrid& map, int factor, CellBox changed) {
  const Pooling pooling(map, factor);
  const auto coarse = [factor](maps::Cell cell) {
    return maps::Cell{cell.column / factor, cell.row / factor};
  };
  const costmap::Revision revision{.ranges = {{coarse(changed.first), coarse(changed.last)}},
                                   .code = [&](maps::Cell cell, CellCode) { return pooling.code(cell); },
                                   .cost = [&] { return older.content().cost; }};
  return std::make_shared<costmap::CostGrid>(costmap::revised(older, revision));
}

}  // namespace talus::planner
