#pragma once

#include <memory>
#include <mutex>
#include <stdexcept>
#include <utility>
#include <vector>

#include <talus/planner/c/session.hpp>

namespace talus::planner {

/// Map of the Python package: a session of the C interface, the settings of its planner, and the files of which it was
/// made. One thread at a time may use an object.
struct PythonMap {
  explicit PythonMap(Map built, std::vector<InputFile> from = {})
      : session(std::make_shared<Session>(std::move(built))), files(std::move(from)) {}

  const costmap::TraversabilityMap& map() const noexcept { return session->map.ground(); }

  /// Exclusive access for one call; does not wait, because the caller holds the GIL.
  std::unique_lock<std::mutex> held() const {
    std::unique_lock lock(session->work, std::try_to_lock);
    if (!lock.owns_lock())
      throw std::runtime_error("another thread works on this map; wait for it, or give each thread its own");
    return lock;
  }

  std::shared_ptr<Session> session;
  PlannerSettings settings{};
  std::vector<InputFile> files;
};

}  // namespace talus::planner
