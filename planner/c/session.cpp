#include <utility>

#include <talus/planner/c/session.hpp>

namespace talus::planner {

std::stop_token Session::begin() {
  const std::lock_guard lock(stopping_);
  stop_ = std::stop_source();
  if (ended_) stop_.request_stop();
  return stop_.get_token();
}

void Session::cancel() {
  const std::lock_guard lock(stopping_);
  stop_.request_stop();
}

void Session::end() {
  const std::lock_guard lock(stopping_);
  ended_ = true;
  stop_.request_stop();
}

std::uint64_t Sessions::add(std::shared_ptr<Session> session) {
  const std::lock_guard lock(mutex_);
  sessions_.emplace(++last_, std::move(session));
  return last_;
}

std::shared_ptr<Session> Sessions::find(std::uint64_t number) const {
  const std::lock_guard lock(mutex_);
  const auto known = sessions_.find(number);
  return known == sessions_.end() ? nullptr : known->second;
}

std::shared_ptr<Session> Sessions::remove(std::uint64_t number) {
  const std::lock_guard lock(mutex_);
  const auto known = sessions_.find(number);
  if (known == sessions_.end()) return nullptr;
  auto session = std::move(known->second);
  sessions_.erase(known);
  return session;
}

}  // namespace talus::planner
