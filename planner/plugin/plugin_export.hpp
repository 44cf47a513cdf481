#pragma once

#include <string>
#include <type_traits>
#include <vector>

#include <boost/dll/alias.hpp>

#include <talus/planner/plugin/global_planner.hpp>

namespace talus {

/// Version of the interface CostSource. The number increases with every change that is incompatible with
/// older plugins or programs.
inline constexpr int kLayerInterfaceVersion = 1;

/// Source of a cost layer from outside Talus, such as shadow, radio coverage or hazards; see
/// costmap::CostLayer.
class CostSource {
 public:
  virtual ~CostSource() = default;

  /// Returns the additional cost per metre [J/m] of each cell of `grid`, row by row from the south-west
  /// corner. A value is 0 to 1e6; infinite: the rover must not enter the cell; NaN: unknown. The value at a
  /// position must not depend on the grid, because large maps are computed window by window.
  virtual std::vector<float> over(const maps::Grid& grid) const = 0;
};

}  // namespace talus

/// Exports a planner from a shared library. Use the macro once, in one source file, at namespace scope.
/// `Type` is derived from talus::GlobalPlanner only, and its default constructor does not throw. The exported
/// symbols are talus_planner (the prototype object) and talus_planner_interface (the interface version).
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

/// Exports a cost layer from a shared library. `Type` is derived from talus::CostSource only, and its default
/// constructor does not throw. The exported symbols are talus_layer and talus_layer_interface.
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
