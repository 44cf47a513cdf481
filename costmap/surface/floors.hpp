#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace talus::costmap {

/// Ground beneath an overhang: a floor of a cell under its top surface.
struct Floor {
  std::uint32_t cell = 0;  ///< index in the map's grid
  float height_m = 0.0F;
  friend bool operator==(const Floor&, const Floor&) = default;
};

/// The floors beneath a map's top surface, as a point cloud shows them; none where the source is a raster.
class Floors {
 public:
  /// Least free height above a floor, from rover to what hangs over it (ours): lower gaps are holes in a
  /// scan.
  static constexpr double kHeadroom_m = 0.5;

  Floors() = default;
  /// Takes floors in any order. Throws std::invalid_argument for one outside `cells` or at no height.
  Floors(std::vector<Floor> floors, std::size_t cells);

  bool empty() const noexcept { return floors_.empty(); }
  const std::vector<Floor>& all() const noexcept { return floors_; }

  /// Those of a cell, lowest first.
  std::span<const Floor> of(std::size_t cell) const noexcept;

  /// The floor of a cell that a wheel at this height stands on; nothing where the top surface is nearer, or
  /// the height is not known.
  std::optional<Floor> under(std::size_t cell, double height_m, double top_m) const noexcept;

 private:
  std::vector<Floor> floors_;  // by cell, then height
};

}  // namespace talus::costmap
