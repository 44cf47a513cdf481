#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace talus::costmap {

/// A floor: ground of a cell beneath the top surface, e.g. beneath an overhang.
struct Floor {
  std::uint32_t cell = 0;  ///< index of the cell in the map's grid
  /// Elevation of the floor.
  float height_m = 0.0F;
  friend bool operator==(const Floor&, const Floor&) = default;
};

/// The floors of a map, read from a point cloud; empty for a map from a raster.
class Floors {
 public:
  /// Least free height above a floor (ours); a lower gap is treated as a hole in the scan.
  static constexpr double kHeadroom_m = 0.5;

  Floors() = default;
  /// Makes the set from floors in any order; `cells` is the number of cells of the map. Throws
  /// std::invalid_argument for a cell index >= `cells` or a non-finite elevation.
  Floors(std::vector<Floor> floors, std::size_t cells);

  bool empty() const noexcept { return floors_.empty(); }
  const std::vector<Floor>& all() const noexcept { return floors_; }

  /// Returns the floors of a cell, lowest first.
  std::span<const Floor> of(std::size_t cell) const noexcept;

  /// Returns the floor of a cell that is nearest to the elevation `height_m` [m] of a wheel; nullopt if the
  /// top surface at `top_m` [m] is nearer or `height_m` is NaN.
  std::optional<Floor> under(std::size_t cell, double height_m, double top_m) const noexcept;

 private:
  std::vector<Floor> floors_;  // sorted by cell, then height
};

}  // namespace talus::costmap
