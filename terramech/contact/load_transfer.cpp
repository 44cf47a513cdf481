#include <algorithm>
#include <cmath>

#include <talus/terramech/contact/load_transfer.hpp>

namespace talus::terramech {

std::vector<double> wheelLoads_N(const Rover& rover, double gradient, const std::vector<double>& along_m) {
  const double normal_N = rover.mass_kg * rover.gravity_m_s2 / std::hypot(1.0, gradient);
  const double even = 1.0 / static_cast<double>(std::max<std::size_t>(along_m.size(), 1));
  double squares = 0.0;
  for (const double a : along_m) squares += a * a;
  std::vector<double> loads_N;
  for (const double a : along_m) {
    const double moved = squares > 0.0 ? gradient * rover.centre_of_mass_height_m * a / squares : 0.0;
    loads_N.push_back(normal_N * std::max(even - moved, 0.1 * even));
  }
  return loads_N;
}

}  // namespace talus::terramech
