#pragma once

#include <cstdint>
#include <unordered_map>

#include <talus/maps/grid/grid.hpp>

namespace talus::planner {

/// Record of the ruts that the wheels of a rover made, on a grid of squares as wide as a wheel. A pressed
/// square counts as a rut only after the rover has driven a further distance of two squares or has reversed
/// its direction. Therefore a wheel does not drive in the rut that it is just making.
class Ruts {
 public:
  /// `wheel_width_m` > 0 is the side length of the squares.
  explicit Ruts(double wheel_width_m) : square_m_(wheel_width_m) {}

  /// Marks the square under a wheel at `place` (map coordinates).
  void press(const maps::Point& place);
  /// Adds a distance driven by the rover, >= 0.
  void moved(double distance_m) noexcept { odometer_m_ += distance_m; }
  /// Records that the rover reversed its direction: all squares pressed before count as ruts at once.
  void turnBack() noexcept { odometer_m_ += 3.0 * square_m_; }
  /// Returns the number of earlier wheel passes at `place`.
  int passes(const maps::Point& place) const;

 private:
  struct Mark {
    double pressed_at_m = 0.0;
    int passes = 1;
    int before = 0;  // passes before the present wheel
  };

  std::uint64_t square(const maps::Point& place) const noexcept;
  bool movedOn(const Mark& mark) const noexcept { return odometer_m_ - mark.pressed_at_m > 2.0 * square_m_; }

  double square_m_;
  double odometer_m_ = 0.0;
  std::unordered_map<std::uint64_t, Mark> marks_;
};

}  // namespace talus::planner
