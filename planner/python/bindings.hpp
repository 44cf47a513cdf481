#pragma once

#include <pybind11/pybind11.h>

#include <talus/terramech/contact/wheel_on_soil.hpp>

/// Registration functions of the Python package. Each function adds the classes and functions of one section
/// to the module.
namespace talus::planner {

/// Returns a rover or soil: the object itself, or that of the library name or YAML file.
terramech::Rover roverOf(const pybind11::handle& given);
terramech::Soil soilOf(const pybind11::handle& given);

void bindRoute(pybind11::module_& module);
void bindSoil(pybind11::module_& module);
void bindTrace(pybind11::module_& module);
void bindMap(pybind11::module_& module);
void bindSimulation(pybind11::module_& module);

}  // namespace talus::planner
