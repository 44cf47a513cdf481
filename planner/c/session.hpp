#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <stop_token>
#include <unordered_map>

#include <talus/costmap/telemetry/drive_evidence.hpp>
#include <talus/planner/plugin/global_planner.hpp>

namespace talus::planner {

/// Data of a session of the C interface. `work` is locked while a call reads or changes the session.
struct Session {
  explicit Session(costmap::TraversabilityMap built)
      : map(std::move(built)), intake(map, nullptr, {.settles = true}) {}

  costmap::TraversabilityMap map;
  costmap::DriveIntake intake;
  std::unique_ptr<GlobalPlanner> planner;
  Route route;
  std::mutex work;

  /// Stop token for a plan that begins now.
  std::stop_token begin();
  /// Requests a stop of the running plan, if any.
  void cancel();
  /// Requests a stop of the running plan and of every later plan.
  void end();

 private:
  std::mutex stopping_;
  std::stop_source stop_;
  bool ended_ = false;
};

/// Sessions by number, so that a C program holds no pointer that may dangle. Thread-safe.
class Sessions {
 public:
  std::uint64_t add(std::shared_ptr<Session> session);
  /// Null for a number that was never used or was removed.
  std::shared_ptr<Session> find(std::uint64_t number) const;
  /// Replaces the session of a number. Returns false, without a change, if the number is not in use.
  bool replace(std::uint64_t number, std::shared_ptr<Session> session);
  /// Returns a session as find() and removes it.
  std::shared_ptr<Session> remove(std::uint64_t number);

 private:
  mutable std::mutex mutex_;
  std::unordered_map<std::uint64_t, std::shared_ptr<Session>> sessions_;
  std::uint64_t last_ = 0;
};

}  // namespace talus::planner
