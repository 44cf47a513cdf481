#include <filesystem>

#include <nlohmann/json.hpp>

#include <talus/common/input_error.hpp>
#include <talus/maps/vector/geojson.hpp>
#include <talus/maps/vector/place_reader.hpp>
#include <talus/maps/vector/vector_reader.hpp>

namespace talus::maps {
namespace {

bool namesAFile(const std::string& text) {
  return isNamedAsVector(text) || std::filesystem::exists(text);
}

Point firstPoint(const std::string& path, const ElevationMap& map) {
  const nlohmann::json document = readVector(path, map);
  const PositionReader read(document, map, path);
  for (const nlohmann::json& geometry : geometries(document)) {
    const nlohmann::json& coordinates = geometry["coordinates"];
    if (geometry["type"] == "Point") return read(coordinates);
    if (geometry["type"] == "MultiPoint" && coordinates.is_array() && !coordinates.empty())
      return read(coordinates[0]);
  }
  throw InputError({path, "holds no Point", "draw a point feature"});
}

}  // namespace

Point readPlace(const std::string& text, const ElevationMap& map, const std::string& name) {
  const std::string where = name + " " + text;
  if (namesAFile(text)) return locate(firstPoint(text, map), map, where);
  try {
    return locate(parsePlace(text), map, where);
  } catch (const InputError& error) {
    if (error.parts().where == where) throw;
    throw InputError({where, error.parts().reason, error.parts().remedy});
  }
}

}  // namespace talus::maps
