#include <talus/terramech/trace/held_out.hpp>

#include "traced_world.hpp"

namespace talus::terramech {
namespace {

TEST(HeldOut, WholeBandsAreHeldOut) {
  const blind::World world = blind::makeWorld({.seed = 10, .effects = 1, .library = true});
  const TraceResult result = traced(world);
  const HeldOut& held = result.held_out;
  EXPECT_FALSE(held.scheme.empty());
  EXPECT_LT(held.refined_rmse[1], held.base_rmse[1]);
}

}  // namespace
}  // namespace talus::terramech
