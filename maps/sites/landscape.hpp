#pragma once

#include <memory>

#include <talus/maps/grid/grid.hpp>
#include <talus/maps/sites/site_options.hpp>

namespace talus::maps {

/// Elevation, soil class and rock abundance at a point of a site, before rocks are added.
struct Ground {
  double height_m = 0.0;
  SiteClass soil = SiteClass::Firm;
  double rock_share = 0.0;  ///< fraction of the area covered by rocks [-]
};

/// Interface of a site generator; each point is computed independently of its neighbours. Immutable.
class Landscape {
 public:
  Landscape() = default;
  Landscape(const Landscape&) = delete;
  Landscape& operator=(const Landscape&) = delete;
  virtual ~Landscape() = default;

  virtual Ground at(Point p) const = 0;
};

/// The landscape of a site on this grid. @throws std::invalid_argument for an unknown kind
std::unique_ptr<const Landscape> makeLandscape(const Grid& grid, const SiteOptions& options);

}  // namespace talus::maps
