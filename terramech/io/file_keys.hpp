#pragma once

#include <span>
#include <string>
#include <vector>

/// Names of keys and columns in the input files of Talus. The readers, `talus help formats` and
/// docs/formats.md use them.
namespace talus::terramech {

/// Key of a YAML file or column of a table. Its name has the unit as suffix.
struct FileKey {
  const char* name = "";
  const char* meaning = "";  ///< quantity, with range, and default or "required"
};

/// Returns the keys of a soil file.
std::span<const FileKey> soilKeys();
/// Return the keys of a rover file, and those of its mapping `wheels`.
std::span<const FileKey> roverKeys();
std::span<const FileKey> wheelKeys();
/// Returns the columns of telemetry and of other tables of wheels.
std::span<const FileKey> telemetryKeys();

/// Returns the names of the keys in order.
std::vector<std::string> namesOf(std::span<const FileKey> keys);

/// Returns the known key that the user probably meant by an unknown key. This is the key of the same name
/// without unit or with a unit of another kind (`cohesion`, `mass_N`), otherwise the key of nearest spelling.
/// Returns an empty text if there is no similar key.
std::string meantKey(const std::string& key, const std::vector<std::string>& known);

}  // namespace talus::terramech
