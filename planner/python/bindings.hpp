#pragma once

#include <pybind11/pybind11.h>

/// Sections of the Python package; each adds its classes and functions to the module.
namespace talus::planner {

void bindRoute(pybind11::module_& module);
void bindSoil(pybind11::module_& module);
void bindTrace(pybind11::module_& module);
void bindMap(pybind11::module_& module);
void bindSimulation(pybind11::module_& module);

}  // namespace talus::planner
