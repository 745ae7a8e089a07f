"""Edge SLAM beside a ROS 2 system: the program by itself, or with robot_localization as docs/ros2.md has it.

    ros2 launch ./edgeslam.launch.py config:=/etc/edgeslam/robot.yaml
    ros2 launch ./edgeslam.launch.py config:=robot.yaml ekf:=true

The configuration needs `ros2: {enabled: true}`; with ekf:=true it also needs `transforms: map_to_odom` and
`namespace: edgeslam`. Where Edge SLAM runs as a service already, give service:=true.
"""
import os

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

FOLDER = os.path.dirname(os.path.abspath(__file__))


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("config", default_value="/etc/edgeslam/robot.yaml", description="Edge SLAM's configuration"),
        DeclareLaunchArgument("service", default_value="false", description="Edge SLAM runs as a service of the system"),
        DeclareLaunchArgument("ekf", default_value="false", description="robot_localization sends odom -> base_link"),
        # No node of ROS: it takes ROS_DOMAIN_ID and ROS_LOCALHOST_ONLY of this environment. SIGINT ends it, and saves the map.
        ExecuteProcess(cmd=["edgeslam", "run", "--config", LaunchConfiguration("config")], output="screen",
                       condition=UnlessCondition(LaunchConfiguration("service"))),
        Node(package="robot_localization", executable="ekf_node", name="ekf_filter_node", output="screen",
             parameters=[os.path.join(FOLDER, "ekf.yaml")], condition=IfCondition(LaunchConfiguration("ekf"))),
    ])
