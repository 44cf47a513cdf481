#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <stop_token>
#include <unordered_map>

#include <talus/planner/planner.hpp>

namespace talus::planner {

/// Session of the C interface: a map with its planner and latest route. The mutex `work` is
/// locked while a call reads or changes the session.
struct Session {
  explicit Session(Map built, Planner own = Planner()) : map(std::move(built)), planner(std::move(own)) {}

  Map map;
  Planner planner;
  Route route;
  std::mutex work;

  /// Returns the stop token of a plan that begins now.
  std::stop_token begin();
  /// Requests a stop of the plan that is running, if any.
  void cancel();
  /// Requests a stop of the plan that is running and of all later plans.
  void end();

 private:
  std::mutex stopping_;
  std::stop_source stop_;
  bool ended_ = false;
};

/// Sessions by number. A C program holds numbers instead of pointers, which could dangle. Thread-safe.
class Sessions {
 public:
  /// Adds a session and returns its number.
  std::uint64_t add(std::shared_ptr<Session> session);
  /// Returns the session with a number; null if the number was never used or its session was removed.
  std::shared_ptr<Session> find(std::uint64_t number) const;
  /// Removes the session of a number and returns it; null if the number is not in use.
  std::shared_ptr<Session> remove(std::uint64_t number);

 private:
  mutable std::mutex mutex_;
  std::unordered_map<std::uint64_t, std::shared_ptr<Session>> sessions_;
  std::uint64_t last_ = 0;
};

}  // namespace talus::planner
