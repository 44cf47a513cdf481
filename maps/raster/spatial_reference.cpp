#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>

#include <cpl_conv.h>
#include <ogr_spatialref.h>

#include <talus/common/constants.hpp>
#include <talus/common/input_error.hpp>
#include <talus/maps/raster/spatial_reference.hpp>

namespace talus::maps {
namespace {

// Parameters by their WKT 1 names, metres and radians.
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

// What most projections share.
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

// Azimuthal projections name their origin "centre".
Projection centred(ProjectionMethod method, const Parameters& p) {
  Projection out = common(method, p);
  out.latitude_of_origin_rad =
      p.angle(SRS_PP_LATITUDE_OF_CENTER, p.angle(SRS_PP_LATITUDE_OF_ORIGIN) / kDegree);
  out.central_meridian_rad = p.angle(SRS_PP_LONGITUDE_OF_CENTER, p.angle(SRS_PP_CENTRAL_MERIDIAN) / kDegree);
  return out;
}

// One standard parallel where the origin is, with a scale there.
Projection trueAtOrigin(ProjectionMethod method, const Parameters& p) {
  Projection out = common(method, p);
  out.standard_parallel_1_rad = out.standard_parallel_2_rad = out.latitude_of_origin_rad;
  return out;
}

Projection stereographic(const Parameters& p) {
  const Projection out = common(ProjectionMethod::Stereographic, p);
  const bool polar = std::abs(out.latitude_of_origin_rad) > std::numbers::pi / 2 - 1e-9;
  return polar ? trueAtOrigin(ProjectionMethod::PolarStereographic, p) : out;
}

Projection mercatorFromEquator(const Parameters& p) {
  Projection out = common(ProjectionMethod::Mercator, p);
  out.standard_parallel_1_rad = 0.0;
  out.latitude_of_origin_rad = 0.0;
  return out;
}

std::optional<Projection> projectionOf(std::string_view name, const Parameters& p) {
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
      {SRS_PT_ALBERS_CONIC_EQUAL_AREA, [&] { return centred(AlbersEqualArea, p); }},
      {SRS_PT_CYLINDRICAL_EQUAL_AREA, [&] { return common(CylindricalEqualArea, p); }},
      {SRS_PT_LAMBERT_AZIMUTHAL_EQUAL_AREA, [&] { return centred(LambertAzimuthalEqualArea, p); }},
      {SRS_PT_AZIMUTHAL_EQUIDISTANT, [&] { return centred(AzimuthalEquidistant, p); }},
      {SRS_PT_ORTHOGRAPHIC, [&] { return common(Orthographic, p); }},
      {SRS_PT_SINUSOIDAL, [&] { return centred(Sinusoidal, p); }},
  };
  for (const auto& [word, make] : known)
    if (word == name) return make();
  return std::nullopt;
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

// The geographic part of a CRS with longitudes eastward and geographic latitudes on the same ellipsoid.
OGRSpatialReference eastward(const OGRSpatialReference& reference) {
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
    case Stereographic:
      out.SetStereographic(lat0, lon0, p.scale, fe, fn);
      break;
    case LambertConformalConic:
      sp1 == lat0&& sp2 == lat0 ? out.SetLCC1SP(lat0, lon0, p.scale, fe, fn)
                                : out.SetLCC(sp1, sp2, lat0, lon0, fe, fn);
      break;
    case AlbersEqualArea:
      out.SetACEA(sp1, sp2, lat0, lon0, fe, fn);
      break;
    case CylindricalEqualArea:
      out.SetCEA(sp1, lon0, fe, fn);
      break;
    case LambertAzimuthalEqualArea:
      out.SetLAEA(lat0, lon0, fe, fn);
      break;
    case AzimuthalEquidistant:
      out.SetAE(lat0, lon0, fe, fn);
      break;
    case Orthographic:
      out.SetOrthographic(lat0, lon0, fe, fn);
      break;
    case Sinusoidal:
      out.SetSinusoidal(lon0, fe, fn);
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
  std::optional<Projection> projection = projectionOf(method, Parameters(reference));
  if (!projection)
    throw InputError(
        {where, "projection '" + method + "' of CRS '" + name + "' is not known to Talus",
         "resample it with gdalwarp -t_srs to transverse Mercator or another common projection"});
  projection->central_meridian_rad += reference.GetPrimeMeridian() * kDegree;
  const double inverse_flattening = reference.GetInvFlattening();
  const Ellipsoid ellipsoid{reference.GetSemiMajor(), inverse_flattening > 0 ? 1 / inverse_flattening : 0.0};
  OGRSpatialReference in_metres(reference);
  in_metres.StripVertical();
  in_metres.SetLinearUnitsAndUpdateParameters(SRS_UL_METER, 1.0);
  return {name, ellipsoid, *projection, isOcentric(reference), wkt(in_metres)};
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

OGRSpatialReference localProjection(const OGRSpatialReference& geographic, GeoPoint centre) {
  OGRSpatialReference out = eastward(geographic);
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
