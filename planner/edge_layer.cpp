#include <algorithm>
#include <array>
#include <atomic>
#include <thread>
#include <utility>

#include <planner/edge_layer.hpp>

namespace talus::planner {
namespace {

using Halves = EdgeUnits::Halves;

constexpr Halves allBlocked() noexcept {
  Halves halves{};
  halves.fill(EdgeUnits::kBlocked);
  return halves;
}

// Halves of the cells of one row from column first - 1 to last + 1; blocked outside the map.
void fillRow(const costmap::CostGrid& map, const EdgeUnits& units, int row, CellBox box,
             std::vector<Halves>& halves) {
  for (int column = box.first.column - 1; column <= box.last.column + 1; ++column) {
    const maps::Cell cell{column, row};
    halves[static_cast<std::size_t>(column - box.first.column + 1)] =
        map.grid().contains(cell) ? units.halves(map.at(cell)) : allBlocked();
  }
}

std::uint16_t sum(std::uint16_t a, std::uint16_t b) noexcept {
  return a == EdgeUnits::kBlocked || b == EdgeUnits::kBlocked ? EdgeUnits::kBlocked
                                                              : static_cast<std::uint16_t>(a + b);
}

// The eight steps into the middle cell of three rows of halves.
void stepsInto(const std::array<const Halves*, 3>& rows, std::uint16_t* into) noexcept {
  const auto at = [&](maps::Cell step) -> const Halves& {
    return rows[static_cast<std::size_t>(step.row + 1)][step.column];
  };
  for (std::size_t k = 0; k < 8; ++k) {
    const auto heading = static_cast<std::size_t>(opposite(static_cast<int>(k)));
    const maps::Cell step = kStep[k];
    into[k] = sum(at({0, 0})[heading], at(step)[heading]);
    const bool beside_blocked = at({step.column, 0})[heading] == EdgeUnits::kBlocked ||
                                at({0, step.row})[heading] == EdgeUnits::kBlocked;
    if (beside_blocked) into[k] = EdgeUnits::kBlocked;
  }
}

}  // namespace

EdgeLayer::EdgeLayer(std::shared_ptr<const costmap::CostGrid> map, const EdgeUnits& units, int threads,
                     const StopCheck& stop)
    : map_(std::move(map)),
      units_(units),
      padded_{map_->grid().width, map_->grid().height},
      edges_(8 * padded_.size(), kBlocked) {
  constexpr int kBlock = 64;
  std::atomic<int> next{0};
  const auto work = [&] {
    for (int row = kBlock * next++; row < padded_.height && !stop(); row = kBlock * next++)
      buildRows({{0, row}, {padded_.width - 1, std::min(row + kBlock, padded_.height) - 1}});
  };
  {
    std::vector<std::jthread> helpers;
    for (int k = 1; k < threads; ++k) helpers.emplace_back(work);
    work();
  }
  complete_ = !stop();
}

void EdgeLayer::buildRows(CellBox box) {
  const auto width = static_cast<std::size_t>(box.last.column - box.first.column + 3);
  std::array<std::vector<Halves>, 3> rows{std::vector<Halves>(width), std::vector<Halves>(width),
                                          std::vector<Halves>(width)};
  fillRow(*map_, units_, box.first.row - 1, box, rows[0]);
  fillRow(*map_, units_, box.first.row, box, rows[1]);
  for (int row = box.first.row; row <= box.last.row; ++row) {
    fillRow(*map_, units_, row + 1, box, rows[2]);
    for (int column = box.first.column; column <= box.last.column; ++column) {
      const auto k = static_cast<std::size_t>(column - box.first.column + 1);
      stepsInto({&rows[0][k], &rows[1][k], &rows[2][k]}, edges_.data() + 8 * padded_.index({column, row}));
    }
    std::rotate(rows.begin(), rows.begin() + 1, rows.end());
  }
}

void EdgeLayer::update(std::shared_ptr<const costmap::CostGrid> newer, CellBox changed) {
  map_ = std::move(newer);
  buildRows({{std::max(changed.first.column - 1, 0), std::max(changed.first.row - 1, 0)},
             {std::min(changed.last.column + 1, padded_.width - 1),
              std::min(changed.last.row + 1, padded_.height - 1)}});
}

}  // namespace talus::planner
