#pragma once

#include <exception>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <talus/terramech/contact/wheel_on_soil.hpp>

namespace talus::terramech {

/// Names of keys and columns in the input files of Talus. The readers, `talus help formats` and
/// docs/formats.md use them.

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

namespace YAML {
class Node;
}

/// Strict reader of YAML configuration files. Every field is read by name and unit; every error contains file
/// and line.

namespace talus::terramech {

/// Returns at most the first forty bytes of a text from a file, for messages.
std::string shortened(const std::string& word);

/// Mapping of a YAML file. A field is read by its name with the SI unit as suffix (`cohesion_Pa`). The file
/// may use another unit of the same kind (`cohesion_kPa`); the value is then converted. only() rejects
/// unknown names and suggests the nearest known name. Every error is an InputError with file and line.
///
/// The accepted units, by kind, are: rad deg | Pa hPa kPa MPa | N mN kN | m mm cm dm km | Nm mNm Ncm kNm |
/// mps mmps cmps kmph m_s mm_s cm_s km_h | kg g t | s ms min h | W mW kW | J kJ MJ Wh | m_s2 g0 | kg_m3 g_cm3
/// t_m3 | rad_s deg_s. A name without a suffix is dimensionless. Exceptions are the pressure-sinkage moduli
/// (`.._modulus`) in N/m^(n+1) and N/m^(n+2), which accept _N _kN _MN _Pa _kPa _MPa as a factor.
class YamlFields {
 public:
  /// Reads a file and returns its root mapping. Throws InputError if the file cannot be read, is not YAML, or
  /// is not a mapping.
  static YamlFields file(const std::string& path);

  /// Returns the root mapping of a YAML text; `origin` replaces the path in messages.
  static YamlFields text(const std::string& yaml, const std::string& origin);

  /// Throws InputError if the mapping contains a name that is not in `known`, in any unit. The message
  /// contains the nearest known name. Call only() first, so that a misspelt name is reported before the field
  /// that is missing because of the misspelling.
  void only(const std::vector<std::string>& known) const;

  /// Returns true if the mapping contains the name, in any unit.
  bool has(const std::string& name) const;

  /// Return the value under a name in SI units. Without `fallback`, throw InputError if the name is absent.
  double number(const std::string& name) const;
  double number(const std::string& name, double fallback) const;
  Estimate stated(const std::string& name) const;  ///< number (std 0) or {mean, std} with std > 0
  Estimate stated(const std::string& name, double fallback) const;
  int integer(const std::string& name) const;
  int integer(const std::string& name, int fallback) const;
  bool flag(const std::string& name, bool fallback) const;
  std::string word(const std::string& name) const;
  std::string word(const std::string& name, const std::string& fallback) const;
  /// Returns the numbers of a list; empty if the name is absent. Products of two parameters, such as
  /// covariances, may have magnitudes of 1e-30 to 1e30.
  std::vector<double> numbers(const std::string& name, bool are_products = false) const;

  /// Returns the texts of a list, or a single text. A list inside the list becomes one text with commas
  /// between its items. Returns an empty vector if the name is absent.
  std::vector<std::string> texts(const std::string& name) const;

  /// Returns the mapping under a name. Throws InputError if the name is absent or its value is not a mapping.
  YamlFields fields(const std::string& name) const;
  /// Returns the mappings of the list under a name; empty if the name is absent.
  std::vector<YamlFields> list(const std::string& name) const;
  /// Returns true if the value under a name is a mapping.
  bool isMapping(const std::string& name) const;
  /// Returns all names in the order of the file.
  std::vector<std::string> names() const;

  /// Throws InputError at the line of a name. If the name is empty or absent, the line is that of the
  /// mapping.
  [[noreturn]] void refuse(const std::string& name, const std::string& reason,
                           const std::string& remedy) const;
  /// Converts a range error "owner: field = value, must be bound" to an InputError at the line of the field,
  /// and throws it.
  [[noreturn]] void refuse(const std::exception& range_error) const;

  /// Returns "path:line" of a name, or of the mapping if the name is empty.
  std::string where(const std::string& name = "") const;

 private:
  struct State;
  explicit YamlFields(std::shared_ptr<State> state) : state_(std::move(state)) {}
  static YamlFields of(const YAML::Node& node, const std::string& origin, const std::string& what);

  std::shared_ptr<State> state_;
};

}  // namespace talus::terramech
namespace talus::terramech {

/// Return the YAML texts of the built-in soils and rovers by name, generated from terramech/library/ when
/// CMake configures the build.
const std::map<std::string, std::string>& librarySoilTexts();
const std::map<std::string, std::string>& libraryRoverTexts();

}  // namespace talus::terramech
