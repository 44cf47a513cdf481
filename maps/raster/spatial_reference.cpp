#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <functional>
#include <memory>
#include <mutex>
#include <numbers>
#include <numeric>
#include <string_view>
#include <utility>

#include <cpl_conv.h>
#include <ogr_spatialref.h>

#include <talus/common/constants.hpp>
#include <talus/common/input_error.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/maps/raster/spatial_reference.hpp>

namespace talus::maps {
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
