#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <talus/costmap/evidence/observation_fault.hpp>
#include <talus/costmap/evidence/wheel_observation.hpp>

namespace talus::costmap {
namespace observation_fault_test {

constexpr double kInf = std::numeric_limits<double>::infinity();

WheelObservation possible() {
  return {.place = {}, .pull = {0.1, 0.05}, .sinkage = {0.2, kInf}};
}

TEST(ObservationFault, ImpossibleObservationsNameTheField) {
  using O = WheelObservation;
  struct Case {
    std::function<void(O&)> change;
    const char* named;
  };
  EXPECT_EQ(fault(possible()), "");
  for (const Case& c :
       std::vector<Case>{{[](O& o) { o.pull.value = kInf; }, "pull = inf, must be finite and within 100"},
                         {[](O& o) { o.pull.value = std::nan(""); }, "pull = nan"},
                         {[](O& o) { o.pull.value = 1e300; }, "pull = "},
                         {[](O& o) { o.sinkage.value = std::nan(""); }, "sinkage = nan"},
                         {[](O& o) { o.pull.std = -1.0; }, "standard deviation"},
                         {[](O& o) { o.pull.std = std::nan(""); }, "pull_std = nan"},
                         {[](O& o) { o.place.x_m = kInf; }, "x_m = inf"},
                         {[](O& o) { o.place.y_m = std::nan(""); }, "y_m = nan"},
                         {[](O& o) { o.pose_std_m = kInf; }, "pose_std_m = inf"},
                         {[](O& o) { o.here.most_pull = kInf; }, "a bound"},
                         {[](O& o) { o.here.most_pull = 101.0; }, "a bound"},
                         {[](O& o) { o.here.least_sinkage = -0.1; }, "a bound"},
                         {[](O& o) { o.shared_std = kInf; }, "standard deviation"},
                         {[](O& o) { o.share = kInf; }, "share of the thrust"}}) {
    WheelObservation observation = possible();
    c.change(observation);
    EXPECT_NE(fault(observation).find(c.named), std::string::npos) << c.named << ": " << fault(observation);
  }
}

}  // namespace observation_fault_test
}  // namespace talus::costmap
