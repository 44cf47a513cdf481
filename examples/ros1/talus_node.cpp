// Shows   Talus as a ROS 1 node: sensor messages to a map, wheel messages to evidence, goals to paths.
// Needs   talus::planner, talus::terramech_io, roscpp, tf2_ros.  Topics and parameters: README.md.
// Next    ../rover_loop.cpp: the same loop without ROS.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <functional>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <actionlib_msgs/GoalStatus.h>
#include <geometry_msgs/PoseStamped.h>
#include <nav_msgs/OccupancyGrid.h>
#include <nav_msgs/Path.h>
#include <ros/ros.h>
#include <std_msgs/Empty.h>
#include <tf2_ros/transform_listener.h>

#include "messages.hpp"

namespace rover_ros {
namespace {

using actionlib_msgs::GoalStatus;

// Parameters in the private namespace of the node; an unknown parameter is an error.
class Parameters {
 public:
  explicit Parameters(ros::NodeHandle own) : own_(std::move(own)) {}

  template <typename T>
  void take(const char* name, T& value) {
    known_.emplace_back(name);
    if (own_.hasParam(name) && !own_.getParam(name, value))
      throw std::runtime_error("parameter ~" + std::string(name) + " has another type; see README.md");
  }
  void refuseOthers() const {
    std::vector<std::string> names;
    own_.getParamNames(names);
    const std::string before = own_.getNamespace() + "/";
    for (const std::string& name : names) {
      if (name.compare(0, before.size(), before) != 0) continue;
      const std::string word = name.substr(before.size(), name.find('/', before.size()) - before.size());
      if (std::find(known_.begin(), known_.end(), word) != known_.end()) continue;
      const std::string near = nearestName(word, known_);
      throw std::runtime_error("parameter ~" + word + " is not known" +
                               (near.empty() ? "; see README.md" : "; did you mean ~" + near + "?"));
    }
  }

 private:
  ros::NodeHandle own_;
  std::vector<std::string> known_;
};

struct NodeSettings {
  Settings navigator;
  std::string map_frame = "map", base_frame = "base_link";
  double max_age_s = 5.0;        // of a message
  double pixel_m = 0.0;          // pixel size of the height image; 0: Settings::resolution_m
  double replan_period_s = 1.0;  // shortest time between two plans for one goal
  double save_period_s = 1.0;
};

NodeSettings settingsOf(const ros::NodeHandle& own) {
  NodeSettings s;
  Settings& n = s.navigator;
  Parameters parameters(own);
  parameters.take("rover", n.rover);
  parameters.take("soil", n.soil);
  parameters.take("width", n.width);
  parameters.take("height", n.height);
  parameters.take("resolution_m", n.resolution_m);
  parameters.take("origin_x_m", n.south_west.x_m);
  parameters.take("origin_y_m", n.south_west.y_m);
  parameters.take("allow_unknown", n.allow_unknown);
  parameters.take("percentile", n.percentile);
  parameters.take("least_points", n.least_points);
  parameters.take("planner", n.planner);
  parameters.take("time_limit_s", n.time_limit_s);
  parameters.take("tolerance_m", n.tolerance_m);
  parameters.take("path_spacing_m", n.path_spacing_m);
  parameters.take("pose_std_m", n.pose_std_m);
  parameters.take("state_folder", n.state_folder);
  parameters.take("map_frame", s.map_frame);
  parameters.take("base_frame", s.base_frame);
  parameters.take("max_age_s", s.max_age_s);
  parameters.take("image_pixel_m", s.pixel_m);
  parameters.take("replan_period_s", s.replan_period_s);
  parameters.take("save_period_s", s.save_period_s);
  parameters.refuseOthers();
  if (!(s.max_age_s > 0.0)) throw std::runtime_error("parameter ~max_age_s must be > 0");
  if (!(s.replan_period_s > 0.0)) throw std::runtime_error("parameter ~replan_period_s must be > 0");
  if (!(s.save_period_s > 0.0)) throw std::runtime_error("parameter ~save_period_s must be > 0");
  if (!(s.pixel_m >= 0.0)) throw std::runtime_error("parameter ~image_pixel_m must be >= 0");
  if (s.pixel_m == 0.0) s.pixel_m = n.resolution_m;
  return s;
}

// Callbacks run in the thread of ros::spin(), the only one that changes the map; plans run in a second
// thread.
class Node {
 public:
  explicit Node(ros::NodeHandle own)
      : settings_(settingsOf(own)), navigator_(settings_.navigator), listener_(transforms_) {
    path_ = own.advertise<nav_msgs::Path>("path", 1, true);
    occupancy_ = own.advertise<nav_msgs::OccupancyGrid>("occupancy", 1, true);
    status_ = own.advertise<GoalStatus>("status", 10, true);
    cloud_ = own.subscribe("cloud", 2, &Node::cloud, this);
    image_ = own.subscribe("heights", 2, &Node::image, this);
    wheels_ = own.subscribe("wheels", 100, &Node::wheels, this);
    goal_ = own.subscribe("goal", 1, &Node::goal, this);
    cancel_ = own.subscribe("cancel", 1, &Node::cancel, this);
    save_ = own.createTimer(ros::Duration(settings_.save_period_s), &Node::save, this);
    if (!navigator_.restored().empty())
      ROS_INFO("read back from %s: %s", settings_.navigator.state_folder.c_str(),
               navigator_.restored().c_str());
    if (const auto kept = navigator_.goal()) {
      ROS_INFO("going on to the goal at (%.2f, %.2f) m", kept->x_m, kept->y_m);
      active_ = true;
    }
    show();
    planning_ = std::thread([this] { plans(); });
  }
  ~Node() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ending_ = true;
    }
    navigator_.cancel();
    wake_.notify_all();
    planning_.join();
    guarded("heights", [this] { navigator_.save(); });
  }
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

 private:
  // Runs `work`. An exception is logged, at most once per second and topic; the message is then ignored.
  void guarded(const char* topic, const std::function<void()>& work) {
    try {
      work();
    } catch (const std::exception& error) {
      ros::WallTime& last = warned_[topic == std::string("cloud")     ? 0
                                    : topic == std::string("heights") ? 1
                                                                      : 2];
      if (ros::WallTime::now() - last < ros::WallDuration(1.0)) return;
      last = ros::WallTime::now();
      ROS_WARN("%s: %s", topic, error.what());
    }
  }

  RigidTransform transformOf(const std_msgs::Header& header) const {
    if (header.stamp.isZero()) throw std::runtime_error("has no stamp; set the time that it is of");
    requireFresh(header.stamp);
    return transformAt(header.frame_id, header.stamp);
  }
  void requireFresh(const ros::Time& stamp) const {
    const double age_s = (ros::Time::now() - stamp).toSec();
    if (age_s > settings_.max_age_s)
      throw std::runtime_error("its stamp is " + std::to_string(age_s) + " s old, more than ~max_age_s = " +
                               std::to_string(settings_.max_age_s) + "; check the clocks");
  }
  // Returns the current place of the rover; throws if the transform is outdated. A static transform has no
  // stamp.
  Place rover() const {
    const RigidTransform T_map_base = transformAt(settings_.base_frame, ros::Time(0));
    const ros::Time stamp =
        transforms_.lookupTransform(settings_.map_frame, settings_.base_frame, ros::Time(0)).header.stamp;
    if (!stamp.isZero()) requireFresh(stamp);
    const CloudPoint at = T_map_base({});
    return {at.x_m, at.y_m};
  }
  // Returns the rigid transform from a frame to the map frame. tf2 expects frames without a leading slash.
  RigidTransform transformAt(const std::string& frame, const ros::Time& stamp) const {
    const std::string plain = frame.substr(std::min(frame.find_first_not_of('/'), frame.size()));
    if (plain.empty()) throw std::runtime_error("has no frame_id; name a frame that tf knows");
    std::string why;
    if (!transforms_.canTransform(settings_.map_frame, plain, stamp, ros::Duration(0.2), &why))
      throw std::runtime_error("frame '" + plain + "' is not known in '" + settings_.map_frame +
                               "' at its time (" + why + "); publish the transform");
    return RigidTransform(transforms_.lookupTransform(settings_.map_frame, plain, stamp).transform);
  }

  void cloud(const sensor_msgs::PointCloud2ConstPtr& message) {
    guarded("cloud", [&] {
      navigator_.see(pointsOf(*message, transformOf(message->header)));
      show();
    });
  }
  void image(const sensor_msgs::ImageConstPtr& message) {
    guarded("heights", [&] {
      navigator_.see(pointsOf(*message, settings_.pixel_m, transformOf(message->header)));
      show();
    });
  }
  void wheels(const sensor_msgs::PointCloud2ConstPtr& message) {
    guarded("wheels", [&] {
      navigator_.learn(wheelsOf(*message, transformOf(message->header)));
      show();
    });
  }

  // Sets the goal. A goal that arrives during a plan waits for its end and replaces any other waiting goal.
  void goal(const geometry_msgs::PoseStampedConstPtr& message) {
    try {
      const auto& p = message->pose.position;
      if (!std::isfinite(p.x) || !std::isfinite(p.y)) throw std::runtime_error("its position is not finite");
      const CloudPoint at = transformOf(message->header)({p.x, p.y, std::isfinite(p.z) ? p.z : 0.0});
      navigator_.setGoal(Place{at.x_m, at.y_m});
      report(GoalStatus::PENDING,
             "goal at (" + std::to_string(at.x_m) + ", " + std::to_string(at.y_m) + ") m");
      const std::lock_guard<std::mutex> lock(mutex_);
      active_ = fresh_ = true;
      wake_.notify_all();
    } catch (const std::exception& error) {
      report(GoalStatus::REJECTED, std::string("goal: ") + error.what());
    }
  }
  void cancel(const std_msgs::EmptyConstPtr&) {
    end(GoalStatus::PREEMPTED, "cancelled");
    navigator_.cancel();
  }
  void save(const ros::TimerEvent&) {
    guarded("state", [this] { navigator_.save(); });
  }

  void report(std::uint8_t code, const std::string& text) {
    GoalStatus status;
    status.goal_id.stamp = ros::Time::now();
    status.status = code;
    status.text = text;
    const std::lock_guard<std::mutex> lock(reporting_);
    if (code != GoalStatus::PENDING && text != last_text_) {
      if (code == GoalStatus::REJECTED || code == GoalStatus::ABORTED)
        ROS_WARN("%s", text.c_str());
      else
        ROS_INFO("%s", text.c_str());
    }
    last_text_ = text;
    status_.publish(status);
  }
  // Ends the current goal and publishes an empty path, on which a path-following controller stops. With
  // `planned`, a goal that arrived since the plan began is kept.
  void end(std::uint8_t code, const std::string& text, bool planned = false) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!active_ || (planned && fresh_)) return;
    active_ = fresh_ = false;
    navigator_.setGoal(std::nullopt);
    publish({});
    report(code, text);
  }
  void publish(const std::vector<Pose>& poses) {
    std_msgs::Header header;
    header.frame_id = settings_.map_frame;
    header.stamp = ros::Time::now();
    path_.publish(pathOf(poses, header));
  }
  void show() {
    nav_msgs::OccupancyGrid grid;
    const Settings& n = settings_.navigator;
    grid.header.frame_id = settings_.map_frame;
    grid.header.stamp = grid.info.map_load_time = ros::Time::now();
    grid.info.resolution = static_cast<float>(n.resolution_m);
    grid.info.width = static_cast<std::uint32_t>(n.width);
    grid.info.height = static_cast<std::uint32_t>(n.height);
    grid.info.origin.position.x = n.south_west.x_m;
    grid.info.origin.position.y = n.south_west.y_m;
    grid.info.origin.orientation.w = 1.0;
    grid.data = navigator_.occupancy();
    occupancy_.publish(grid);
  }

  // Plans when the goal is new or the map changed, at most once per period for one goal.
  void plans() {
    unsigned long planned = 0;
    ros::WallTime last;
    std::unique_lock<std::mutex> lock(mutex_);
    while (!ending_) {
      wake_.wait_for(lock, std::chrono::milliseconds(100));
      if (ending_ || !active_) continue;
      const auto goal = navigator_.goal();
      if (!goal) continue;
      const bool is_new = std::exchange(fresh_, false);
      const bool due = ros::WallTime::now() - last >= ros::WallDuration(settings_.replan_period_s);
      lock.unlock();
      const unsigned long version = navigator_.version();
      if (is_new || due) {
        last = ros::WallTime::now();
        if (step(*goal, is_new || version != planned)) planned = version;
      }
      lock.lock();
    }
  }
  // Returns whether a plan was made.
  bool step(const Place& goal, bool wanted) {
    Place start;
    try {
      start = rover();
    } catch (const std::exception& error) {
      report(GoalStatus::PENDING, std::string("waiting for the rover's place: ") + error.what());
      return false;
    }
    if (std::hypot(goal.x_m - start.x_m, goal.y_m - start.y_m) <= settings_.navigator.tolerance_m) {
      finish(GoalStatus::SUCCEEDED, "reached");
      return false;
    }
    if (!wanted) return false;
    try {
      answer(navigator_.plan(start, goal));
    } catch (const std::exception& error) {
      finish(GoalStatus::ABORTED, std::string("plan: ") + error.what());
    }
    return true;
  }
  // Publishes the outcome of a plan, unless the goal was cancelled or replaced.
  void answer(const Outcome& outcome) {
    if (outcome.cancelled) return;
    const std::string reason = outcome.reason.empty() ? "" : ": " + outcome.reason;
    if (!outcome.found) {
      finish(outcome.status == "goal_invalid" ? GoalStatus::REJECTED : GoalStatus::ABORTED,
             outcome.status + reason);
      return;
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!active_ || fresh_) return;
    publish(outcome.path);
    char text[160];
    std::snprintf(text, sizeof text, "found: %.1f m, %.0f J, immobilisation probability %.2g",
                  outcome.length_m, outcome.energy_J, outcome.risk);
    report(GoalStatus::ACTIVE, text);
  }
  void finish(std::uint8_t code, const std::string& text) { end(code, text, true); }

  NodeSettings settings_;
  Navigator navigator_;
  tf2_ros::Buffer transforms_;
  tf2_ros::TransformListener listener_;
  ros::Publisher path_, occupancy_, status_;
  ros::Subscriber cloud_, image_, wheels_, goal_, cancel_;
  ros::Timer save_;
  ros::WallTime warned_[3];
  std::mutex mutex_;  // guards the members below
  std::condition_variable wake_;
  bool active_ = false;  // a goal is set
  bool fresh_ = false;   // the goal has no plan yet
  bool ending_ = false;
  std::mutex reporting_;
  std::string last_text_;
  std::thread planning_;
};

}  // namespace
}  // namespace rover_ros

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // line buffering: a killed process leaves a complete log
  try {
    ros::init(argc, argv, "talus");
    if (!ros::master::check()) {
      std::fprintf(stderr, "talus_node: no ROS master at %s; start roscore, or set ROS_MASTER_URI\n",
                   ros::master::getURI().c_str());
      return 2;
    }
    rover_ros::Node node{ros::NodeHandle("~")};
    ros::spin();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "talus_node: %s\n", error.what());
    return 2;
  }
}
