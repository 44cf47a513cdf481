#pragma once

/// Umbrella header of talus::maps: includes elevation maps with georeference, heights from point clouds,
/// positions, and slope and roughness.
#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <talus/common/common.hpp>

namespace talus::maps {

/// A point in map coordinates [m], with x east and y north. Map coordinates are projected coordinates, or
/// local coordinates in metres for a map without a projection.
struct Point {
  double x_m = 0.0;
  double y_m = 0.0;

  friend bool operator==(const Point&, const Point&) = default;
};

/// Returns the Euclidean distance [m] between two points.
inline double distance_m(Point a, Point b) noexcept {
  return std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
}

/// The index of a cell in a grid: the column from west to east and the row from south to north, both counted
/// from 0.
struct Cell {
  int column = 0;
  int row = 0;

  friend bool operator==(const Cell&, const Cell&) = default;
};

/// A rectangle of cells, including both corner cells.
struct CellBox {
  Cell first;  ///< south-west cell
  Cell last;   ///< north-east cell
  int width() const noexcept { return last.column - first.column + 1; }
  int height() const noexcept { return last.row - first.row + 1; }
};

/// Geometry of a raster of square cells. Row 0 is the southernmost row: y increases with the row.
struct Grid {
  int width = 0;              ///< number of columns
  int height = 0;             ///< number of rows
  double resolution_m = 1.0;  ///< side length of a cell, > 0
  Point south_west{};         ///< map coordinates of the south-west corner of cell (0, 0)

  friend bool operator==(const Grid&, const Grid&) = default;

  /// Returns the number of cells.
  std::size_t size() const noexcept {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }

  /// Returns true if the cell lies inside the grid.
  bool contains(Cell c) const noexcept {
    return c.column >= 0 && c.row >= 0 && c.column < width && c.row < height;
  }

  /// Returns the index of the cell in a row-major array. The cell must lie inside the grid.
  std::size_t index(Cell c) const noexcept {
    return static_cast<std::size_t>(c.row) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(c.column);
  }

  /// Returns the map coordinates of the centre of a cell.
  Point centre(Cell c) const noexcept {
    return {south_west.x_m + (c.column + 0.5) * resolution_m, south_west.y_m + (c.row + 0.5) * resolution_m};
  }

  /// Returns the cell that contains the point; nullopt for a point outside the grid or with a NaN coordinate.
  std::optional<Cell> cellAt(Point p) const noexcept {
    const double column = std::floor((p.x_m - south_west.x_m) / resolution_m);
    const double row = std::floor((p.y_m - south_west.y_m) / resolution_m);
    if (!(column >= 0 && row >= 0 && column < width && row < height)) return std::nullopt;
    return Cell{static_cast<int>(column), static_cast<int>(row)};
  }
};

/// A raster: one value for each cell of a grid, in row-major order from the south-west corner.
template <typename T>
class Raster {
 public:
  Raster() = default;
  /// Makes a raster with the value `fill` in every cell.
  explicit Raster(const Grid& grid, T fill = T{}) : grid_(grid), values_(grid.size(), fill) {}

  /// Makes a raster from existing values in row-major order. @throws std::invalid_argument unless there is
  /// one value for each cell
  Raster(const Grid& grid, std::vector<T> values) : grid_(grid), values_(std::move(values)) {
    if (values_.size() != grid.size()) throw std::invalid_argument("raster: one value a cell is needed");
  }

  const Grid& grid() const noexcept { return grid_; }
  bool empty() const noexcept { return values_.empty(); }

  T& operator[](Cell c) noexcept { return values_[grid_.index(c)]; }
  const T& operator[](Cell c) const noexcept { return values_[grid_.index(c)]; }

  std::vector<T>& values() noexcept { return values_; }
  const std::vector<T>& values() const noexcept { return values_; }

  /// Returns a pointer to the first of the `width` values of row r.
  T* row(int r) noexcept { return values_.data() + grid_.index({0, r}); }
  const T* row(int r) const noexcept { return values_.data() + grid_.index({0, r}); }

 private:
  Grid grid_;
  std::vector<T> values_;
};

/// A point of a point cloud, in the map frame: x east, y north, z up.
struct CloudPoint {
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 0.0;
};

/// Rule for the height of a cell from the heights of the cloud points in the cell.
struct HeightChoice {
  /// Percentile of the heights that becomes the height of the cell, (0, 1], rounded up to the height of a
  /// point. 1 selects the highest point.
  double percentile = 1.0;
  /// Least number of points per cell, >= 1; cells with fewer points are unobserved (NaN).
  std::size_t least_points = 1;
};

/// Returns the heights [m] of the cells of a grid from a point cloud; NaN for cells with fewer than
/// choice.least_points points. The result can be used as SurfacePatch::elevation_m. Points outside the grid
/// and non-finite points are ignored; the order of the points has no effect. A percentile below 1 removes
/// outliers above the ground, but also removes the tops of narrow steps. Throws std::invalid_argument for an
/// option out of range, and if no cell has enough points.
Raster<float> heightsOf(std::span<const CloudPoint> points, const Grid& grid,
                        const HeightChoice& choice = {});

/// A latitude and longitude on a body. The latitude is geographic (angle of the surface normal to the
/// equatorial plane) unless the coordinate system is planetocentric (angle at the centre of the body). On a
/// sphere both latitudes are equal.
struct GeoPoint {
  double latitude_rad = 0.0;   ///< latitude, -pi/2 to pi/2, north positive
  double longitude_rad = 0.0;  ///< longitude, east positive

  friend bool operator==(const GeoPoint&, const GeoPoint&) = default;
};

/// Figure of a body: an ellipsoid of revolution, or a sphere if flattening = 0.
struct Ellipsoid {
  double equatorial_radius_m = 0.0;  ///< equatorial radius a, > 0
  double flattening = 0.0;           ///< flattening f = (a - b) / a with the polar radius b, 0 <= f < 1 [-]

  friend bool operator==(const Ellipsoid&, const Ellipsoid&) = default;
};

inline constexpr Ellipsoid kEarth{6378137.0, 1.0 / 298.257223563};                 ///< WGS 84
inline constexpr Ellipsoid kMoon{1737400.0, 0.0};                                  ///< IAU 2015 sphere
inline constexpr Ellipsoid kMars{3396190.0, (3396190.0 - 3376200.0) / 3396190.0};  ///< IAU 2015

/// Returns the name of the body with this equatorial radius ("Earth", "Moon", "Mars", ...), or "body of
/// radius R km" for an unknown radius. A local radius of a body is recognised, too, because maps may use a
/// sphere of local radius.
std::string bodyName(const Ellipsoid& ellipsoid);

/// Returns the planetocentric latitude [rad] of a geographic latitude [rad] on an ellipsoid with equatorial
/// radius a and polar radius b: tan(planetocentric) = (b / a)^2 tan(geographic). geographicLatitude() is the
/// inverse.
double planetocentricLatitude(const Ellipsoid& ellipsoid, double geographic_rad);
double geographicLatitude(const Ellipsoid& ellipsoid, double planetocentric_rad);

/// Map projections of the elevation maps that rovers use. Map files store the numbers.
enum class ProjectionMethod {
  TransverseMercator = 0,
  Mercator = 1,  ///< `scale` is the scale factor along the parallel standard_parallel_1_rad
  /// PROJ's eqc on a sphere of the equatorial radius; true to scale along standard_parallel_1_rad.
  Equirectangular = 2,
  /// `scale` is the scale factor along standard_parallel_1_rad; the sign of that parallel selects the pole.
  PolarStereographic = 3,
  LambertConformalConic = 5,  ///< uses standard parallels 1 and 2, which are equal for a single parallel
  /// Projection defined by the WKT only: any other projection, or a datum of Earth other than WGS 84.
  Foreign = 12,
};

/// Parameters of a projection; parameters that the method does not use are ignored.
struct Projection {
  ProjectionMethod method = ProjectionMethod::TransverseMercator;
  double latitude_of_origin_rad = 0.0;
  /// Longitude of the central meridian from the body's prime meridian, east positive.
  double central_meridian_rad = 0.0;
  double standard_parallel_1_rad = 0.0;
  double standard_parallel_2_rad = 0.0;
  double scale = 1.0;  ///< scale factor at the origin or the standard parallel, > 0 [-]
  double false_easting_m = 0.0;
  double false_northing_m = 0.0;
};

/// Coordinate reference system (CRS) of a map file.
struct CoordinateSystem {
  std::string name{};  ///< name of the system, e.g. "WGS 84 / UTM zone 10N"
  Ellipsoid ellipsoid{};
  Projection projection{};
  /// True if latitudes are angles at the centre of the body; false if latitudes are angles of the surface
  /// normal.
  bool planetocentric = false;
  /// Well-known text (WKT) of the system in the map file, copied into layers derived from the map; may be
  /// empty.
  std::string wkt{};
};

/// Interface of a map projection on an ellipsoid. Longitudes are relative to the central meridian;
/// Georeference adds the false easting and northing. Immutable.
class Transform {
 public:
  Transform() = default;
  Transform(const Transform&) = delete;
  Transform& operator=(const Transform&) = delete;
  virtual ~Transform() = default;

  /// Returns map coordinates [m] of a latitude and longitude.
  virtual Point forward(GeoPoint place) const = 0;
  /// Returns latitude and longitude of map coordinates [m].
  virtual GeoPoint reverse(Point point) const = 0;
};

/// Returns the transform of a projection method, or null for ProjectionMethod::Foreign. The parameters must
/// have been validated.
std::unique_ptr<const Transform> makeTransform(const Ellipsoid& ellipsoid, const Projection& projection);

/// Converts between map coordinates [m] and latitude and longitude [rad] on the ellipsoid of the body (WGS 84
/// on Earth). CoordinateSystem::planetocentric determines whether latitudes are planetocentric or geographic.
/// The conversion uses the projections of GeographicLib [karney2013] (agreement with PROJ: 1 mm) or a given
/// Transform. Immutable, cheap to copy, thread-safe.
class Georeference {
 public:
  /// Uses the projection of GeographicLib for the system's projection method. @throws std::invalid_argument
  /// if a parameter of the system is out of range
  explicit Georeference(CoordinateSystem system);

  /// Uses the given transform, for example PROJ's (maps_io). @throws std::invalid_argument if a parameter of
  /// the system is out of range
  Georeference(CoordinateSystem system, std::shared_ptr<const Transform> transform);

  /// Returns true if conversions are possible. Returns false for ProjectionMethod::Foreign without a given
  /// transform; all conversions then return NaN.
  bool reachesPlaces() const noexcept { return transform_ != nullptr; }

  const CoordinateSystem& system() const noexcept;

  /// Returns the map coordinates [m] of a latitude and longitude [rad]; NaN outside the range of the
  /// projection.
  Point forward(GeoPoint place) const;

  /// Returns the latitude and longitude [rad] of map coordinates [m], with longitude in [-pi, pi]; NaN
  /// outside the range of the projection.
  GeoPoint reverse(Point point) const;

  /// Returns the geodesic distance [m] on the ellipsoid between two points in map coordinates.
  double distance_m(Point from, Point to) const;

  /// Returns the geodesic length per map length [-] at a point, along x and along y. The value is 1 where the
  /// projection preserves lengths.
  Point groundScale(Point at) const;

  /// Returns the name of the body, e.g. "Mars" (bodyName()).
  std::string body() const { return bodyName(system().ellipsoid); }

 private:
  GeoPoint geographic(Point point) const;

  CoordinateSystem system_;
  std::shared_ptr<const Transform> transform_;
};

/// A digital elevation model: the elevation of each square cell of a grid in map coordinates. Row 0 is the
/// southernmost row.
struct ElevationMap {
  /// Elevation above the datum of the body; NaN for cells without data, never infinite.
  Raster<float> elevation_m{};
  /// Conversion to latitude and longitude; nullopt: x and y are local metres.
  std::optional<Georeference> georeference{};
  std::string source{};  ///< path of the map file, as the user stated it
  /// How the numbers of the file became heights, one line: "heights = raw x 0.001 + 1500 m (file), ..."; empty
  /// if the map was not read from a raster.
  std::string reading{};
  std::vector<InputFile> files{};  ///< files from which the map was made, if they were recorded
  /// Decisions of the file reader that the user should know, one line each.
  std::vector<std::string> notes{};

  /// Returns the georeference if it can convert to latitude and longitude, or null.
  const Georeference* places() const noexcept {
    return georeference && georeference->reachesPlaces() ? &*georeference : nullptr;
  }
  /// Returns the grid of the cells.
  const Grid& grid() const noexcept { return elevation_m.grid(); }
};

/// Returns the fraction of the cells that have an elevation, 0 to 1 [-].
double validFraction(const Raster<float>& elevation_m);

/// Returns the elevation [m] at a point in map coordinates, by bilinear interpolation between cell centres;
/// nullopt outside the map or next to a cell without data.
std::optional<double> elevationAt(const Raster<float>& elevation_m, Point point);

/// Returns the elevation [m] at a point like the function above, for cell elevations that the function
/// `elevation_m` returns.
std::optional<double> elevationAt(const Grid& grid, Point point,
                                  const std::function<float(Cell)>& elevation_m);

/// A position stated by the user: map coordinates, or latitude and longitude.
using Place = std::variant<Point, GeoPoint>;

/// Returns the position that a text states: "x,y" in map coordinates [m], or "lat,lon" in degrees with a
/// trailing d on each number ("-4.59d,137.44d"). @throws InputError that quotes the text
Place parsePlace(std::string_view text);

/// Returns the place of the map that a pair in metres is when read as degrees, in either order; nullopt if it is none, or
/// in the cell of the pair.
std::optional<GeoPoint> asDegrees(Point given, const ElevationMap& map);

/// Returns the map coordinates [m] of a position. @throws InputError that begins with `name` if it has a latitude and the
/// map no georeference
Point inMetres(const Place& place, const ElevationMap& map, const std::string& name);

/// Returns the map coordinates of a position inside the map. `name` begins the error message ("--start
/// 10,20"). @throws InputError if the position has a latitude but the map has no coordinate reference system
/// (CRS), if the position lies outside the map (the message states the bounds), or if a position in metres is
/// another one of the map when read as degrees
Point locate(const Place& place, const ElevationMap& map, const std::string& name);

/// A rectangle given by two opposite corners, in any order.
struct Window {
  Place first;
  Place second;
};

/// Returns the rectangle that a text states: "x0,y0,x1,y1" in map coordinates [m], or "lat,lon,lat,lon" in
/// degrees with a trailing d on each number. @throws InputError that quotes the text
Window parseWindow(std::string_view text);

/// Returns the bounds of a grid as text: "spans x 0 to 136 m, y 0 to 157 m".
std::string extent(const Grid& grid);

/// Returns a position as text: "x 12.5 m, y 30.1 m"; for a map with a CRS also latitude and longitude in
/// degrees.
std::string describe(Point point, const ElevationMap& map);

/// Options of terrainMetrics(). The footprint of a cell is the set of cells under a rover at that cell.
struct FootprintOptions {
  /// Radius of the disc-shaped footprint; a disc smaller than 3x3 cells is replaced by 3x3 cells.
  double radius_m = 0.0;
  /// Greatest horizontal distance of two heights that form a step, >= 0; at least one cell is used.
  double step_span_m = 0.0;
  int threads = 1;  ///< number of threads, >= 1; the result does not depend on this number
};

/// Terrain shape under a rover at each cell: the gradients of the least-squares plane over the footprint, and
/// the residuals, i.e. the height differences between the cells and the plane. The values of a cell are NaN
/// if the cell has no data, or if fewer than a quarter of its footprint has data.
struct TerrainMetrics {
  Raster<float> dz_dx;        ///< gradient of the plane eastward [-]
  Raster<float> dz_dy;        ///< gradient of the plane northward [-]
  Raster<float> roughness_m;  ///< root mean square of the residuals
  Raster<float> relief_m;     ///< greatest residual minus least residual
  /// Greatest height step under the rover. The slope on both sides of the step is subtracted
  /// (StepReach). relief_m is only 0.5 to 0.8 of a vertical step, because the fitted plane tilts.
  Raster<float> step_m;
  int footprint_cells = 0;  ///< number of cells of a complete footprint
  bool fell_back = false;   ///< true if 3x3 cells replace a smaller footprint
  /// Standard error of dz_dx and dz_dy for a roughness of 1 m [1/m].
  double gradient_std_per_roughness = 0.0;

  /// Returns the inclination of the plane at a cell [rad], 0 to pi/2.
  float slope_rad(Cell c) const;

  /// Returns the downslope direction of the plane at a cell [rad], counter-clockwise from east, -pi to pi.
  float aspect_rad(Cell c) const;
};

/// Returns the greatest column or row offset [cells] between a cell and the cells on which its metrics
/// depend; the value may be an upper bound.
int metricsReach(const FootprintOptions& options, double resolution_m);

/// Returns the terrain shape at all cells of an elevation raster (NaN for no data). The computing time per
/// cell is proportional to the number of cells of the footprint. After a stop request through `watch`, the
/// remaining rows stay NaN. @throws std::invalid_argument for a radius or span that is negative or not
/// finite, or for threads < 1
TerrainMetrics terrainMetrics(const Raster<float>& elevation_m, const FootprintOptions& options,
                              const ProgressMonitor& watch = {});

}  // namespace talus::maps
