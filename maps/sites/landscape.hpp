#pragma once

#include <memory>

#include <talus/maps/grid/grid.hpp>
#include <talus/maps/sites/site_options.hpp>

namespace talus::maps {

/// Elevation, soil class and rock abundance at a point of a generated site, before rocks are added.
struct Ground {
  double height_m = 0.0;
  SiteClass soil = SiteClass::Firm;
  double rock_share = 0.0;  ///< rock abundance: fraction of the area covered by rocks [-]
};

/// Interface of the terrain of a generated site without rocks. Each point is computed independently of other
/// points. Immutable.
class Landscape {
 public:
  Landscape() = default;
  Landscape(const Landscape&) = delete;
  Landscape& operator=(const Landscape&) = delete;
  virtual ~Landscape() = default;

  /// Returns the ground at a point in map coordinates [m].
  virtual Ground at(Point p) const = 0;
};

/// Returns the landscape of a site of the kind options.kind on this grid. @throws std::invalid_argument for
/// an unknown kind
std::unique_ptr<const Landscape> makeLandscape(const Grid& grid, const SiteOptions& options);

}  // namespace talus::maps
