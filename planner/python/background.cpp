#include <atomic>
#include <chrono>
#include <future>
#include <optional>

#include <talus/planner/python/background.hpp>

namespace py = pybind11;

namespace talus::planner {

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
