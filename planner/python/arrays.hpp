#pragma once

#include <functional>
#include <string>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <talus/common/common.hpp>
#include <talus/maps/maps.hpp>

/// Conversion between NumPy arrays and rasters. An input array of any strides is copied once. An output array
/// is a read-only view that keeps the owner of its memory alive. `name` is the name of the argument for error
/// messages.
namespace talus::planner {

/// Placement of a two-dimensional array on the map: rows from south to north, columns from west to east.
struct Placed {
  double resolution_m = 1.0;  ///< side length of a cell, > 0
  maps::Point south_west{};   ///< south-western corner of the map
};

/// Returns the grid of a two-dimensional array at the given placement. Throws ValueError unless the array is
/// two-dimensional and not empty.
maps::Grid gridOf(const pybind11::object& array, const std::string& name, const Placed& placed);

/// Converts an array of float32 or float64 to a raster on `grid`; None gives an empty raster. Throws
/// TypeError for another dtype, and ValueError for another shape or, if `finite` is true, for an infinite
/// value. NaN is permitted.
maps::Raster<float> floatsOf(const pybind11::object& array, const std::string& name, const maps::Grid& grid,
                             bool finite = true);

/// Converts an array of uint8 or bool to a raster, under the other conditions of floatsOf().
maps::Raster<std::uint8_t> bytesOf(const pybind11::object& array, const std::string& name,
                                   const maps::Grid& grid);

/// Converts an array of float64 or float32 of shape (n, 2) with finite values to points (x, y).
std::vector<maps::Point> pointsOf(const pybind11::object& array, const std::string& name);

/// Converts an array of float64 or float32 of shape (n, 3) with any values to points (x, y, z) of a cloud.
std::vector<maps::CloudPoint> cloudOf(const pybind11::object& array, const std::string& name);

/// Returns a read-only view of memory that belongs to `owner`. `first` is the first number, `strides` are in
/// bytes.
template <typename T>
pybind11::array viewOf(const T* first, std::vector<pybind11::ssize_t> shape,
                       std::vector<pybind11::ssize_t> strides, pybind11::handle owner) {
  pybind11::array view(pybind11::dtype::of<T>(), std::move(shape), std::move(strides), first, owner);
  view.attr("setflags")(pybind11::arg("write") = false);
  return view;
}

template <typename T>
/// Returns a read-only view of the values of a raster that belongs to `owner`, row by row from the south.
pybind11::array viewOf(const maps::Raster<T>& raster, pybind11::handle owner) {
  const auto width = static_cast<pybind11::ssize_t>(raster.grid().width);
  return viewOf(
      raster.values().data(), {raster.grid().height, raster.grid().width},
      {width * static_cast<pybind11::ssize_t>(sizeof(T)), static_cast<pybind11::ssize_t>(sizeof(T))}, owner);
}

/// Calls `work` with the path of a table and its name for people. `table` is a path, or a dict of columns: arrays of one
/// dimension and equal length, of numbers (NaN: not measured) or text; its name is "columns", also in errors of `work`.
/// Throws TypeError or ValueError for other columns.
void withTable(const pybind11::object& table,
               const std::function<void(const std::string& path, const std::string& name)>& work);

/// Issues each line as a UserWarning of Python.
void warn(const std::vector<std::string>& lines);

/// Runs `work` in a separate thread without the GIL. Meanwhile the calling thread checks for Ctrl-C 20 times
/// per second and calls `progress` (may be None) with the completed share of the work, [0, 1]. Ctrl-C or an
/// exception of `progress` requests a stop of the work; the exception is rethrown after the work has ended.
/// Exceptions of the work are also rethrown.
void inBackground(const std::function<void(const ProgressMonitor&)>& work, const pybind11::object& progress);

}  // namespace talus::planner
