#pragma once

#include <span>
#include <string>
#include <vector>

/// Names of keys and columns in files of Talus, used by the readers, by `talus help formats` and by
/// docs/formats.md.
namespace talus::terramech {

/// Key of a YAML file or column of a table, with its unit as suffix.
struct FileKey {
  const char* name = "";
  const char* meaning = "";  ///< meaning, and range, default or "required"
};

/// Keys of a soil.
std::span<const FileKey> soilKeys();
/// Keys of a rover and of its `wheels`.
std::span<const FileKey> roverKeys();
std::span<const FileKey> wheelKeys();
/// Columns of telemetry and of other tables of wheels.
std::span<const FileKey> telemetryKeys();

/// Returns the names of the keys in order.
std::vector<std::string> namesOf(std::span<const FileKey> keys);

/// Returns the known key that an unknown key probably means: the same key without unit or with a unit of
/// another kind (`cohesion`, `mass_N`), otherwise the nearest spelling; empty if there is no similar key.
std::string meantKey(const std::string& key, const std::vector<std::string>& known);

}  // namespace talus::terramech
