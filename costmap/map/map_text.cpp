#include <array>
#include <charconv>
#include <map>
#include <sstream>
#include <type_traits>
#include <utility>
#include <vector>

#include <talus/common/common.hpp>
#include <talus/costmap/map/map_text.hpp>

namespace talus::costmap {
namespace {

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\n')
      out += "\\n";
    else if (c == '\\')
      out += "\\\\";
    else
      out += c;
  }
  return out;
}

std::string unescaped(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool escape = text[i] == '\\' && i + 1 < text.size();
    out += !escape ? text[i] : text[++i] == 'n' ? '\n' : text[i];
  }
  return out;
}

class Writer {
 public:
  template <typename T>
  void operator()(const std::string& name, const T& value) {
    lines_ += name + ' ' + text(value) + '\n';
  }
  template <typename T>
  void added(const std::string& name, const T& value) {
    (*this)(name, value);
  }
  template <typename T>
  void count(const std::string& name, const std::vector<T>& list, std::size_t = 0) {
    if (!list.empty()) (*this)(name, list.size());
  }
  /// Writes a flag only if true, so that files without the flag are unchanged.
  void flag(const std::string& name, bool value) {
    if (value) (*this)(name, value);
  }
  std::string take() { return std::move(lines_); }

 private:
  static std::string text(const std::string& value) { return escaped(value); }
  template <typename T>
  static std::string text(const T& value) {
    if constexpr (std::is_same_v<T, bool>)
      return value ? "1" : "0";
    else if constexpr (std::is_enum_v<T>)
      return std::to_string(static_cast<int>(value));
    else {
      std::array<char, 40> digits{};
      return {digits.data(), std::to_chars(digits.begin(), digits.end(), value).ptr};
    }
  }

  std::string lines_;
};

class Reader {
 public:
  Reader(const std::string& lines, std::string name) : name_(std::move(name)) {
    std::istringstream stream(lines);
    for (std::string line; std::getline(stream, line);) {
      const auto blank = line.find(' ');
      if (blank == std::string::npos) fail("line '" + line + "' has no value");
      values_[line.substr(0, blank)] = line.substr(blank + 1);
    }
  }

  template <typename T>
  void operator()(const std::string& name, T& value) {
    const auto found = values_.find(name);
    if (found == values_.end()) fail("'" + name + "' is missing");
    read(found->first, found->second, value);
    values_.erase(found);
  }

  /// Reads an optional value; `value` is unchanged for an older map without the line.
  template <typename T>
  void added(const std::string& name, T& value) {
    if (values_.contains(name)) (*this)(name, value);
  }

  /// Reads the length of a list; 0 if the line is missing.
  template <typename T>
  void count(const std::string& name, std::vector<T>& list, std::size_t most = 1000) {
    std::size_t size = 0;
    if (values_.contains(name)) (*this)(name, size);
    if (size > most) fail("'" + name + "' is " + std::to_string(size));
    list.resize(size);
  }

  void flag(const std::string& name, bool& value) {
    if (values_.contains(name)) (*this)(name, value);
  }

  void done() const {
    if (!values_.empty()) fail("'" + values_.begin()->first + "' is unknown");
  }

 private:
  static void read(const std::string&, const std::string& text, std::string& value) {
    value = unescaped(text);
  }
  template <typename T>
  void read(const std::string& name, const std::string& text, T& value) const {
    if constexpr (std::is_same_v<T, bool>)
      value = text == "1";
    else if constexpr (std::is_enum_v<T>) {
      int number = 0;
      read(name, text, number);
      value = static_cast<T>(number);
    } else {
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
      if (error != std::errc{} || end != text.data() + text.size()) fail("'" + name + "' is not a number");
    }
  }
  [[noreturn]] void fail(const std::string& reason) const {
    throw InputError(
        {name_, "damaged or from another version: " + reason, "write the map again with talus costmap"});
  }

  std::map<std::string, std::string> values_;
  std::string name_;
};

// Lists the fields once for both directions: V is Writer with const values or Reader with mutable values.
template <typename V, typename G>
void visitGrid(V& v, G& grid) {
  v("grid.width", grid.width);
  v("grid.height", grid.height);
  v("grid.resolution_m", grid.resolution_m);
  v("grid.south_west.x_m", grid.south_west.x_m);
  v("grid.south_west.y_m", grid.south_west.y_m);
}

template <typename V, typename S>
void visitCoordinates(V& v, S& system) {
  v("crs.name", system.name);
  v("crs.equatorial_radius_m", system.ellipsoid.equatorial_radius_m);
  v("crs.flattening", system.ellipsoid.flattening);
  auto& p = system.projection;
  v("crs.method", p.method);
  v("crs.latitude_of_origin_rad", p.latitude_of_origin_rad);
  v("crs.central_meridian_rad", p.central_meridian_rad);
  v("crs.standard_parallel_1_rad", p.standard_parallel_1_rad);
  v("crs.standard_parallel_2_rad", p.standard_parallel_2_rad);
  v("crs.scale", p.scale);
  v("crs.false_easting_m", p.false_easting_m);
  v("crs.false_northing_m", p.false_northing_m);
  v.flag("crs.planetocentric", system.planetocentric);
  v("crs.wkt", system.wkt);
}

template <typename V, typename R>
void visitRover(V& v, R& rover) {
  v("rover.name", rover.name);
  v("rover.mass_kg", rover.mass_kg);
  v("rover.gravity_m_s2", rover.gravity_m_s2);
  v("rover.wheel_count", rover.wheel_count);
  v("rover.wheel.radius_m", rover.wheel.radius_m);
  v("rover.wheel.width_m", rover.wheel.width_m);
  v("rover.wheel.grouser_height_m", rover.wheel.grouser_height_m);
  v("rover.wheel.grouser_count", rover.wheel.grouser_count);
  v.added("rover.wheel.lug_thrust", rover.wheel.lug_thrust);
  v("rover.wheelbase_m", rover.wheelbase_m);
  v("rover.track_m", rover.track_m);
  v("rover.clearance_m", rover.clearance_m);
  v("rover.centre_of_mass_height_m", rover.centre_of_mass_height_m);
  v.added("rover.centre_of_mass_ahead_m", rover.centre_of_mass_ahead_m);
  v.added("rover.centre_of_mass_left_m", rover.centre_of_mass_left_m);
  v("rover.max_pitch_rad", rover.max_pitch_rad);
  v("rover.max_roll_rad", rover.max_roll_rad);
  v("rover.max_torque_Nm", rover.max_torque_Nm);
  v("rover.max_speed_mps", rover.max_speed_mps);
  v("rover.turning_radius_m", rover.turning_radius_m);
  v("rover.hotel_power_W", rover.hotel_power_W);
  v("rover.steering", rover.steering);
}

template <typename V, typename L>
void visitNumbers(V& v, L& numbers, const std::string& name) {
  v.count(name, numbers);
  for (std::size_t k = 0; k < numbers.size(); ++k) v(name + '.' + std::to_string(k), numbers[k]);
}

template <typename V, typename E>
void visitEffect(V& v, E& effect, const std::string& at) {
  v(at + "name", effect.name);
  v(at + "covariate", effect.covariate);
  v(at + "channel", effect.channel);
  visitNumbers(v, effect.parameters, at + "parameters");
  visitNumbers(v, effect.knots, at + "knots");
  v(at + "only_column", effect.only_column);
  v(at + "only_value", effect.only_value);
}

template <typename V, typename C>
void visitClass(V& v, C& c, const std::string& at) {
  v(at + "number", c.number);
  v(at + "pull_std", c.pull_std);
  v(at + "mean_std", c.mean_std);
  v(at + "sinkage_std", c.sinkage_std);
  auto& soil = c.soil;
  v(at + "soil.name", soil.name);
  v(at + "soil.cohesion_Pa", soil.cohesion_Pa);
  v(at + "soil.friction_angle_rad", soil.friction_angle_rad);
  v(at + "soil.sinkage_exponent", soil.sinkage_exponent);
  v(at + "soil.cohesive_modulus", soil.cohesive_modulus);
  v(at + "soil.frictional_modulus", soil.frictional_modulus);
  v(at + "soil.shear_modulus_m", soil.shear_modulus_m);
  v(at + "soil.c1", soil.c1);
  v(at + "soil.c2", soil.c2);
  v(at + "soil.density_kg_m3", soil.density_kg_m3);
  v.added(at + "soil.slip_sinkage_exponent", soil.slip_sinkage_exponent);
  v.added(at + "soil.digging_exponent", soil.digging_exponent);
  v.added(at + "soil.side_bulldozing", soil.side_bulldozing);
  v.added(at + "soil.rut_stiffness", soil.rut_stiffness);
  v.added(at + "rut_stiffness_std", c.rut_stiffness_std);
  v.count(at + "effects", c.effects);
  for (std::size_t k = 0; k < c.effects.size(); ++k)
    visitEffect(v, c.effects[k], at + "effect." + std::to_string(k) + '.');
}

template <typename V, typename P>
void visitPolicy(V& v, P& policy) {
  v("policy.allow_marginal", policy.allow_marginal);
  v("policy.allow_dangerous", policy.allow_dangerous);
  v("policy.allow_unknown", policy.allow_unknown);
  v("policy.slope_margin_rad", policy.slope_margin_rad);
  v("policy.sinkage_threshold", policy.sinkage_threshold);
  v("policy.sinkage_critical", policy.sinkage_critical);
  v("policy.max_immobilisation", policy.max_immobilisation);
  v.added("policy.pose_error_m", policy.pose_error_m);
  v("policy.time_weight_W", policy.time_weight_W);
  v("policy.entrapment", policy.entrapment);
  v.added("policy.unmonitored_entrapment", policy.unmonitored_entrapment);
  v.added("policy.unmonitored", policy.unmonitored);
  v("policy.risk_weight_J", policy.risk_weight_J);
  v("policy.correlation_length_m", policy.correlation_length_m);
}

template <typename V, typename R>
void visitRefused(V& v, R& refused) {
  constexpr std::size_t kMost = 1'000'000;
  v.count("refused", refused, kMost);
  for (std::size_t k = 0; k < refused.size(); ++k) {
    const std::string at = "refused." + std::to_string(k) + '.';
    v(at + "x_m", refused[k].place.x_m);
    v(at + "y_m", refused[k].place.y_m);
    v(at + "radius_m", refused[k].radius_m);
    v.added(at + "drive", refused[k].drive);
  }
}

template <typename V, typename F>
void visitFiles(V& v, F& files) {
  v.count("files", files);
  for (std::size_t k = 0; k < files.size(); ++k) {
    const std::string at = "file." + std::to_string(k) + '.';
    v(at + "path", files[k].path);
    v(at + "role", files[k].role);
    v(at + "size", files[k].size);
    v(at + "sha256", files[k].sha256);
    v(at + "used", files[k].used);
  }
}

std::string classPrefix(std::size_t i) {
  return "class." + std::to_string(i) + ".";
}

}  // namespace

std::string written(const MapText& text) {
  Writer v;
  visitGrid(v, text.grid);
  v("source", text.source);
  v.added("reading", text.reading);
  visitFiles(v, text.files);
  v("footprint_radius_m", text.footprint_radius_m);
  v("crs", text.coordinate_system.has_value());
  if (text.coordinate_system) visitCoordinates(v, *text.coordinate_system);
  visitRover(v, text.ground.rover);
  visitPolicy(v, text.ground.policy);
  v("classes", text.ground.classes.size());
  for (std::size_t i = 0; i < text.ground.classes.size(); ++i)
    visitClass(v, text.ground.classes[i], classPrefix(i));
  visitRefused(v, text.refused);
  return v.take();
}

MapText parsed(const std::string& lines, const std::string& name) {
  Reader v(lines, name);
  MapText text;
  visitGrid(v, text.grid);
  v("source", text.source);
  v.added("reading", text.reading);
  visitFiles(v, text.files);
  v("footprint_radius_m", text.footprint_radius_m);
  bool has_crs = false;
  v("crs", has_crs);
  if (has_crs) visitCoordinates(v, text.coordinate_system.emplace());
  visitRover(v, text.ground.rover);
  visitPolicy(v, text.ground.policy);
  std::size_t classes = 0;
  v("classes", classes);
  if (classes > 254)
    throw InputError({name, "damaged: " + std::to_string(classes) + " classes", "write the map again"});
  text.ground.classes.resize(classes);
  for (std::size_t i = 0; i < classes; ++i) visitClass(v, text.ground.classes[i], classPrefix(i));
  visitRefused(v, text.refused);
  v.done();
  return text;
}

}  // namespace talus::costmap
