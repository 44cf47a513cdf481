// A stand-in of our own for tests: a class that could be loaded.
#pragma once

#include <type_traits>

#define PLUGINLIB_EXPORT_CLASS(Class, Base)              \
  static_assert(std::is_base_of_v<Base, Class>);         \
  static_assert(std::is_default_constructible_v<Class>); \
  static_assert(!std::is_abstract_v<Class>);
