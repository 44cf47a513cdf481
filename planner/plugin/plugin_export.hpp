#pragma once

#include <type_traits>

#include <boost/dll/alias.hpp>

#include <talus/planner/plugin/global_planner.hpp>

/// Exports a planner from a shared library: write it once, in one source file, at namespace scope.
/// `Type` is a class derived from talus::GlobalPlanner alone, default constructible without throwing.
/// Symbols: talus_planner, the prototype object; talus_planner_interface, the version it was built against.
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
