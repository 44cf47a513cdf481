#pragma once

#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <talus/terramech/numerics/estimate.hpp>

namespace YAML {
class Node;
}

/// Reads configuration files strictly: every field by name and unit, every mistake with file and line.
namespace talus::terramech {

/// A word of a file as a message shows it: its first forty bytes.
std::string shortened(const std::string& word);

/// One mapping of a YAML file. A field is read by its name with SI unit suffix (`cohesion_Pa`); the file
/// may state it in another unit of the same kind (`cohesion_kPa`), which is converted. only() refuses names
/// that are not known and names the nearest that is. Every error is an InputError with file and line.
///
/// Units, by kind: rad deg | Pa hPa kPa MPa | N kN mN | m mm cm dm km | Nm mNm Ncm kNm | mps mmps cmps kmph |
/// kg g t | s ms min h | W mW kW | J kJ MJ Wh | m_s2 g0 | kg_m3 g_cm3 | rad_s deg_s. Names without a suffix
/// are dimensionless, but for pressure-sinkage moduli in N/m^(n+1) and N/m^(n+2) (`.._modulus`), which take
/// _N _kN _MN _Pa _kPa _MPa as a factor.
class YamlFields {
 public:
  /// The root mapping of a file. Throws InputError when it cannot be read, is not YAML, or not a mapping.
  static YamlFields file(const std::string& path);

  /// The root mapping of a text that is no file; `origin` stands for the path in messages.
  static YamlFields text(const std::string& yaml, const std::string& origin);

  /// Refuses any name but these, in whatever unit, and names the nearest. Call it first: a misspelt name is
  /// then told before the one that it leaves missing.
  void only(const std::vector<std::string>& known) const;

  bool has(const std::string& name) const;

  double number(const std::string& name) const;
  double number(const std::string& name, double fallback) const;
  Estimate stated(const std::string& name) const;  ///< a number (std 0) or {mean, std} with std > 0
  Estimate stated(const std::string& name, double fallback) const;
  int integer(const std::string& name) const;
  int integer(const std::string& name, int fallback) const;
  bool flag(const std::string& name, bool fallback) const;
  std::string word(const std::string& name) const;
  std::string word(const std::string& name, const std::string& fallback) const;
  std::vector<double> numbers(const std::string& name) const;  ///< a list; empty when absent

  /// A list of texts, or a text alone; a list in the list becomes one text, its items parted by commas. Empty
  /// when absent.
  std::vector<std::string> texts(const std::string& name) const;

  /// The mapping under a name; throws when absent or no mapping.
  YamlFields fields(const std::string& name) const;
  /// The mappings of the list under a name; empty when absent.
  std::vector<YamlFields> list(const std::string& name) const;
  /// Whether the value under a name is a mapping.
  bool isMapping(const std::string& name) const;
  /// All names in the file's order.
  std::vector<std::string> names() const;

  /// Throws InputError at the line of a name, or of the mapping when the name is empty or absent.
  [[noreturn]] void refuse(const std::string& name, const std::string& reason,
                           const std::string& remedy) const;
  /// Turns a range error whose text is "owner: field = value, must be bound" into an InputError at the
  /// field's line.
  [[noreturn]] void refuse(const std::exception& range_error) const;

  /// "path:line" of a name, or of the mapping.
  std::string where(const std::string& name = "") const;

 private:
  struct State;
  explicit YamlFields(std::shared_ptr<State> state) : state_(std::move(state)) {}
  static YamlFields of(const YAML::Node& node, const std::string& origin, const std::string& what);

  std::shared_ptr<State> state_;
};

}  // namespace talus::terramech
