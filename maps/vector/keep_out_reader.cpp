#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <ogr_geometry.h>

#include <talus/common/input_error.hpp>
#include <talus/common/memory_budget.hpp>
#include <talus/common/plausible.hpp>
#include <talus/maps/grid/cover.hpp>
#include <talus/maps/raster/layer_reader.hpp>
#include <talus/maps/terrain/place.hpp>
#include <talus/maps/vector/vector_reader.hpp>

namespace talus::maps {
namespace {

// Memory of GDAL's geometry, the ring and its edges per byte of a position of 16 bytes.
constexpr double kMemoryPerDrawnByte = 8.0;

/// Rasterises the features of a file one by one. Refuses each feature that would exclude no ground on any
/// map.
class KeepOutReader {
 public:
  KeepOutReader(const std::string& path, const ElevationMap& map)
      : path_(path), keep_out_{.mask = Raster<std::uint8_t>(map.grid())} {}

  void drawFeature(const std::string& name, const OGRGeometry* drawn) {
    begin(name);
    if (drawn == nullptr) refuse("has no geometry", "write its polygon, or remove it");
    requireMemory(kMemoryPerDrawnByte * static_cast<double>(drawn->WkbSize()), path_);
    drawGeometry(*drawn);
  }

  KeepOut drawn(const std::string& map_source) && {
    if (polygons_ == 0) throw InputError({path_, "holds no Polygon", "write the keep-out areas as polygons"});
    if (static_cast<int>(beside_.size()) == polygons_)
      throw InputError({path_, "no polygon overlaps map '" + map_source + "'",
                        "the map " + extent(keep_out_.mask.grid())});
    noteBeside();
    return std::move(keep_out_);
  }

 private:
  [[noreturn]] void refuse(const std::string& reason, const std::string& remedy) const {
    throw InputError({path_, owner_ + reason, remedy});
  }

  void begin(const std::string& name) {
    feature_ =
        "feature " + std::to_string(++features_) + (name.empty() ? "" : " '" + name.substr(0, 40) + "'");
    owner_ = feature_ + ": ";
  }

  [[noreturn]] void refuseType(const std::string& type) const {
    refuse(type.empty() ? "has no geometry" : type.substr(0, 40) + " is no Polygon and keeps nothing out",
           "write it as a Polygon, or remove it");
  }

  void drawGeometry(const OGRGeometry& geometry) {
    switch (wkbFlatten(geometry.getGeometryType())) {
      case wkbPolygon:
      case wkbTriangle:
        return draw(*geometry.toPolygon());
      case wkbMultiPolygon:
      case wkbGeometryCollection:
        for (const OGRGeometry* part : *geometry.toGeometryCollection()) drawGeometry(*part);
        return;
      default:
        refuseType(OGRToOGCGeomType(geometry.getGeometryType()));
    }
  }

  Ring ring(const OGRLinearRing& positions) const {
    if (positions.getNumPoints() < 4)
      refuse("a ring of a polygon has fewer than four positions", "close it on its first position");
    Ring out(static_cast<std::size_t>(positions.getNumPoints()));
    for (int i = 0; i < positions.getNumPoints(); ++i) {
      const Point at{positions.getX(i), positions.getY(i)};
      if (!plausible(at.x_m) || !plausible(at.y_m))
        refuse("position " + std::to_string(i + 1) + " of a ring: " + kPlausible, "correct the position");
      out[static_cast<std::size_t>(i)] = at;
    }
    return out;
  }

  void draw(const OGRPolygon& rings) {
    if (rings.getExteriorRing() == nullptr) refuse("a polygon has no ring", "draw it again");
    Polygon polygon = outside(ring(*rings.getExteriorRing()));
    for (int i = 0; i < rings.getNumInteriorRings(); ++i)
      polygon.holes.push_back(ring(*rings.getInteriorRing(i)));
    draw(polygon);
  }

  Polygon outside(Ring ring) const {
    Polygon polygon{.outer = std::move(ring)};
    if (!enclosesGround(polygon))
      refuse("a polygon encloses no ground",
             "its positions lie in one line or it runs back on itself: correct it");
    return polygon;
  }

  void draw(const Polygon& polygon) {
    if (!polygon.holes.empty() && !enclosesGround(polygon))
      refuse("the holes of a polygon cover all of it", "remove the hole that is as large as its ring");
    ++polygons_;
    if (!cover(polygon, keep_out_.mask)) beside_.push_back(feature_);
  }

  void noteBeside() {
    constexpr std::size_t kNamed = 8;
    if (beside_.empty()) return;
    std::string note = std::to_string(beside_.size()) + " of " + std::to_string(polygons_) +
                       (beside_.size() == 1 ? " polygons lies" : " polygons lie") + " beside the map: ";
    for (std::size_t i = 0; i < beside_.size() && i < kNamed; ++i) note += (i == 0 ? "" : ", ") + beside_[i];
    keep_out_.notes.push_back(note + (beside_.size() > kNamed ? " and others" : ""));
  }

  const std::string& path_;
  KeepOut keep_out_;
  std::string feature_, owner_;
  std::vector<std::string> beside_;
  std::size_t features_ = 0;
  int polygons_ = 0;
};

}  // namespace

KeepOut readKeepOut(const std::string& path, const ElevationMap& map) {
  KeepOutReader reader(path, map);
  visitVector(path, map,
              [&](const std::string& name, const OGRGeometry* drawn) { reader.drawFeature(name, drawn); });
  return std::move(reader).drawn(map.source);
}

}  // namespace talus::maps
