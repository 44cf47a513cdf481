#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace talus::costmap {

/// A floor of a cell beneath the top surface, for example ground beneath an overhang.
struct Floor {
  std::uint32_t cell = 0;  ///< index of the cell in the map's grid
  float height_m = 0.0F;
  friend bool operator==(const Floor&, const Floor&) = default;
};

/// The floors beneath a map's top surface, from a point cloud; empty for a map from a raster.
class Floors {
 public:
  /// Least free height above a floor (ours). A gap of less height is treated as a hole in the scan.
  static constexpr double kHeadroom_m = 0.5;

  Floors() = default;
  /// Accepts floors in any order. Throws std::invalid_argument for a cell index >= `cells` or a non-finite
  /// height.
  Floors(std::vector<Floor> floors, std::size_t cells);

  bool empty() const noexcept { return floors_.empty(); }
  const std::vector<Floor>& all() const noexcept { return floors_; }

  /// The floors of a cell, lowest first.
  std::span<const Floor> of(std::size_t cell) const noexcept;

  /// Floor of a cell nearest to the height of a wheel; nullopt if the top surface is nearer or the height is
  /// unknown.
  std::optional<Floor> under(std::size_t cell, double height_m, double top_m) const noexcept;

 private:
  std::vector<Floor> floors_;  // sorted by cell, then height
};

}  // namespace talus::costmap
