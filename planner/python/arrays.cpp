#include <atomic>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <future>
#include <optional>

#include <fmt/format.h>
#include <pybind11/stl/filesystem.h>
#include <sys/mman.h>
#include <unistd.h>

#include <talus/common/common.hpp>
#include <talus/planner/python/arrays.hpp>
#include <talus/terramech/io/csv_reader.hpp>

namespace py = pybind11;

namespace talus::planner {
namespace {

py::array arrayOf(const py::object& given, const std::string& name) {
  if (!py::isinstance<py::array>(given))
    throw py::type_error(name + ": " + std::string(py::str(py::type::of(given).attr("__name__"))) +
                         ", must be a numpy array");
  return py::reinterpret_borrow<py::array>(given);
}

std::string shapeOf(const py::array& array) {
  return std::string(py::str(array.attr("shape")));
}

[[noreturn]] void wrongType(const py::array& array, const std::string& name, const std::string& wanted) {
  throw py::type_error(name + ": dtype " + std::string(py::str(array.dtype())) + ", must be " + wanted);
}

py::array onGrid(const py::object& given, const std::string& name, const maps::Grid& grid) {
  py::array array = arrayOf(given, name);
  if (array.ndim() != 2 || array.shape(0) != grid.height || array.shape(1) != grid.width)
    throw py::value_error(name + ": shape " + shapeOf(array) + ", must be (" + std::to_string(grid.height) +
                          ", " + std::to_string(grid.width) + ")");
  return array;
}

template <typename From, typename To, typename Check>
maps::Raster<To> copied(const py::array& array, const maps::Grid& grid, const Check& check) {
  const auto values = py::array_t<From>(array).template unchecked<2>();
  maps::Raster<To> out(grid);
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      const auto value = static_cast<To>(values(row, column));
      check(value, row, column);
      out[{column, row}] = value;
    }
  return out;
}

template <typename T>
bool holds(const py::array& array) {
  return array.dtype().equal(py::dtype::of<T>());
}

py::array_t<double> rowsOf(const py::object& given, const std::string& name, int columns) {
  const py::array array = arrayOf(given, name);
  if (array.ndim() != 2 || array.shape(1) != columns)
    throw py::value_error(name + ": shape " + shapeOf(array) + ", must be (n, " + std::to_string(columns) +
                          ")");
  if (!holds<double>(array) && !holds<float>(array)) wrongType(array, name, "float32 or float64");
  return py::array_t<double>(array);
}

// A column of a table as text: numbers with 17 digits, which restore a double, and nothing for NaN (not measured).
std::vector<std::string> textsOf(const std::string& column, const py::handle& given) {
  if (!py::isinstance<py::array>(given) || given.cast<py::array>().ndim() != 1)
    throw py::type_error("column '" + column + "' must be a numpy array of one dimension");
  const auto array = given.cast<py::array>();
  const char kind = array.dtype().kind();
  std::vector<std::string> texts;
  if (kind == 'U') {
    for (const py::handle text : array.attr("tolist")())
      texts.push_back(terramech::csvField(text.cast<std::string>()));
    return texts;
  }
  if (kind != 'f' && kind != 'i' && kind != 'u')
    throw py::type_error("column '" + column + "': dtype " + std::string(py::str(array.dtype())) +
                         ", must be a number or text");
  const py::array_t<double> numbers(array);
  for (py::ssize_t row = 0; row < numbers.size(); ++row) {
    const double value = numbers.unchecked<1>()(row);
    texts.push_back(std::isnan(value) ? "" : fmt::format("{:.17g}", value));
  }
  return texts;
}

// A file in memory.
class MemoryFile {
 public:
  MemoryFile() : descriptor_(::memfd_create("columns", MFD_CLOEXEC)) {}
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  ~MemoryFile() { ::close(descriptor_); }
  std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

void writeColumns(const py::dict& columns, const std::string& path) {
  std::vector<std::vector<std::string>> texts;
  std::ofstream out(path);
  for (const auto& [name, values] : columns) {
    const std::string column = py::str(name);
    texts.push_back(textsOf(column, values));
    if (texts.back().size() != texts.front().size())
      throw py::value_error("column '" + column + "' has " + std::to_string(texts.back().size()) +
                            " values, must be " + std::to_string(texts.front().size()) + " as the first");
    out << (texts.size() > 1 ? "," : "") << terramech::csvField(column);
  }
  for (std::size_t row = 0; !texts.empty() && row < texts.front().size(); ++row)
    for (std::size_t k = 0; k < texts.size(); ++k) out << (k == 0 ? '\n' : ',') << texts[k][row];
  out << '\n';
  out.close();
  if (!out) throw std::runtime_error("no memory for the columns");
}

}  // namespace

maps::Grid gridOf(const py::object& given, const std::string& name, const Placed& placed) {
  const py::array array = arrayOf(given, name);
  if (array.ndim() != 2 || array.size() == 0 || array.shape(0) > 65536 || array.shape(1) > 65536)
    throw py::value_error(name + ": shape " + shapeOf(array) +
                          ", must be (rows, columns) of 1 to 65536 each");
  if (!(placed.resolution_m > 0.0) || !std::isfinite(placed.resolution_m))
    throw py::value_error("resolution_m = " + std::to_string(placed.resolution_m) + ", must be > 0");
  if (!std::isfinite(placed.south_west.x_m) || !std::isfinite(placed.south_west.y_m))
    throw py::value_error("south_west must be finite");
  return {.width = static_cast<int>(array.shape(1)),
          .height = static_cast<int>(array.shape(0)),
          .resolution_m = placed.resolution_m,
          .south_west = placed.south_west};
}

maps::Raster<float> floatsOf(const py::object& given, const std::string& name, const maps::Grid& grid,
                             bool finite) {
  if (given.is_none()) return {};
  const py::array array = onGrid(given, name, grid);
  const auto check = [&](float value, int row, int column) {
    if (finite && std::isinf(value))
      throw py::value_error(name + "[" + std::to_string(row) + ", " + std::to_string(column) +
                            "] is infinite, must be finite or NaN (not observed)");
  };
  if (holds<float>(array)) return copied<float, float>(array, grid, check);
  if (holds<double>(array)) return copied<double, float>(array, grid, check);
  wrongType(array, name, "float32 or float64");
}

maps::Raster<std::uint8_t> bytesOf(const py::object& given, const std::string& name, const maps::Grid& grid) {
  if (given.is_none()) return {};
  const py::array array = onGrid(given, name, grid);
  const auto any = [](std::uint8_t, int, int) {};
  if (holds<std::uint8_t>(array)) return copied<std::uint8_t, std::uint8_t>(array, grid, any);
  if (holds<bool>(array)) return copied<bool, std::uint8_t>(array, grid, any);
  wrongType(array, name, "uint8 or bool");
}

std::vector<maps::CloudPoint> cloudOf(const py::object& given, const std::string& name) {
  const py::array_t<double> array = rowsOf(given, name, 3);
  const auto values = array.unchecked<2>();
  std::vector<maps::CloudPoint> points;
  for (py::ssize_t i = 0; i < values.shape(0); ++i)
    points.push_back({values(i, 0), values(i, 1), values(i, 2)});
  return points;
}

std::vector<maps::Point> pointsOf(const py::object& given, const std::string& name) {
  const py::array_t<double> array = rowsOf(given, name, 2);
  const auto values = array.unchecked<2>();
  std::vector<maps::Point> points;
  for (py::ssize_t i = 0; i < values.shape(0); ++i) {
    points.push_back({values(i, 0), values(i, 1)});
    if (!std::isfinite(points.back().x_m) || !std::isfinite(points.back().y_m))
      throw py::value_error(name + "[" + std::to_string(i) + "] is not finite");
  }
  return points;
}

void withTable(const py::object& given,
               const std::function<void(const std::string&, const std::string&)>& work) {
  if (!py::isinstance<py::dict>(given)) {
    const std::string path = given.cast<std::filesystem::path>().string();
    return work(path, path);
  }
  const MemoryFile file;
  writeColumns(given.cast<py::dict>(), file.path());
  const auto named = [&file](std::string text) {
    if (const auto at = text.find(file.path()); at != std::string::npos)
      text.replace(at, file.path().size(), "columns");
    return text;
  };
  try {
    work(file.path(), "columns");
  } catch (const InputError& error) {
    throw InputError({named(error.parts().where), named(error.parts().reason), error.parts().remedy});
  } catch (const std::domain_error& error) {
    throw std::domain_error(named(error.what()));
  }
}

void warn(const std::vector<std::string>& lines) {
  for (const std::string& line : lines)
    if (PyErr_WarnEx(PyExc_UserWarning, line.c_str(), 1) != 0) throw py::error_already_set();
}

void inBackground(const std::function<void(const ProgressMonitor&)>& work, const py::object& progress) {
  if (!progress.is_none() && PyCallable_Check(progress.ptr()) == 0)
    throw py::type_error("progress must be callable or None");
  constexpr std::chrono::milliseconds kLook{50};
  std::stop_source stop;
  std::atomic<double> done{0.0};
  const ProgressMonitor watch{.progress = [&done](double share) { done = share; }, .stop = stop.get_token()};
  auto running = std::async(std::launch::async, [&] { work(watch); });
  std::optional<py::error_already_set> raised;
  double reported = -1.0;
  for (;;) {
    std::future_status status{};
    {
      const py::gil_scoped_release released;
      status = running.wait_for(kLook);
    }
    if (status == std::future_status::ready) break;
    if (raised) continue;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (const double now = done; !progress.is_none() && now > reported) progress(reported = now);
    } catch (const py::error_already_set& error) {
      raised.emplace(error);
      stop.request_stop();
    }
  }
  if (raised) {
    try {
      running.get();
    } catch (const std::exception&) {  // the first exception is rethrown below
    }
    throw std::move(*raised);
  }
  running.get();
}

}  // namespace talus::planner
