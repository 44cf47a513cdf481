#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include <talus/costmap/ground/wheel_swath.hpp>

namespace talus::costmap {

namespace {

// For each column of a row: true if all cells within `reach` columns have the same class.
std::vector<bool> alikeAlong(const maps::Raster<std::uint8_t>& classes, int row, int reach) {
  const int width = classes.grid().width;
  std::vector<bool> alike(static_cast<std::size_t>(width), true);
  for (int column = 1; column < width; ++column) {
    if (classes[{column, row}] == classes[{column - 1, row}]) continue;
    const int first = std::max(column - reach, 0), last = std::min(column + reach, width);
    std::fill(alike.begin() + first, alike.begin() + last, false);
  }
  return alike;
}

}  // namespace

std::vector<bool> classBorders(const maps::Raster<std::uint8_t>& classes, int reach) {
  if (classes.empty()) return {};
  const maps::Grid& grid = classes.grid();
  std::vector<bool> border(grid.size(), true);
  // For each column: number of consecutive rows, up to this row, that are uniform along the row and of one
  // class.
  std::vector<int> rows(static_cast<std::size_t>(grid.width), 0);
  for (int row = 0; row < grid.height + reach; ++row) {
    const bool inside = row < grid.height;
    const std::vector<bool> alike = inside ? alikeAlong(classes, row, reach) : std::vector<bool>{};
    const int judged = row - reach;
    for (int column = 0; column < grid.width; ++column) {
      int& run = rows[static_cast<std::size_t>(column)];
      if (inside) {
        const bool follows = row == 0 || classes[{column, row}] == classes[{column, row - 1}];
        run = !alike[static_cast<std::size_t>(column)] ? 0 : follows ? run + 1 : 1;
      }
      const int last = std::min(row, grid.height - 1);
      if (judged >= 0 && run >= last - std::max(judged - reach, 0) + 1)
        border[grid.index({column, judged})] = false;
    }
  }
  return border;
}

namespace {

constexpr int kHeadings = 16;  // headings over 180 degrees: forward and backward stances are equal

// Returns the number of positions of the centre along a side of the cell: spaced at most a quarter of the
// track.
int placesAcross(double side_m, double track_m) {
  return static_cast<int>(std::clamp(std::ceil(4.0 * side_m / track_m), 1.0, 8.0)) + 1;
}

struct Offset {
  double x_m, y_m;
};

// Wheel centres in the body frame: wheel_count / 2 axles, equally spaced along the wheelbase.
std::vector<Offset> wheelCentres(const terramech::Rover& rover) {
  std::vector<Offset> centres;
  const int axles = std::max(1, rover.wheel_count / 2);
  for (int axle = 0; axle < axles; ++axle) {
    const double along = axles > 1 ? static_cast<double>(axle) / (axles - 1) - 0.5 : 0.0;
    for (const double side : {-0.5, 0.5})
      centres.push_back({along * rover.wheelbase_m, side * rover.track_m});
  }
  return centres;
}

}  // namespace

WheelSwath::WheelSwath(const terramech::Rover& rover, double resolution_m, double pose_error_m)
    : resolution_m_(resolution_m),
      wheels_(wheelCentres(rover).size()),
      across_(2 + static_cast<std::size_t>(std::ceil(rover.wheel.width_m / resolution_m))) {
  const double half_cell_m = 0.5 * resolution_m * (1.0 - 1e-9) + pose_error_m;
  const double farthest_m = 0.5 * (std::hypot(rover.wheelbase_m, rover.track_m) + rover.wheel.width_m);
  reach_ = static_cast<int>(std::floor((half_cell_m + farthest_m) / resolution_m + 0.5));
  const int across = placesAcross(2.0 * half_cell_m, rover.track_m);
  std::set<std::vector<Footprint>> standings;
  for (int k = 0; k < kHeadings; ++k)
    for (int i = 0; i < across; ++i)
      for (int j = 0; j < across; ++j)
        standings.insert(stand(
            rover,
            {half_cell_m * (2.0 * i / (across - 1) - 1.0), half_cell_m * (2.0 * j / (across - 1) - 1.0)},
            k * std::numbers::pi / kHeadings));
  std::map<Footprint, std::uint32_t> numbers;
  std::set<Place> touched;
  for (const std::vector<Footprint>& standing : standings)
    for (const Footprint& wheel : standing) {
      const auto [known, is_new] = numbers.try_emplace(wheel, static_cast<std::uint32_t>(numbers.size()));
      standings_.push_back(known->second);
      if (!is_new) continue;
      touched.insert(wheel.begin(), wheel.end());
      footprints_.insert(footprints_.end(), wheel.begin(), wheel.end());
      footprints_.resize(numbers.size() * across_, wheel.back());
    }
  touched_.assign(touched.begin(), touched.end());
}

std::vector<WheelSwath::Footprint> WheelSwath::stand(const terramech::Rover& rover, const maps::Point& p_map,
                                                     double heading_rad) const {
  const double c = std::cos(heading_rad), s = std::sin(heading_rad);
  const int side = 2 * reach_ + 1;
  std::vector<Footprint> wheels;
  for (const Offset& p_body : wheelCentres(rover)) {
    std::set<Place> touched;
    for (std::size_t k = 0; k < across_; ++k) {
      const double across = p_body.y_m + (static_cast<double>(k) / static_cast<double>(across_ - 1) - 0.5) *
                                             rover.wheel.width_m;
      const double x = p_map.x_m + c * p_body.x_m - s * across, y = p_map.y_m + s * p_body.x_m + c * across;
      const int column = static_cast<int>(std::floor(x / resolution_m_ + 0.5)) + reach_;
      const int row = static_cast<int>(std::floor(y / resolution_m_ + 0.5)) + reach_;
      touched.insert(
          static_cast<Place>(std::clamp(row, 0, side - 1) * side + std::clamp(column, 0, side - 1)));
    }
    wheels.emplace_back(touched.begin(), touched.end());
  }
  std::ranges::sort(wheels);
  return wheels;
}

WheelSwath::Judged WheelSwath::judged(const std::vector<Ground>& around) const {
  const Ground& own = around[around.size() / 2];
  Judged out{.belief = own.belief, .weakest_class = own.class_index};
  double weakest = own.belief.pull.value;
  std::vector<double> pull(around.size(), own.belief.pull.value);
  for (const Place place : touched_) {
    const Ground& there = around[place];
    out.unseen |= there.unseen;
    if (there.class_index < 0) continue;
    pull[place] = there.belief.pull.value;
    out.belief.pull.std = std::max(out.belief.pull.std, there.belief.pull.std);
    out.belief.sinkage.value = std::max(out.belief.sinkage.value, there.belief.sinkage.value);
    out.belief.sinkage.std = std::max(out.belief.sinkage.std, there.belief.sinkage.std);
    if (there.belief.pull.value >= weakest) continue;
    weakest = there.belief.pull.value;
    out.weakest_class = there.class_index;
  }
  std::vector<double> least(footprints_.size() / across_);
  for (std::size_t k = 0; k < least.size(); ++k) {
    least[k] = pull[footprints_[k * across_]];
    for (std::size_t i = 1; i < across_; ++i)
      least[k] = std::min(least[k], pull[footprints_[k * across_ + i]]);
  }
  const double share = 1.0 / static_cast<double>(wheels_);
  for (std::size_t k = 0; k < standings_.size(); k += wheels_) {
    double sum = 0.0;
    for (std::size_t wheel = 0; wheel < wheels_; ++wheel) sum += least[standings_[k + wheel]];
    out.belief.pull.value = std::min(out.belief.pull.value, sum * share);
  }
  return out;
}

}  // namespace talus::costmap
