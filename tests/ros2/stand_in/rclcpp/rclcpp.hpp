// A stand-in of our own for tests: the names that examples/ros2 uses, declared as declarations_test.cpp lists them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include <builtin_interfaces/msg/time.hpp>

enum rcl_clock_type_t { RCL_CLOCK_UNINITIALIZED = 0, RCL_ROS_TIME, RCL_SYSTEM_TIME, RCL_STEADY_TIME };

namespace rclcpp {

struct Logger {
  std::vector<std::string>* lines;
};

class Duration {
 public:
  explicit Duration(std::int64_t nanoseconds) : nanoseconds_(nanoseconds) {}
  double seconds() const { return 1e-9 * static_cast<double>(nanoseconds_); }

 private:
  std::int64_t nanoseconds_;
};

class Time {
 public:
  explicit Time(std::int64_t nanoseconds = 0, rcl_clock_type_t clock_type = RCL_SYSTEM_TIME)
      : nanoseconds_(nanoseconds), type_(clock_type) {}
  Time(const builtin_interfaces::msg::Time& time_msg, rcl_clock_type_t clock_type = RCL_ROS_TIME)
      : nanoseconds_(std::int64_t{time_msg.sec} * 1000000000 + time_msg.nanosec), type_(clock_type) {}
  operator builtin_interfaces::msg::Time() const {
    return {static_cast<std::int32_t>(nanoseconds_ / 1000000000),
            static_cast<std::uint32_t>(nanoseconds_ % 1000000000)};
  }
  Duration operator-(const Time& rhs) const { return Duration(nanoseconds_ - rhs.nanoseconds_); }
  rcl_clock_type_t get_clock_type() const { return type_; }

 private:
  std::int64_t nanoseconds_;
  rcl_clock_type_t type_;
};

class Clock {
 public:
  using SharedPtr = std::shared_ptr<Clock>;
};

class CallbackGroup {
 public:
  using SharedPtr = std::shared_ptr<CallbackGroup>;
};

class QoS {
 public:
  QoS(std::size_t history_depth) : depth(history_depth) {}
  QoS& best_effort() { return *this; }
  QoS& transient_local() { return *this; }
  std::size_t depth;
};

struct SubscriptionOptions {
  CallbackGroup::SharedPtr callback_group;
};

class SubscriptionBase {
 public:
  virtual ~SubscriptionBase() = default;
};

template <typename Message>
class Subscription : public SubscriptionBase {
 public:
  explicit Subscription(std::function<void(const Message&)> callback) : hear(std::move(callback)) {}
  std::function<void(const Message&)> hear;
};

template <typename Message>
class Publisher {
 public:
  void publish(const Message& message) { sent.push_back(message); }
  std::vector<Message> sent;
};

template <typename Message, typename Callback, typename Node>
std::shared_ptr<Subscription<Message>> create_subscription(Node& node, const std::string& topic_name,
                                                           const QoS&, Callback&& callback,
                                                           const SubscriptionOptions& = {}) {
  auto made = std::make_shared<Subscription<Message>>(std::forward<Callback>(callback));
  node.subscribers[topic_name] = made;
  return made;
}

template <typename Message, typename Node>
std::shared_ptr<Publisher<Message>> create_publisher(Node&& node, const std::string& topic_name, const QoS&) {
  auto made = std::make_shared<Publisher<Message>>();
  node.publishers[topic_name] = made;
  return made;
}

inline Logger get_logger(const std::string&) {
  return {nullptr};
}

}  // namespace rclcpp

#define RCLCPP_WARN_THROTTLE(logger, clock, duration, format, name, text) \
  (static_cast<void>(clock), (logger).lines->push_back(std::string(name) + ": " + (text)))
