#include <talus/common/common.hpp>
#include <talus/planner/python/bindings.hpp>

PYBIND11_MODULE(_talus, module) {
  module.attr("__version__") = TALUS_VERSION;
  module.doc() = "Safe routes for rovers over soft, sloping ground.";
  pybind11::register_exception<talus::InputError>(module, "InputError", PyExc_ValueError);
  talus::planner::bindSoil(module);
  talus::planner::bindTrace(module);
  talus::planner::bindRoute(module);
  talus::planner::bindMap(module);
  talus::planner::bindSimulation(module);
}
