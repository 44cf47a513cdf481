#include <cmath>

#include <talus/costmap/cost/cross_slope.hpp>
#include <talus/costmap/ground/category_table.hpp>

namespace talus::costmap {
namespace {

constexpr int kSteps = 2897;  // of the steepest gradient that CellCode holds, 2048 sqrt(2)

}  // namespace

CategoryTable::CategoryTable(const GroundModel& model, const GroundBelief& belief,
                             const CrossSlope& crossing) {
  entries_.reserve(kSteps);
  for (int step = 0; step < kSteps; ++step) {
    const Ranked ranked = model.category(belief, crossing.steepest(step * CellCode::kStep));
    // Of danger the nearest step, of all else the one below: no more is promised than is believed.
    const double steps = 16.0 * ranked.probability;
    const double told =
        ranked.category == terramech::Category::Dangerous ? std::round(steps) : std::floor(steps);
    entries_.push_back({static_cast<std::uint8_t>(ranked.category), static_cast<std::uint8_t>(told)});
  }
}

CategoryTable::Entry CategoryTable::at(CellCode cell) const noexcept {
  if (entries_.empty()) return {static_cast<std::uint8_t>(terramech::Category::Dangerous), 16};
  const auto x = static_cast<float>(cell.stepsX()), y = static_cast<float>(cell.stepsY());
  return entries_[static_cast<std::size_t>(std::sqrt(x * x + y * y) + 0.5F)];
}

}  // namespace talus::costmap
