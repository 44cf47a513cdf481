"""Nav2's planner server with Talus as planner and costmap layer: ros2 launch talus_nav2 talus_nav2.launch.py map_file:=MAP.ot"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    usual = PathJoinSubstitution([FindPackageShare("talus_nav2"), "config", "talus_nav2.yaml"])
    sim_time = {"use_sim_time": LaunchConfiguration("use_sim_time")}
    map_file = LaunchConfiguration("map_file")
    # The costmap is a separate node inside the server, so that its parameters are prefixed with its name.
    maps = {"Talus.map_file": map_file}
    costmap = ["-p", ["global_costmap:ground.map_file:=", map_file]]
    return LaunchDescription(
        [
            DeclareLaunchArgument("map_file", description="MAP.ot that `talus costmap` wrote"),
            DeclareLaunchArgument("params_file", default_value=usual),
            DeclareLaunchArgument("use_sim_time", default_value="false"),
            Node(
                package="nav2_planner",
                executable="planner_server",
                output="screen",
                parameters=[LaunchConfiguration("params_file"), sim_time, maps],
                ros_arguments=costmap,
            ),
            Node(
                package="nav2_lifecycle_manager",
                executable="lifecycle_manager",
                name="lifecycle_manager_talus",
                output="screen",
                parameters=[sim_time, {"autostart": True, "node_names": ["planner_server"]}],
            ),
        ]
    )
