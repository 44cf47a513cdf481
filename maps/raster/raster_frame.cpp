#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <mutex>
#include <numbers>
#include <numeric>
#include <string_view>
#include <utility>

#include <cpl_conv.h>
#include <cpl_string.h>
#include <gdal_priv.h>
#include <gdal_utils.h>
#include <ogr_spatialref.h>

#include <talus/common/common.hpp>
#include <talus/maps/raster/raster_frame.hpp>

namespace talus::maps {

namespace {

std::string exact(double value) {
  if (std::isnan(value)) return "nan";
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.17g", value);
  return text.data();
}

CPLStringList warpWords(GDALDataset& source, const WarpTarget& target) {
  CPLStringList words;
  const auto add = [&](const auto&... word) { (words.AddString(std::string(word).c_str()), ...); };
  add("-of", "VRT", "-ot", "Float32", "-wt", "Float32", "-dstnodata", "nan", "-et", "0.001", "-r",
      target.method);
  if (!target.wkt.empty()) add("-t_srs", target.wkt);
  if (target.grid) {
    const Grid& g = *target.grid;
    add("-te", exact(g.south_west.x_m), exact(g.south_west.y_m),
        exact(g.south_west.x_m + g.width * g.resolution_m),
        exact(g.south_west.y_m + g.height * g.resolution_m));
    add("-ts", std::to_string(g.width), std::to_string(g.height));
  } else if (target.resolution > 0) {
    add("-tr", exact(target.resolution), exact(target.resolution));
  }
  GDALRasterBand& band = *source.GetRasterBand(1);
  if (int declared = 0; band.GetNoDataValue(&declared),
                        declared == 0 && GDALDataTypeIsFloating(band.GetRasterDataType()) != FALSE)
    add("-srcnodata", "nan");
  return words;
}

}  // namespace

Dataset warp(GDALDataset& source, const WarpTarget& target, const std::string& where) {
  const GdalErrors errors;
  CPLStringList words = warpWords(source, target);
  const std::unique_ptr<GDALWarpAppOptions, decltype(&GDALWarpAppOptionsFree)> options(
      GDALWarpAppOptionsNew(words.List(), nullptr), GDALWarpAppOptionsFree);
  GDALDatasetH input = GDALDataset::ToHandle(&source);
  Dataset out(GDALDataset::FromHandle(GDALWarp("", nullptr, 1, &input, options.get(), nullptr)));
  if (!out) throw InputError({where, "cannot be resampled: " + errors.last(), "resample it with gdalwarp"});
  return out;
}

namespace {

constexpr double kMostStretch = 0.05;  // scale error of the projection [-] above which a map is resampled
constexpr double kWidestSpan_rad =
    20 * kDegree;  // greatest extent of a geographic raster for a single local projection

// GDAL's geotransform: x = c[0] + column c[1] + row c[2], y = c[3] + column c[4] + row c[5].
struct Pixels {
  std::array<double, 6> c{0, 1, 0, 0, 0, -1};
  bool stated = false;
  int width = 0;
  int height = 0;

  explicit Pixels(GDALDataset& file) : width(file.GetRasterXSize()), height(file.GetRasterYSize()) {
    stated = file.GetGeoTransform(c.data()) == CE_None;
    if (!stated) c = {0, 1, 0, static_cast<double>(height), 0, -1};
  }

  bool areFinite() const {
    return std::all_of(c.begin(), c.end(), [](double v) { return std::isfinite(v); }) &&
           c[1] * c[5] != c[2] * c[4];
  }
  bool areUpright() const { return c[2] == 0 && c[4] == 0 && c[1] > 0; }
  double side() const { return std::abs(c[1]); }
  // True if pixels are upright, and their sides differ by at most 0.05 cells in total across the raster.
  bool areSquare() const {
    return areUpright() && std::abs(side() - std::abs(c[5])) * std::max(width, height) <= 0.05 * side();
  }
  Point at(double column, double row) const {
    return {c[0] + column * c[1] + row * c[2], c[3] + column * c[4] + row * c[5]};
  }
  // Side of a square with the area of a pixel.
  double meanSide() const { return std::sqrt(std::abs(c[1] * c[5] - c[2] * c[4])); }
};

bool near(double a, double b) {
  return std::abs(a - b) <= 1e-6 * std::abs(b);
}

// Frame of a raster with square, upright pixels; `metres` is the length of a unit of the file.
FramedRaster upright(GDALDataset& raster, double metres) {
  const Pixels p(raster);
  const double south = std::min(p.c[3], p.c[3] + p.height * p.c[5]);
  return {.grid = {.width = p.width,
                   .height = p.height,
                   .resolution_m = p.side() * metres,
                   .south_west = {p.c[0] * metres, south * metres}},
          .north_up = p.c[5] < 0};
}

FramedRaster local(GDALDataset& file, const ReadOptions& options, const std::string& path,
                   std::vector<std::string>& notes) {
  const Pixels p(file);
  const double resolution_m = *options.resolution_m;
  if (!p.areSquare())
    throw InputError({path, "has no usable CRS and its pixels are not square and upright",
                      "resample it with gdalwarp -tr, or give it a CRS with gdal_edit.py -a_srs"});
  const bool contradicts = p.stated && !near(p.side(), resolution_m);
  if (contradicts && !options.ignore_crs)
    throw InputError(
        {path, "states cells of " + number(p.side()) + ", --resolution states " + number(resolution_m) + " m",
         "pass --resolution " + number(p.side()) +
             " if that is metres, correct the file with gdal_edit.py "
             "(-a_srs, -tr), or pass --ignore-crs to ignore what it states"});
  FramedRaster out = upright(file, 1.0);
  if (!p.stated || contradicts) out.grid.south_west = {0.0, 0.0};
  out.grid.resolution_m = resolution_m;
  notes.push_back("no CRS: cells of " + number(resolution_m) + " m taken, x and y in local metres from " +
                  number(out.grid.south_west.x_m) + "," + number(out.grid.south_west.y_m));
  return out;
}

// Returns the centre of a window in degrees, else of the whole file.
GeoPoint geographicCentre(const Pixels& p, const ReadOptions& options) {
  if (options.window) {
    const auto* a = std::get_if<GeoPoint>(&options.window->first);
    const auto* b = std::get_if<GeoPoint>(&options.window->second);
    if (a != nullptr && b != nullptr)
      return {(a->latitude_rad + b->latitude_rad) / 2, (a->longitude_rad + b->longitude_rad) / 2};
  }
  const Point middle = p.at(p.width / 2.0, p.height / 2.0);
  return {middle.y_m * kDegree, middle.x_m * kDegree};
}

// Mean pixel side [m] at a latitude, rounded to four significant digits.
double geographicResolution(const Pixels& p, double radius_m, double latitude_rad) {
  const double metres = p.meanSide() * kDegree * radius_m * std::sqrt(std::max(0.02, std::cos(latitude_rad)));
  const double step = std::pow(10.0, std::floor(std::log10(metres)) - 3);  // four digits are enough
  return std::round(metres / step) * step;
}

void refuseWholeBodies(const Pixels& p, const ReadOptions& options, const std::string& path) {
  const double span =
      std::max(p.width * std::hypot(p.c[1], p.c[4]), p.height * std::hypot(p.c[2], p.c[5])) * kDegree;
  if (span <= kWidestSpan_rad || options.window) return;
  throw InputError({path, "spans " + number(span / kDegree) + " degrees, too large for one map in metres",
                    "read a part with --window LATd,LONd,LATd,LONd or project it with gdalwarp"});
}

// Rejects longitudes beyond 360 and latitudes beyond 90 degrees by more than a pixel or a hundredth of a degree. Half a pixel beyond a
// pole is valid: the pixel centres may lie on the pole.
void refuseBeyondBody(const Pixels& p, const std::string& path) {
  const double pixel = std::max({std::hypot(p.c[1], p.c[4]), std::hypot(p.c[2], p.c[5]), 0.01});
  for (const double column : {0.0, static_cast<double>(p.width)})
    for (const double row : {0.0, static_cast<double>(p.height)})
      if (const Point corner = p.at(column, row);
          std::abs(corner.x_m) > 360.0 + pixel || std::abs(corner.y_m) > 90.0 + pixel)
        throw InputError({path,
                          "has a corner at longitude " + number(corner.x_m) + ", latitude " +
                              number(corner.y_m) + ", must be within 360 and 90 degrees",
                          "repair it with gdal_edit.py -a_ullr or -a_srs"});
}

struct Resampling {
  Georeference target;
  double resolution_m = 0.0;
  double finest_m = 0.0;  ///< approximate side of the source pixels
};

Georeference localGeoreference(const OGRSpatialReference& crs, GeoPoint centre, const std::string& path) {
  return georeferenceAt(coordinateSystem(localProjection(crs, centre), path), std::array{Point{}});
}

FramedRaster resampled(GDALDataset& file, const Resampling& to, const std::string& path) {
  const bool coarser = to.resolution_m > 1.5 * to.finest_m;
  const Dataset cells =
      warp(file, {.wkt = to.target.system().wkt, .resolution = to.resolution_m, .grid = std::nullopt}, path);
  FramedRaster out = upright(*cells, 1.0);
  out.georeference = to.target;
  out.resampling = coarser ? "average" : "cubic";
  return out;
}

FramedRaster geographic(GDALDataset& file, const OGRSpatialReference& crs, const ReadOptions& options,
                        const std::string& path, std::vector<std::string>& notes) {
  const Pixels p(file);
  refuseBeyondBody(p, path);
  refuseWholeBodies(p, options, path);
  const GeoPoint centre = geographicCentre(p, options);
  const double finest_m = geographicResolution(p, crs.GetSemiMajor(), centre.latitude_rad);
  const double resolution_m = options.resolution_m.value_or(finest_m);
  notes.push_back("degrees resampled to cells of " + number(resolution_m) +
                  " m in a local projection around " + number(centre.latitude_rad / kDegree) + "d," +
                  number(centre.longitude_rad / kDegree) + "d");
  return resampled(file, {localGeoreference(crs, centre, path), resolution_m, finest_m}, path);
}

FramedRaster projected(GDALDataset& file, const OGRSpatialReference& crs, const ReadOptions& options,
                       const std::string& path, std::vector<std::string>& notes) {
  const Pixels p(file);
  const double metres = crs.GetLinearUnits();
  const auto at = [&](double right, double down) {
    const Point point = p.at(right * p.width, down * p.height);
    return Point{point.x_m * metres, point.y_m * metres};
  };
  const Point middle = at(0.5, 0.5);
  Georeference georeference =
      georeferenceAt(coordinateSystem(crs, path), std::array{middle, at(0, 0), at(1, 0), at(0, 1), at(1, 1)});
  const Point ground = georeference.groundScale(middle);
  if (!std::isfinite(ground.x_m) || !std::isfinite(ground.y_m))
    throw InputError({path, "lies outside the range of its CRS '" + georeference.system().name + "'",
                      "correct the CRS or read with --ignore-crs --resolution METRES"});
  const double finest_m = p.meanSide() * metres * std::sqrt(ground.x_m * ground.y_m);
  const double stretch = std::max(std::abs(ground.x_m - 1), std::abs(ground.y_m - 1));
  if (stretch > kMostStretch) {
    const GeoPoint centre = georeference.reverse(middle);
    const double resolution_m = options.resolution_m.value_or(finest_m);
    notes.push_back("one metre of its CRS is " + number(ground.x_m) + " m of ground eastward, " +
                    number(ground.y_m) +
                    " m northward: resampled to true metres in a local projection, cells of " +
                    number(resolution_m) + " m");
    return resampled(file, {localGeoreference(crs, centre, path), resolution_m, finest_m}, path);
  }
  const double pixel_m = p.meanSide() * metres;
  const double resolution_m = options.resolution_m.value_or(pixel_m);
  if (!p.areSquare() || !near(resolution_m, pixel_m)) {
    notes.push_back("pixels resampled to square cells of " + number(resolution_m) + " m");
    return resampled(file, {std::move(georeference), resolution_m, pixel_m}, path);
  }
  FramedRaster out = upright(file, metres);
  out.georeference.emplace(std::move(georeference));
  return out;
}

}  // namespace

FramedRaster frame(GDALDataset& file, const ReadOptions& options, const std::string& path,
                   std::vector<std::string>& notes) {
  if (!Pixels(file).areFinite())
    throw InputError(
        {path, "its pixel size or origin is not a number or zero", "repair it with gdal_edit.py -a_ullr"});
  const OGRSpatialReference* stated = file.GetSpatialRef();
  const bool usable =
      stated != nullptr && (stated->IsProjected() || stated->IsGeographic()) && !options.ignore_crs;
  if (!usable) {
    if (options.resolution_m) return local(file, options, path, notes);
    throw InputError(
        {path, options.ignore_crs ? "its CRS is ignored, so its cell size is unknown" : "no CRS",
         "pass --resolution METRES to read it as local metres" +
             (Pixels(file).stated ? "; it states cells of " + number(Pixels(file).side()) : "")});
  }
  if (!Pixels(file).stated)
    throw InputError({path, "has a CRS but no pixel size", "pass --ignore-crs --resolution METRES"});
  OGRSpatialReference crs(*stated);
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return crs.IsProjected() ? projected(file, crs, options, path, notes)
                           : geographic(file, crs, options, path, notes);
}

namespace {

// Projection parameters by their WKT 1 names, in metres and radians.
class Parameters {
 public:
  explicit Parameters(const OGRSpatialReference& reference) : reference_(reference) {}

  double angle(const char* name, double otherwise_deg = 0.0) const {
    return reference_.GetNormProjParm(name, otherwise_deg) * kDegree;
  }
  double length(const char* name) const { return reference_.GetNormProjParm(name, 0.0); }
  double scale() const { return reference_.GetNormProjParm(SRS_PP_SCALE_FACTOR, 1.0); }

 private:
  const OGRSpatialReference& reference_;
};

// Conversion of the parameters that most projections share.
Projection common(ProjectionMethod method, const Parameters& p) {
  return {.method = method,
          .latitude_of_origin_rad = p.angle(SRS_PP_LATITUDE_OF_ORIGIN),
          .central_meridian_rad = p.angle(SRS_PP_CENTRAL_MERIDIAN),
          .standard_parallel_1_rad = p.angle(SRS_PP_STANDARD_PARALLEL_1),
          .standard_parallel_2_rad = p.angle(SRS_PP_STANDARD_PARALLEL_2),
          .scale = p.scale(),
          .false_easting_m = p.length(SRS_PP_FALSE_EASTING),
          .false_northing_m = p.length(SRS_PP_FALSE_NORTHING)};
}

// A projection with one standard parallel, at the latitude of origin.
Projection trueAtOrigin(ProjectionMethod method, const Parameters& p) {
  Projection out = common(method, p);
  out.standard_parallel_1_rad = out.standard_parallel_2_rad = out.latitude_of_origin_rad;
  return out;
}

Projection mercatorFromEquator(const Parameters& p) {
  Projection out = common(ProjectionMethod::Mercator, p);
  out.standard_parallel_1_rad = 0.0;
  out.latitude_of_origin_rad = 0.0;
  return out;
}

// Converts the polar aspect; other aspects become Foreign.
Projection stereographic(const Parameters& p) {
  const bool polar = std::abs(p.angle(SRS_PP_LATITUDE_OF_ORIGIN)) > std::numbers::pi / 2 - 1e-9;
  return polar ? trueAtOrigin(ProjectionMethod::PolarStereographic, p)
               : Projection{.method = ProjectionMethod::Foreign};
}

Projection projectionOf(std::string_view name, const Parameters& p) {
  using enum ProjectionMethod;
  const std::pair<std::string_view, std::function<Projection()>> known[] = {
      {SRS_PT_TRANSVERSE_MERCATOR, [&] { return common(TransverseMercator, p); }},
      {SRS_PT_MERCATOR_1SP, [&] { return mercatorFromEquator(p); }},
      {SRS_PT_MERCATOR_2SP, [&] { return common(Mercator, p); }},
      {SRS_PT_EQUIRECTANGULAR, [&] { return common(Equirectangular, p); }},
      {SRS_PT_POLAR_STEREOGRAPHIC, [&] { return trueAtOrigin(PolarStereographic, p); }},
      {SRS_PT_STEREOGRAPHIC, [&] { return stereographic(p); }},
      {SRS_PT_LAMBERT_CONFORMAL_CONIC_1SP, [&] { return trueAtOrigin(LambertConformalConic, p); }},
      {SRS_PT_LAMBERT_CONFORMAL_CONIC_2SP, [&] { return common(LambertConformalConic, p); }},
  };
  for (const auto& [word, make] : known)
    if (word == name) return make();
  return {.method = Foreign};
}

std::string text(const char* words) {
  return words == nullptr ? "" : words;
}

std::string wkt(const OGRSpatialReference& reference) {
  char* words = nullptr;
  const char* options[] = {"FORMAT=WKT2_2019", nullptr};
  reference.exportToWkt(&words, options);
  const std::unique_ptr<char, decltype(&CPLFree)> owner(words, CPLFree);
  return text(words);
}

bool holdsNoCase(std::string_view words, std::string_view word) {
  return std::search(words.begin(), words.end(), word.begin(), word.end(), [](char a, char b) {
           return std::tolower(static_cast<unsigned char>(a)) == b;
         }) != words.end();
}

bool countsWestward(const OGRSpatialReference& reference) {
  OGRAxisOrientation orientation[2] = {OAO_Other, OAO_Other};
  for (int axis = 0; axis < 2; ++axis) reference.GetAxis(nullptr, axis, &orientation[axis]);
  return orientation[0] == OAO_West || orientation[1] == OAO_West;
}

bool isOcentric(const OGRSpatialReference& reference) {
  return reference.GetInvFlattening() > 0 && holdsNoCase(text(reference.GetAttrValue("GEOGCS")), "ocentric");
}

// Returns the geographic CRS for latitude and longitude: WGS 84 on Earth; on other bodies the geographic CRS
// of `reference`, converted to eastward longitudes and geographic latitudes on the same ellipsoid.
OGRSpatialReference placesOf(const OGRSpatialReference& reference) {
  if (bodyName({reference.GetSemiMajor(), 0.0}) == bodyName(kEarth)) {
    OGRSpatialReference out;
    out.SetWellKnownGeogCS("WGS84");
    out.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    return out;
  }
  const std::unique_ptr<OGRSpatialReference> base(reference.CloneGeogCS());
  OGRSpatialReference out(*base);
  if (countsWestward(*base) || isOcentric(*base)) {
    const char* prime_meridian = nullptr;
    const double prime_meridian_deg = base->GetPrimeMeridian(&prime_meridian);
    const std::string body = text(base->GetAttrValue("DATUM"));
    out.Clear();
    out.SetGeogCS(body.c_str(), body.c_str(), text(base->GetAttrValue("SPHEROID")).c_str(),
                  base->GetSemiMajor(), base->GetInvFlattening(), prime_meridian, prime_meridian_deg);
  }
  out.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return out;
}

// Transform of a projected CRS by PROJ, between placesOf() and map coordinates.
class ProjTransform final : public Transform {
 public:
  explicit ProjTransform(const OGRSpatialReference& projected) {
    registerDrivers();
    const OGRSpatialReference places = placesOf(projected);
    to_map_.reset(OGRCreateCoordinateTransformation(&places, &projected));
    to_place_.reset(OGRCreateCoordinateTransformation(&projected, &places));
  }

  Point forward(GeoPoint p) const override {
    return changed(to_map_.get(), {p.longitude_rad / kDegree, p.latitude_rad / kDegree});
  }

  GeoPoint reverse(Point p) const override {
    const Point degrees = changed(to_place_.get(), p);
    return {degrees.y_m * kDegree, degrees.x_m * kDegree};
  }

 private:
  // Serialised, because GDAL's transformations are not thread-safe.
  Point changed(OGRCoordinateTransformation* change, Point p) const {
    const std::scoped_lock lock(mutex_);
    const GdalErrors quiet;
    const bool done = change != nullptr && change->Transform(1, &p.x_m, &p.y_m) != FALSE;
    return done && std::isfinite(p.x_m) && std::isfinite(p.y_m) ? p : Point{kNaN, kNaN};
  }

  mutable std::mutex mutex_;
  std::unique_ptr<OGRCoordinateTransformation> to_map_, to_place_;
};

constexpr double kAgreement_m = 0.01;  // GeographicLib and PROJ differ by 1 mm, datums by metres

bool agree(GeoPoint ours, GeoPoint theirs, double radius_m) {
  if (std::isnan(ours.latitude_rad) && std::isnan(theirs.latitude_rad))
    return true;  // points beyond the edge of the body do not count
  const double north_m = (ours.latitude_rad - theirs.latitude_rad) * radius_m;
  const double turn = std::remainder(ours.longitude_rad - theirs.longitude_rad, 2 * std::numbers::pi);
  return std::hypot(north_m, turn * std::cos(ours.latitude_rad) * radius_m) <= kAgreement_m;
}

void setFromNumbers(OGRSpatialReference& out, const Projection& p) {
  using enum ProjectionMethod;
  const double lat0 = p.latitude_of_origin_rad / kDegree;
  const double lon0 = p.central_meridian_rad / kDegree;
  const double sp1 = p.standard_parallel_1_rad / kDegree;
  const double sp2 = p.standard_parallel_2_rad / kDegree;
  const double fe = p.false_easting_m;
  const double fn = p.false_northing_m;
  switch (p.method) {
    case TransverseMercator:
      out.SetTM(lat0, lon0, p.scale, fe, fn);
      break;
    case Mercator:
      sp1 == 0 ? out.SetMercator(0.0, lon0, p.scale, fe, fn) : out.SetMercator2SP(sp1, lat0, lon0, fe, fn);
      break;
    case Equirectangular:
      out.SetEquirectangular2(lat0, lon0, sp1, fe, fn);
      break;
    case PolarStereographic:
      out.SetPS(sp1, lon0, p.scale, fe, fn);
      break;
    case LambertConformalConic:
      sp1 == lat0&& sp2 == lat0 ? out.SetLCC1SP(lat0, lon0, p.scale, fe, fn)
                                : out.SetLCC(sp1, sp2, lat0, lon0, fe, fn);
      break;
    case Foreign:
      break;
  }
}

}  // namespace

CoordinateSystem coordinateSystem(const OGRSpatialReference& reference, const std::string& where) {
  const std::string name = text(reference.GetName());
  if (!reference.IsProjected()) throw InputError({where, "CRS '" + name + "' is not projected", ""});
  if (countsWestward(reference))
    throw InputError({where, "CRS '" + name + "' has a westward x axis",
                      "gdalwarp -t_srs to a CRS whose x axis points east"});
  const std::string method = text(reference.GetAttrValue("PROJECTION"));
  Projection projection = projectionOf(method, Parameters(reference));
  if (projection.method != ProjectionMethod::Foreign)
    projection.central_meridian_rad += reference.GetPrimeMeridian() * kDegree;
  const double inverse_flattening = reference.GetInvFlattening();
  const Ellipsoid ellipsoid{reference.GetSemiMajor(), inverse_flattening > 0 ? 1 / inverse_flattening : 0.0};
  OGRSpatialReference in_metres(reference);
  in_metres.StripVertical();
  in_metres.SetLinearUnitsAndUpdateParameters(SRS_UL_METER, 1.0);
  return {name, ellipsoid, projection, isOcentric(reference), wkt(in_metres)};
}

OGRSpatialReference spatialReference(const CoordinateSystem& system) {
  OGRSpatialReference out;
  out.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  if (!system.wkt.empty() && out.importFromWkt(system.wkt.c_str()) == OGRERR_NONE) return out;
  const double f = system.ellipsoid.flattening;
  const std::string body = bodyName(system.ellipsoid);
  out.SetProjCS(system.name.c_str());
  out.SetGeogCS(body.c_str(), body.c_str(), body.c_str(), system.ellipsoid.equatorial_radius_m,
                f > 0 ? 1 / f : 0.0, "Reference meridian", 0.0);
  setFromNumbers(out, system.projection);
  out.SetLinearUnits(SRS_UL_METER, 1.0);
  return out;
}

Georeference georeferenceAt(CoordinateSystem system, std::span<const Point> points) {
  if (system.wkt.empty()) return Georeference(std::move(system));
  const auto proj = std::make_shared<const ProjTransform>(spatialReference(system));
  CoordinateSystem geographic = system;
  geographic.planetocentric = false;  // latitudes of ProjTransform are geographic
  const Georeference own(std::move(geographic));
  const double radius_m = system.ellipsoid.equatorial_radius_m;
  if (own.reachesPlaces() &&
      std::ranges::all_of(points, [&](Point p) { return agree(own.reverse(p), proj->reverse(p), radius_m); }))
    return Georeference(std::move(system));
  system.projection = {.method = ProjectionMethod::Foreign};
  if (bodyName(system.ellipsoid) == bodyName(kEarth)) system.ellipsoid = kEarth;
  return {std::move(system), proj};
}

Georeference georeferenceOn(const CoordinateSystem& system, const Grid& grid) {
  const Point a = grid.south_west;
  const Point b{a.x_m + grid.width * grid.resolution_m, a.y_m + grid.height * grid.resolution_m};
  return georeferenceAt(system, std::array{a, b, Point{a.x_m, b.y_m}, Point{b.x_m, a.y_m},
                                           Point{std::midpoint(a.x_m, b.x_m), std::midpoint(a.y_m, b.y_m)}});
}

OGRSpatialReference localProjection(const OGRSpatialReference& geographic, GeoPoint centre) {
  OGRSpatialReference out = placesOf(geographic);
  const double latitude = centre.latitude_rad / kDegree;
  if (std::abs(latitude) > 80)
    out.SetPS(std::copysign(90.0, latitude), 0.0, 1.0, 0.0, 0.0);
  else
    out.SetTM(latitude, centre.longitude_rad / kDegree - out.GetPrimeMeridian(), 1.0, 0.0, 0.0);
  out.SetNode("PROJCS", ("local projection on " + text(out.GetAttrValue("GEOGCS"))).c_str());
  out.SetLinearUnits(SRS_UL_METER, 1.0);
  return out;
}

}  // namespace talus::maps
