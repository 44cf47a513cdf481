#pragma once

#include <pybind11/pybind11.h>

/// Registration functions of the Python package. Each function adds the classes and functions of one section
/// to the module.
namespace talus::planner {

void bindRoute(pybind11::module_& module);
void bindSoil(pybind11::module_& module);
void bindTrace(pybind11::module_& module);
void bindMap(pybind11::module_& module);
void bindSimulation(pybind11::module_& module);

}  // namespace talus::planner
