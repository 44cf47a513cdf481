// Shows   Talus' planners as a class of pluginlib, for systems that load planners by name.
// Needs   talus::planner, pluginlib. Described to pluginlib by plugins.xml.in.
// Next    load_planner.cpp: a program that loads the class.
#include <memory>
#include <utility>

#include <pluginlib/class_list_macros.hpp>

#include <talus/planner/planner.hpp>

namespace talus_pluginlib {

/// Planner selected by configure(); the default planner before that call.
class Planner final : public talus::GlobalPlanner {
 public:
  talus::PlannerCapabilities capabilities() const override { return planner_->capabilities(); }
  void configure(const talus::PlannerSettings& settings) override { planner_->configure(settings); }
  void set_map(std::shared_ptr<const talus::costmap::CostGrid> map) override {
    planner_->set_map(std::move(map));
  }
  void update(std::shared_ptr<const talus::costmap::CostGrid> newer) override {
    planner_->update(std::move(newer));
  }
  talus::planner::Route plan(const talus::PlanRequest& request) override { return planner_->plan(request); }
  std::unique_ptr<talus::GlobalPlanner> create() const override { return std::make_unique<Planner>(); }

 private:
  std::unique_ptr<talus::GlobalPlanner> planner_ = talus::planner::makePlanner();
};

}  // namespace talus_pluginlib

PLUGINLIB_EXPORT_CLASS(talus_pluginlib::Planner, talus::GlobalPlanner)
