#pragma once

#include <string>
#include <type_traits>
#include <vector>

#include <boost/dll/alias.hpp>

#include <talus/planner/plugin/global_planner.hpp>

namespace talus {

/// Incremented with every change of CostSource that is incompatible with older plugins or programs.
inline constexpr int kLayerInterfaceVersion = 1;

/// A cost layer from an external source, such as shadow, radio or hazards: see costmap::CostLayer.
class CostSource {
 public:
  virtual ~CostSource() = default;

  /// Additional cost [J/m] of each cell of a grid, row by row from the south-west: 0 to 1e6; infinite: must not be entered;
  /// NaN: unknown. A place has the same value on every grid: a large map is computed window by window.
  virtual std::vector<float> over(const maps::Grid& grid) const = 0;
};

}  // namespace talus

/// Exports a planner from a shared library. Use once, in one source file, at namespace scope. `Type` is
/// derived from talus::GlobalPlanner only and is default constructible without throwing. Symbols:
/// talus_planner, the prototype object; talus_planner_interface, the interface version.
#define TALUS_EXPORT_PLANNER(Type)                                                        \
  namespace talus::plugin_export {                                                        \
  static_assert(std::is_base_of_v<talus::GlobalPlanner, Type>, "not a GlobalPlanner");    \
  static_assert(std::is_nothrow_default_constructible_v<Type>, "its constructor throws"); \
  Type prototype;                                                                         \
  extern const int interface_version;                                                     \
  const int interface_version = talus::kPlannerInterfaceVersion;                          \
  }                                                                                       \
  BOOST_DLL_ALIAS(talus::plugin_export::prototype, talus_planner)                         \
  BOOST_DLL_ALIAS(talus::plugin_export::interface_version, talus_planner_interface)

/// Exports a layer: `Type` is derived from talus::CostSource only. Symbols: talus_layer,
/// talus_layer_interface.
#define TALUS_EXPORT_LAYER(Type)                                                          \
  namespace talus::layer_export {                                                         \
  static_assert(std::is_base_of_v<talus::CostSource, Type>, "not a CostSource");          \
  static_assert(std::is_nothrow_default_constructible_v<Type>, "its constructor throws"); \
  Type layer;                                                                             \
  extern const int interface_version;                                                     \
  const int interface_version = talus::kLayerInterfaceVersion;                            \
  }                                                                                       \
  BOOST_DLL_ALIAS(talus::layer_export::layer, talus_layer)                                \
  BOOST_DLL_ALIAS(talus::layer_export::interface_version, talus_layer_interface)
