#pragma once

#include <memory>

#include <talus/maps/grid/grid.hpp>
#include <talus/maps/sites/site_options.hpp>

namespace talus::maps {

/// Elevation and class of one place of a site, before rocks are added.
struct Ground {
  double height_m = 0.0;
  SiteClass soil = SiteClass::Firm;
  double rock_share = 0.0;  ///< [-]
};

/// One kind of site, known at any place without its neighbours. Immutable.
class Landscape {
 public:
  Landscape() = default;
  Landscape(const Landscape&) = delete;
  Landscape& operator=(const Landscape&) = delete;
  virtual ~Landscape() = default;

  virtual Ground at(Point p) const = 0;
};

/// The landscape of a site of this grid. @throws std::invalid_argument on an unknown kind
std::unique_ptr<const Landscape> makeLandscape(const Grid& grid, const SiteOptions& options);

}  // namespace talus::maps
