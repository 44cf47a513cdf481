#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <talus/common/input_error.hpp>
#include <talus/maps/grid/polygon_cover.hpp>
#include <talus/maps/raster/layer_reader.hpp>
#include <talus/maps/terrain/place.hpp>
#include <talus/maps/vector/geojson.hpp>
#include <talus/maps/vector/vector_reader.hpp>

namespace talus::maps {
namespace {

using nlohmann::json;

/// Draws a document's features one by one and refuses each that would close no ground wherever the map lay.
class KeepOutReader {
 public:
  KeepOutReader(const std::string& path, const json& document, const ElevationMap& map)
      : path_(path), read_(document, map, path), keep_out_{.mask = Raster<std::uint8_t>(map.grid())} {}

  KeepOut drawn(const json& document, const std::string& map_source) && {
    if (typeOf(document) == "FeatureCollection") {
      const json& features = listOf(document, "features");
      for (std::size_t i = 0; i < features.size(); ++i) drawFeature(features[i], i + 1);
    } else {
      drawFeature(document, 1);
    }
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

  static std::string typeOf(const json& object) {
    if (!object.is_object()) return "";
    const auto type = object.find("type");
    return type != object.end() && type->is_string() ? type->get<std::string>() : "";
  }

  const json& listOf(const json& object, const char* name) const {
    const auto found = object.find(name);
    if (found == object.end() || !found->is_array())
      refuse(std::string("has no list \"") + name + "\"", "see RFC 7946");
    return *found;
  }

  void drawFeature(const json& feature, std::size_t number) {
    feature_ = "feature " + std::to_string(number);
    const bool is_feature = typeOf(feature) == "Feature";
    if (is_feature) {
      if (const auto properties = feature.find("properties");
          properties != feature.end() && properties->is_object())
        if (const auto name = properties->find("name"); name != properties->end() && name->is_string())
          feature_ += " '" + name->get<std::string>().substr(0, 40) + "'";
    }
    owner_ = feature_ + ": ";
    if (!is_feature) return drawGeometry(feature);
    if (!feature.contains("geometry")) refuse("has no geometry", "write its polygon, or remove it");
    drawGeometry(feature["geometry"]);
  }

  void drawGeometry(const json& geometry) {
    const std::string type = typeOf(geometry);
    if (type == "GeometryCollection") {
      for (const json& part : listOf(geometry, "geometries")) drawGeometry(part);
    } else if (type == "Polygon") {
      draw(listOf(geometry, "coordinates"));
    } else if (type == "MultiPolygon") {
      for (const json& rings : listOf(geometry, "coordinates")) draw(rings);
    } else {
      refuse(type.empty() ? "has no geometry" : type.substr(0, 40) + " is no Polygon and keeps nothing out",
             "write it as a Polygon, or remove it");
    }
  }

  Ring ring(const json& positions) const {
    if (!positions.is_array() || positions.size() < 4)
      refuse("a ring of a polygon has fewer than four positions", "close it on its first position");
    Ring out;
    for (const json& position : positions) out.push_back(read_(position));
    return out;
  }

  void draw(const json& rings) {
    if (!rings.is_array() || rings.empty()) refuse("a polygon has no ring", "see RFC 7946");
    Polygon polygon{.outer = ring(rings.front())};
    if (!enclosesGround(polygon))
      refuse("a polygon encloses no ground",
             "its positions lie in one line or it runs back on itself: correct it");
    for (std::size_t i = 1; i < rings.size(); ++i) polygon.holes.push_back(ring(rings[i]));
    if (!enclosesGround(polygon))
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
  PositionReader read_;
  KeepOut keep_out_;
  std::string feature_, owner_;
  std::vector<std::string> beside_;
  int polygons_ = 0;
};

}  // namespace

KeepOut readKeepOut(const std::string& path, const ElevationMap& map) {
  const json document = readVector(path, map);
  return KeepOutReader(path, document, map).drawn(document, map.source);
}

}  // namespace talus::maps
