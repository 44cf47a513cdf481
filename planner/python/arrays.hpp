#pragma once

#include <string>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <talus/maps/grid/grid.hpp>
#include <talus/maps/grid/point_heights.hpp>

/// Conversion between NumPy arrays and rasters. Input is copied once, from any strides; output is a read-only
/// view that keeps its owner alive.
namespace talus::planner {

/// Placement of a two-dimensional array: rows south to north, columns west to east.
struct Placed {
  double resolution_m = 1.0;
  maps::Point south_west{};
};

/// Grid of the array. Throws ValueError unless the array is two-dimensional and not empty.
maps::Grid gridOf(const pybind11::object& array, const std::string& name, const Placed& placed);

/// Raster from float32 or float64. Throws TypeError for another dtype, and ValueError for another shape or,
/// if `finite`, an infinite value; NaN is kept. None gives an empty raster.
maps::Raster<float> floatsOf(const pybind11::object& array, const std::string& name, const maps::Grid& grid,
                             bool finite = true);

/// Raster from uint8 or bool; otherwise as floatsOf().
maps::Raster<std::uint8_t> bytesOf(const pybind11::object& array, const std::string& name,
                                   const maps::Grid& grid);

/// Returns the places from float64 or float32 of shape (n, 2); must be finite.
std::vector<maps::Point> pointsOf(const pybind11::object& array, const std::string& name);

/// Returns the points of a cloud from float64 or float32 of shape (n, 3), any values.
std::vector<maps::CloudPoint> cloudOf(const pybind11::object& array, const std::string& name);

/// Read-only view of numbers at the given strides [bytes] in memory of `owner`.
template <typename T>
pybind11::array viewOf(const T* first, std::vector<pybind11::ssize_t> shape,
                       std::vector<pybind11::ssize_t> strides, pybind11::handle owner) {
  pybind11::array view(pybind11::dtype::of<T>(), std::move(shape), std::move(strides), first, owner);
  view.attr("setflags")(pybind11::arg("write") = false);
  return view;
}

template <typename T>
pybind11::array viewOf(const maps::Raster<T>& raster, pybind11::handle owner) {
  const auto width = static_cast<pybind11::ssize_t>(raster.grid().width);
  return viewOf(
      raster.values().data(), {raster.grid().height, raster.grid().width},
      {width * static_cast<pybind11::ssize_t>(sizeof(T)), static_cast<pybind11::ssize_t>(sizeof(T))}, owner);
}

}  // namespace talus::planner
