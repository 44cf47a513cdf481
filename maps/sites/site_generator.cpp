#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include <talus/common/constants.hpp>
#include <talus/common/parallel_rows.hpp>
#include <talus/maps/sites/landscape.hpp>
#include <talus/maps/sites/site_generator.hpp>

namespace talus::maps {
namespace {

// Transverse Mercator on the body, true at the centre of the site; x and y are zero at the south-west corner.
Georeference georeference(const SiteOptions& options) {
  const bool moon = options.kind == SiteKind::Craters;
  return Georeference({.name = moon ? "generated site, Moon" : "generated site, Mars",
                       .ellipsoid = moon ? kMoon : kMars,
                       .projection = {.method = ProjectionMethod::TransverseMercator,
                                      .latitude_of_origin_rad = (moon ? -9.0 : -4.6) * kDegree,
                                      .central_meridian_rad = (moon ? 15.5 : 137.4) * kDegree,
                                      .false_easting_m = 0.5 * options.width * options.resolution_m,
                                      .false_northing_m = 0.5 * options.height * options.resolution_m}});
}

void require(bool holds, const char* field, double value, const char* bound) {
  if (!holds)
    throw std::invalid_argument(std::string("site: ") + field + " = " + std::to_string(value) + ", must be " +
                                bound);
}

void check(const SiteOptions& o) {
  require(o.width >= 8 && o.width <= 20000, "width", o.width, "8 to 20000 cells");
  require(o.height >= 8 && o.height <= 20000, "height", o.height, "8 to 20000 cells");
  require(o.resolution_m >= 0.01 && o.resolution_m <= 1000, "resolution_m", o.resolution_m, "0.01 to 1000");
  require(o.threads >= 1, "threads", o.threads, ">= 1");
}

void raise(Site& site, const Rock& rock) {
  const Grid& grid = site.map.grid();
  const auto cell = [&](double offset_m, int count) {
    return std::clamp(static_cast<int>(std::floor(offset_m / grid.resolution_m)), 0, count - 1);
  };
  const double x = rock.centre.x_m - grid.south_west.x_m;
  const double y = rock.centre.y_m - grid.south_west.y_m;
  const double r = rock.radius_m;
  for (int row = cell(y - r, grid.height); row <= cell(y + r, grid.height); ++row)
    for (int column = cell(x - r, grid.width); column <= cell(x + r, grid.width); ++column) {
      const Point p = grid.centre({column, row});
      const double height = rock.height_m(std::hypot(p.x_m - rock.centre.x_m, p.y_m - rock.centre.y_m));
      if (height <= 0) continue;
      site.map.elevation_m[{column, row}] += static_cast<float>(height);
      site.classes[{column, row}] = static_cast<std::uint8_t>(SiteClass::Rock);
    }
}

// Adds the rocks that are large enough for the cell size.
void setRocks(Site& site, const SiteOptions& options) {
  constexpr double kGreatest_m = 4.0;
  const double least_m = std::max(0.3, 1.5 * options.resolution_m);
  if (least_m >= kGreatest_m) return;
  const Grid& grid = site.map.grid();
  const auto abundance = [&](Point p) {
    const auto cell = grid.cellAt(p);
    return cell ? static_cast<double>(site.rock_abundance[*cell]) : 0.0;
  };
  for (const Rock& rock : rockField(grid, abundance,
                                    {.seed = mixed(options.seed + 9),
                                    .least_diameter_m = least_m,
                                    .greatest_diameter_m = kGreatest_m}))
    raise(site, rock);
}

}  // namespace

Site generateSite(const SiteOptions& options, const ProgressMonitor& watch) {
  check(options);
  const Grid grid{.width = options.width, .height = options.height, .resolution_m = options.resolution_m};
  Site site{.map = {.elevation_m = Raster<float>(grid),
                    .georeference = georeference(options),
                    .source = "generated site, seed " + std::to_string(options.seed),
                    .notes = {}},
            .classes = Raster<std::uint8_t>(grid),
            .rock_abundance = Raster<float>(grid)};
  const auto ground = makeLandscape(grid, options);
  forEachStrip({.rows = grid.height, .threads = options.threads}, watch, [&](Rows rows) {
    for (int row = rows.first; row < rows.past; ++row)
      for (int column = 0; column < grid.width; ++column) {
        const Cell cell{column, row};
        const Ground here = ground->at(grid.centre(cell));
        site.map.elevation_m[cell] = static_cast<float>(here.height_m);
        site.classes[cell] = static_cast<std::uint8_t>(here.soil);
        site.rock_abundance[cell] = static_cast<float>(here.rock_share);
      }
  });
  if (watch.stopped()) return {};
  setRocks(site, options);
  return site;
}

}  // namespace talus::maps
