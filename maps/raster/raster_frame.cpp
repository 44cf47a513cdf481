#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>

#include <cpl_string.h>
#include <gdal_priv.h>
#include <gdal_utils.h>
#include <ogr_spatialref.h>

#include <talus/common/constants.hpp>
#include <talus/common/input_error.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/maps/raster/raster_frame.hpp>
#include <talus/maps/raster/spatial_reference.hpp>

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

}  // namespace talus::maps
