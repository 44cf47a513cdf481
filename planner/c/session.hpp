#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <stop_token>
#include <unordered_map>

#include <talus/costmap/telemetry/drive_evidence.hpp>
#include <talus/planner/plugin/global_planner.hpp>

namespace talus::planner {

/// What a session of the C interface holds. `work` is held while a call changes or reads it.
struct Session {
  explicit Session(costmap::TraversabilityMap built)
      : map(std::move(built)), intake(map, nullptr, {.settles = true}) {}

  costmap::TraversabilityMap map;
  costmap::DriveIntake intake;
  std::unique_ptr<GlobalPlanner> planner;
  Route route;
  std::mutex work;

  /// A token for the plan that begins now.
  std::stop_token begin();
  /// Requests the stop of the plan that runs, if one does.
  void cancel();
  /// The same, and of every plan that begins from now on.
  void end();

 private:
  std::mutex stopping_;
  std::stop_source stop_;
  bool ended_ = false;
};

/// Sessions by number: C can hold no pointer that this side knows to be dead. Thread-safe.
class Sessions {
 public:
  std::uint64_t add(std::shared_ptr<Session> session);
  /// Null for a number that never was or is no longer.
  std::shared_ptr<Session> find(std::uint64_t number) const;
  /// Puts another session in the place of one; false, and nothing is done, where there is none.
  bool replace(std::uint64_t number, std::shared_ptr<Session> session);
  /// As find(), and forgets it.
  std::shared_ptr<Session> remove(std::uint64_t number);

 private:
  mutable std::mutex mutex_;
  std::unordered_map<std::uint64_t, std::shared_ptr<Session>> sessions_;
  std::uint64_t last_ = 0;
};

}  // namespace talus::planner
