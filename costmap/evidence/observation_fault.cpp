#include <cmath>
#include <cstdint>
#include <string>

#include <talus/costmap/evidence/observation_fault.hpp>
#include <talus/costmap/evidence/wheel_observation.hpp>

namespace talus::costmap {
namespace {

// Limits beyond any wheel: pull over load and sinkage over radius of 100.
constexpr double kGreatestShare = 100.0;
constexpr double kGreatestPlace_m = 1e9;

std::string outside(const char* name, double value, double bound) {
  if (std::abs(value) <= bound) return "";
  return std::string(name) + " = " + std::to_string(value) + ", must be finite and within " +
         std::to_string(static_cast<std::int64_t>(bound));
}

}  // namespace

std::string fault(const WheelObservation& o) {
  const bool bounds_alone = o.here.any() && std::isnan(o.pull.value) && std::isnan(o.pull.std) &&
                            std::isnan(o.sinkage.value) && std::isnan(o.sinkage.std);
  if (!bounds_alone)
    for (const std::string& reason :
         {outside("pull", o.pull.value, kGreatestShare), outside("pull_std", o.pull.std, kGreatestShare),
          outside("sinkage", o.sinkage.value, kGreatestShare)})
      if (!reason.empty()) return reason;
  if (std::abs(o.here.most_pull) > kGreatestShare || o.here.least_sinkage < 0.0 ||
      o.here.least_sinkage > kGreatestShare)
    return "a bound is not finite and within 100";
  for (const std::string& reason :
       {outside("x_m", o.place.x_m, kGreatestPlace_m), outside("y_m", o.place.y_m, kGreatestPlace_m),
        outside("pose_std_m", o.pose_std_m, kGreatestPlace_m)})
    if (!reason.empty()) return reason;
  // An infinite standard deviation means that no sinkage was measured.
  if (!(o.pose_std_m >= 0.0) || (!bounds_alone && (!(o.pull.std >= 0.0) || !(o.sinkage.std >= 0.0))))
    return "a standard deviation is below 0 or missing";
  if (o.shared_std < 0.0 || std::isinf(o.shared_std)) return "a standard deviation is below 0 or infinite";
  if (std::isinf(o.share)) return "the share of the thrust is infinite";
  if (std::isinf(o.time_s)) return "time_s is infinite";
  return "";
}

}  // namespace talus::costmap
