#pragma once

#include <span>
#include <string>
#include <vector>

/// The names that files of Talus may use. The readers take them from here, and so do `talus help formats` and docs/formats.md.
namespace talus::terramech {

/// A key of a YAML file or a column of a table, with its unit as suffix.
struct FileKey {
  const char* name = "";
  const char* meaning = "";  ///< and range, default or "required"
};

/// Of one soil.
std::span<const FileKey> soilKeys();
/// Of a rover, and of its `wheels`.
std::span<const FileKey> roverKeys();
std::span<const FileKey> wheelKeys();
/// Columns of telemetry and of other tables of wheels.
std::span<const FileKey> telemetryKeys();

/// Their names, in order.
std::vector<std::string> namesOf(std::span<const FileKey> keys);

/// The known key that an unknown one means: the same without its unit or with one of another kind (`cohesion`, `mass_N`), else the
/// nearest in spelling; empty where none is near.
std::string meantKey(const std::string& key, const std::vector<std::string>& known);

}  // namespace talus::terramech
