#pragma once

#include <string>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <talus/maps/grid/grid.hpp>
#include <talus/maps/grid/point_heights.hpp>

/// Between NumPy's arrays and rasters. What comes in is copied once, from any strides; what goes out is a view that keeps
/// its owner alive and cannot be written through.
namespace talus::planner {

/// The grid that an array of two dimensions covers: rows south to north, columns west to east.
struct Placed {
  double resolution_m = 1.0;
  maps::Point south_west{};
};

/// Throws a ValueError, one line, unless it is an array of two dimensions that is not empty.
maps::Grid gridOf(const pybind11::object& array, const std::string& name, const Placed& placed);

/// Float32 or float64. Throws a TypeError for another dtype, a ValueError for another shape or an infinite value where
/// `finite`; NaN stays. None: an empty raster.
maps::Raster<float> floatsOf(const pybind11::object& array, const std::string& name, const maps::Grid& grid,
                             bool finite = true);

/// Uint8 or bool, likewise.
maps::Raster<std::uint8_t> bytesOf(const pybind11::object& array, const std::string& name,
                                   const maps::Grid& grid);

/// Places: float64 or float32 of shape (n, 2), finite.
std::vector<maps::Point> pointsOf(const pybind11::object& array, const std::string& name);

/// The points of a cloud: float64 or float32 of shape (n, 3), whatever they hold.
std::vector<maps::CloudPoint> cloudOf(const pybind11::object& array, const std::string& name);

/// A view of numbers that lie `stride` bytes apart in memory of `owner`, read-only.
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
