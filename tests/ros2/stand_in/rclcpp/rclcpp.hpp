// A stand-in of our own for tests: the names that examples/ros2 uses, declared as declarations_test.cpp lists them.
#pragma once

#include <any>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <thread>
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
  explicit Duration(std::chrono::nanoseconds duration) : nanoseconds_(duration.count()) {}
  static Duration from_nanoseconds(std::int64_t nanoseconds) {
    return Duration(std::chrono::nanoseconds(nanoseconds));
  }
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
  Duration operator-(const Time& rhs) const {
    return Duration::from_nanoseconds(nanoseconds_ - rhs.nanoseconds_);
  }
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

class NodeOptions {
 public:
  NodeOptions& arguments(const std::vector<std::string>& arguments) {
    given = arguments;
    return *this;
  }
  std::vector<std::string> given;
};

class TimerBase {
 public:
  std::function<void()> ring;
};

// What each class of nodes has.
class AnyNode {
 public:
  bool has_parameter(const std::string& name) const { return parameters.count(name) > 0; }
  template <typename T>
  auto declare_parameter(const std::string& name, const T& value) {
    parameters[name] = value;
    return value;
  }
  template <typename T>
  bool get_parameter(const std::string& name, T& value) const {
    value = std::any_cast<T>(parameters.at(name));
    return true;
  }
  Logger get_logger() const { return {&log}; }
  Clock::SharedPtr get_clock() { return std::make_shared<Clock>(); }
  Time now() const { return Time(clock_s * 1000000000, RCL_ROS_TIME); }

  // What tests set and read.
  std::map<std::string, std::any> parameters;
  mutable std::vector<std::string> log;
  inline static std::int64_t clock_s = 7;
};

class Node : public AnyNode {
 public:
  Node(const std::string& name, const NodeOptions&) {
    parameters = overrides;
    newest = this;
    static_cast<void>(name);
  }
  template <typename Message, typename Callback>
  std::shared_ptr<Subscription<Message>> create_subscription(const std::string& topic_name, const QoS&,
                                                             Callback&& callback) {
    auto made = std::make_shared<Subscription<Message>>(std::forward<Callback>(callback));
    subscribers[topic_name] = made;
    return made;
  }
  template <typename Message>
  std::shared_ptr<Publisher<Message>> create_publisher(const std::string& topic_name, const QoS&) {
    auto made = std::make_shared<Publisher<Message>>();
    publishers[topic_name] = made;
    return made;
  }
  template <typename Callback>
  std::shared_ptr<TimerBase> create_wall_timer(std::chrono::seconds, Callback callback) {
    timer = std::make_shared<TimerBase>();
    timer->ring = callback;
    return timer;
  }

  std::map<std::string, std::weak_ptr<SubscriptionBase>> subscribers;
  std::map<std::string, std::any> publishers;
  std::shared_ptr<TimerBase> timer;
  inline static std::map<std::string, std::any> overrides;  // parameters of the next node
  inline static Node* newest = nullptr;
};

inline bool ok() {
  return true;
}

namespace executors {
class SingleThreadedExecutor {
 public:
  void add_node(std::shared_ptr<Node>) {}
  void spin_once(std::chrono::nanoseconds) { std::this_thread::sleep_for(std::chrono::milliseconds(1)); }
};
}  // namespace executors

}  // namespace rclcpp

#define RCLCPP_WARN_THROTTLE(logger, clock, duration, format, name, text) \
  (static_cast<void>(clock), (logger).lines->push_back(std::string(name) + ": " + (text)))
