#include "ground.hpp"

#include <cmath>
#include <cstring>

namespace safety {
namespace {

// Appends the bytes of a trivially copyable value to a cache key.
template <typename T>
void append(std::string& key, const T& value) {
  const auto* bytes = reinterpret_cast<const char*>(&value);
  key.append(bytes, sizeof(T));
}

bool inside(const Polygon& ring, Place p) {
  bool in = false;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const Place a = ring[i], b = ring[j];
    if ((a.y_m > p.y_m) != (b.y_m > p.y_m) &&
        p.x_m < (b.x_m - a.x_m) * (p.y_m - a.y_m) / (b.y_m - a.y_m) + a.x_m)
      in = !in;
  }
  return in;
}

}  // namespace

std::optional<int> Site::classAt(Place p) const {
  const auto cell = elevation_m.cellAt(p);
  if (!cell || std::isnan(elevation_m.at(*cell))) return std::nullopt;
  const double number = classes ? classes->at(*cell) : 0.0;
  if (std::isnan(number) || !kinds.contains(static_cast<int>(number))) return std::nullopt;
  return static_cast<int>(number);
}

double Site::footprint_m() const {
  return 0.5 * std::hypot(rover.wheelbase_m, rover.track_m);
}

bool Site::keptOut(Place p) const {
  for (const Polygon& ring : keep_out)
    if (inside(ring, p)) return true;
  return false;
}

std::shared_ptr<const GroundKind> groundKind(const SoilPrior& prior, const Rover& rover) {
  static std::map<std::string, std::shared_ptr<const GroundKind>> known;
  std::string key;
  append(key, prior);
  for (const double value : {rover.wheel_radius_m, rover.wheel_width_m, rover.wheelLoad_N()})
    append(key, value);
  auto& kind = known[key];
  if (!kind)
    kind = std::make_shared<GroundKind>(GroundKind{.fresh = PullCurve(prior.mean, rover),
                                                   .rut = PullCurve(inRut(prior.mean), rover),
                                                   .class_deviation = classDeviation(prior, rover)});
  return kind;
}

}  // namespace safety
