#include <talus/common/constants.hpp>
#include <talus/terramech/io/unit.hpp>

namespace talus::terramech {
namespace {

/// Unit, its kind, and the factor to the SI unit of the kind.
struct Unit {
  std::string_view name;
  char kind;
  double factor;
};

constexpr Unit kUnits[] = {
    {"rad", 'a', 1.0},   {"deg", 'a', kDegree},                                            // angle
    {"Pa", 'p', 1.0},    {"hPa", 'p', 1e2},       {"kPa", 'p', 1e3},   {"MPa", 'p', 1e6},  // pressure
    {"N", 'f', 1.0},     {"mN", 'f', 1e-3},       {"kN", 'f', 1e3},                        // force
    {"m", 'l', 1.0},     {"mm", 'l', 1e-3},       {"cm", 'l', 1e-2},   {"dm", 'l', 0.1},
    {"km", 'l', 1e3},    {"Nm", 't', 1.0},        {"mNm", 't', 1e-3},  {"Ncm", 't', 1e-2},
    {"kNm", 't', 1e3},                                                                            // torque
    {"mps", 'v', 1.0},   {"mmps", 'v', 1e-3},     {"cmps", 'v', 1e-2}, {"kmph", 'v', 1.0 / 3.6},  // speed
    {"m_s", 'v', 1.0},   {"mm_s", 'v', 1e-3},     {"cm_s", 'v', 1e-2}, {"km_h", 'v', 1.0 / 3.6},
    {"kg", 'm', 1.0},    {"g", 'm', 1e-3},        {"t", 'm', 1e3},  // mass
    {"s", 's', 1.0},     {"ms", 's', 1e-3},       {"us", 's', 1e-6},   {"ns", 's', 1e-9},
    {"min", 's', 60.0},  {"h", 's', 3600.0},                                                 // time
    {"W", 'w', 1.0},     {"mW", 'w', 1e-3},       {"kW", 'w', 1e3},                          // power
    {"J", 'e', 1.0},     {"kJ", 'e', 1e3},        {"MJ", 'e', 1e6},    {"Wh", 'e', 3600.0},  // energy
    {"m_s2", 'g', 1.0},  {"g0", 'g', 9.80665},                                               // acceleration
    {"kg_m3", 'd', 1.0}, {"g_cm3", 'd', 1e3},     {"t_m3", 'd', 1e3},                        // density
    {"rad_s", 'o', 1.0}, {"deg_s", 'o', kDegree},                                            // turning rate
};

const Unit* find(std::string_view name) {
  for (const Unit& unit : kUnits)
    if (unit.name == name) return &unit;
  return nullptr;
}

}  // namespace

std::optional<double> conversion(std::string_view from, std::string_view to) {
  const Unit *a = find(from), *b = find(to);
  if (!a || !b || a->kind != b->kind) return std::nullopt;
  return a->factor / b->factor;
}

std::string unitsLike(std::string_view unit) {
  std::string names;
  if (const Unit* known = find(unit))
    for (const Unit& one : kUnits)
      if (one.kind == known->kind) names += (names.empty() ? "" : ", ") + std::string(one.name);
  return names;
}

std::string_view unitOf(std::string_view name) {
  std::string_view longest;
  for (const Unit& unit : kUnits) {
    const std::size_t n = unit.name.size();
    if (name.size() > n + 1 && name.ends_with(unit.name) && name[name.size() - n - 1] == '_' &&
        n > longest.size())
      longest = unit.name;
  }
  return longest;
}

}  // namespace talus::terramech
