#include <filesystem>

#include <talus/common/input_error.hpp>
#include <talus/maps/vector/place_reader.hpp>
#include <talus/maps/vector/vector_reader.hpp>

namespace talus::maps {
namespace {

bool namesAFile(const std::string& text) {
  return isNamedAsVector(text) || std::filesystem::exists(text);
}

}  // namespace

Point readPlace(const std::string& text, const ElevationMap& map, const std::string& name) {
  const std::string where = name + " " + text;
  if (namesAFile(text)) return locate(readPoint(text, map), map, where);
  try {
    return locate(parsePlace(text), map, where);
  } catch (const InputError& error) {
    if (error.parts().where == where) throw;
    throw InputError({where, error.parts().reason, error.parts().remedy});
  }
}

}  // namespace talus::maps
