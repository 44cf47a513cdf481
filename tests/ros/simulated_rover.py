"""A simulated rover on a ROS master of its own: what it sees, drives and hears of the node."""

import math
import os
import socket
import struct
import tempfile
import threading
import time


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


PORT = free_port()
os.environ["ROS_MASTER_URI"] = f"http://127.0.0.1:{PORT}"
os.environ["ROS_IP"] = "127.0.0.1"
os.environ.pop("ROS_HOSTNAME", None)
os.environ["ROS_LOG_DIR"] = tempfile.mkdtemp(prefix="talus-ros-log-")

import rospy  # reads the environment
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import PoseStamped, TransformStamped
from nav_msgs.msg import OccupancyGrid, Path
from sensor_msgs.msg import Image, PointCloud2, PointField
from std_msgs.msg import Empty
from tf2_msgs.msg import TFMessage

WIDTH, HEIGHT, CELL_M, SIGHT_M = 80, 60, 0.5, 12.0
PARAMETERS = {
    "rover": "lunar_micro",
    "soil": "lunar_nominal",
    "width": WIDTH,
    "height": HEIGHT,
    "resolution_m": CELL_M,
    "allow_unknown": True,
    "max_age_s": 2.0,
    "replan_period_s": 0.2,
    "save_period_s": 0.2,
}


def height_m(x, y):
    """Level ground with a wall of 1 m across the way, open in the north."""
    return 1.25 if 19.0 <= x < 20.5 and y < 22.0 else 0.25


def cloud_of(rows, names, frame, stamp):
    message = PointCloud2(height=1, width=len(rows), point_step=4 * len(names), row_step=4 * len(names) * len(rows))
    message.header.frame_id, message.header.stamp = frame, stamp
    message.fields = [PointField(name=n, offset=4 * k, datatype=PointField.FLOAT32, count=1) for k, n in enumerate(names)]
    message.data = b"".join(struct.pack(f"<{len(names)}f", *row) for row in rows)
    return message


class Rover:
    """What sees, drives, and says where it stands, 20 times a second."""

    def __init__(self):
        self.x, self.y, self.heading = 5.0, 10.0, 0.0
        self.steps = 0
        self.tf = rospy.Publisher("/tf", TFMessage, queue_size=10)
        self.cloud = rospy.Publisher("/talus/cloud", PointCloud2, queue_size=2)
        self.image = rospy.Publisher("/talus/heights", Image, queue_size=2)
        self.wheels = rospy.Publisher("/talus/wheels", PointCloud2, queue_size=10)
        self.goal = rospy.Publisher("/talus/goal", PoseStamped, queue_size=1000)
        self.cancel = rospy.Publisher("/talus/cancel", Empty, queue_size=1)
        self.ended = threading.Event()
        threading.Thread(target=self.tell_place, daemon=True).start()

    def tell_place(self):
        while not self.ended.wait(0.05):
            t = TransformStamped()
            t.header.frame_id, t.header.stamp, t.child_frame_id = "map", rospy.Time.now(), "base_link"
            t.transform.translation.x, t.transform.translation.y = self.x, self.y
            t.transform.rotation.z, t.transform.rotation.w = math.sin(self.heading / 2), math.cos(self.heading / 2)
            self.tf.publish(TFMessage([t]))

    def see(self):
        """What lies within sight, as points in the rover's own frame."""
        c, s = math.cos(self.heading), math.sin(self.heading)
        points = []
        reach = int(SIGHT_M / CELL_M)
        for i in range(-reach, reach + 1):
            for k in range(-reach, reach + 1):
                x = (math.floor(self.x / CELL_M) + i + 0.5) * CELL_M
                y = (math.floor(self.y / CELL_M) + k + 0.5) * CELL_M
                dx, dy = x - self.x, y - self.y
                if math.hypot(dx, dy) <= SIGHT_M:
                    points.append((c * dx + s * dy, -s * dx + c * dy, height_m(x, y)))
        self.cloud.publish(cloud_of(points, ("x", "y", "z"), "base_link", rospy.Time.now()))

    def roll(self):
        """What four wheels read: they slip little."""
        rows = [(a, b, 0.0, 36.5, 0.04, 0.01, 0.0) for a in (0.45, -0.45) for b in (0.4, -0.4)]
        names = ("x", "y", "z", "load_N", "slip", "sinkage_m", "slope_rad")
        self.wheels.publish(cloud_of(rows, names, "base_link", rospy.Time.now()))
        self.steps += 1

    def ask(self, x, y, frame="map", age_s=0.0):
        goal = PoseStamped()
        goal.header.frame_id, goal.header.stamp = frame, rospy.Time.now() - rospy.Duration(age_s)
        goal.pose.position.x, goal.pose.position.y, goal.pose.orientation.w = x, y, 1.0
        self.goal.publish(goal)


class Heard:
    """What the node published since, by topic."""

    def __init__(self):
        self.paths, self.states, self.grids = [], [], []
        rospy.Subscriber("/talus/path", Path, self.paths.append)
        rospy.Subscriber("/talus/status", GoalStatus, self.states.append)
        rospy.Subscriber("/talus/occupancy", OccupancyGrid, self.grids.append)

    def wait(self, what, seconds=15.0):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            found = what()
            if found:
                return found
            time.sleep(0.02)
        raise AssertionError(f"nothing within {seconds} s; states: {[(s.status, s.text) for s in self.states[-5:]]}")

    def state(self, code, word, after=0):
        return self.wait(lambda: [s for s in self.states[after:] if s.status == code and word in s.text])[0]

    def known(self):
        return sum(value >= 0 for value in self.grids[-1].data)
