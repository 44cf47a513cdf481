#!/usr/bin/python3
"""The node of examples/ros1 on a ROS master of its own: a traverse with a wall that nobody has seen, a kill in the middle,
and every kind of bad input. Started by `./dev ros-test`: traverse_test.py NODE."""

import math
import os
import pathlib
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time
import unittest

from simulated_rover import CELL_M, HEIGHT, PARAMETERS, PORT, WIDTH, Heard, Rover, cloud_of, free_port, height_m

import rospy
from actionlib_msgs.msg import GoalStatus
from sensor_msgs.msg import Image
from std_msgs.msg import Empty

NODE = sys.argv.pop(1) if len(sys.argv) > 1 else ""


class NodeTest(unittest.TestCase):
    """A fresh node and state folder a test."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory(prefix="talus-ros-")
        for name in rospy.get_param_names():
            if name.startswith("/talus/"):
                rospy.delete_param(name)
        for name, value in {**PARAMETERS, "state_folder": self.folder.name + "/state"}.items():
            rospy.set_param("/talus/" + name, value)
        self.heard = Heard()
        self.rover = Rover()
        self.node = None

    def tearDown(self):
        self.rover.ended.set()
        if self.node and self.node.poll() is None:
            self.node.send_signal(signal.SIGINT)
            self.assertEqual(self.node.wait(10), 0, self.log())
        self.folder.cleanup()

    def start(self):
        self.log_file = pathlib.Path(self.folder.name) / f"log-{time.monotonic_ns()}"
        with self.log_file.open("wb") as log:
            self.node = subprocess.Popen([NODE], stdout=log, stderr=subprocess.STDOUT)
        topics = (self.rover.cloud, self.rover.goal, self.rover.wheels, self.rover.tf, self.rover.image, self.rover.cancel)
        self.heard.wait(lambda: all(p.get_num_connections() for p in topics))
        self.heard.wait(lambda: self.heard.grids)
        time.sleep(0.2)

    def see(self):
        """Looks until the node has a map: on a busy machine the first transforms may come late."""
        sent = [0.0]

        def seen():
            if time.monotonic() - sent[0] > 1.0:
                sent[0] = time.monotonic()
                self.rover.see()
            return self.heard.known() > 500

        self.heard.wait(seen)

    def log(self):
        return self.log_file.read_text()

    def warned(self, *words):
        """One line of the log that has all of the words."""
        lines = lambda: [line for line in self.log().splitlines() if all(word in line for word in words)]
        self.heard.wait(lines)
        self.assertEqual(len(lines()), 1, self.log())

    def follow(self, metres, wait_s=0.25):
        """Drives along the newest path, looks, and lets the wheels tell."""
        poses = self.heard.paths[-1].poses
        near = min(range(len(poses)), key=lambda i: math.dist(self.place(poses[i]), (self.rover.x, self.rover.y)))
        for pose in poses[near:]:
            if math.dist(self.place(pose), (self.rover.x, self.rover.y)) > metres:
                break
        self.rover.x, self.rover.y = self.place(pose)
        self.rover.heading = 2.0 * math.atan2(pose.pose.orientation.z, pose.pose.orientation.w)
        self.assertEqual(height_m(self.rover.x, self.rover.y), 0.25, "drives into the wall")
        time.sleep(0.1)  # the transform of the new place is on its way
        self.rover.see()
        self.rover.roll()
        time.sleep(wait_s)

    @staticmethod
    def place(pose):
        return pose.pose.position.x, pose.pose.position.y


class Traverse(NodeTest):
    def test_sees_plans_learns_is_killed_and_goes_on(self):
        self.start()
        self.see()
        self.rover.ask(35.0, 10.0)
        self.heard.state(GoalStatus.ACTIVE, "found")
        first = self.heard.wait(lambda: self.heard.paths)[-1]
        # Closed form: nothing is known against the straight line of 30 m; 0.5 m apart that is 61 poses or a few more.
        self.assertEqual(first.header.frame_id, "map")
        self.assertLess(max(abs(p.pose.position.y - 10.0) for p in first.poses), 1.0)
        self.assertEqual({p.pose.position.z for p in first.poses}, {0.25})
        for a, b in zip(first.poses, first.poses[1:]):
            self.assertLessEqual(math.dist(self.place(a), self.place(b)), 0.5 + 1e-6)
            ahead = math.atan2(b.pose.position.y - a.pose.position.y, b.pose.position.x - a.pose.position.x)
            heading = 2.0 * math.atan2(a.pose.orientation.z, a.pose.orientation.w)
            self.assertLess(abs(math.remainder(ahead - heading, 2 * math.pi)), 1e-3)
        killed = False
        for _ in range(80):
            if any(s.status == GoalStatus.SUCCEEDED for s in self.heard.states):
                break
            self.follow(2.0)
            if not killed and self.rover.x > 12.0:
                killed = True
                time.sleep(0.5)  # longer than ~save_period_s
                before = self.heard.known()
                self.node.kill()
                self.node.wait()
                self.heard.grids.clear()
                self.heard.paths.clear()
                self.start()
                self.assertEqual(self.heard.known(), before)
                self.assertIn("going on to the goal at (35.00, 10.00) m", self.log())
                self.assertIn(f"{4 * self.rover.steps} rows of telemetry", self.log())
                self.heard.wait(lambda: self.heard.paths)
        self.assertTrue(killed)
        self.heard.state(GoalStatus.SUCCEEDED, "reached")
        self.assertLess(math.dist((self.rover.x, self.rover.y), (35.0, 10.0)), 0.51)
        # Property: the wall forced a detour to y >= 22 m.
        north = max(p.pose.position.y for path in self.heard.paths for p in path.poses)
        self.assertGreater(north, 22.0)
        grid = self.heard.grids[-1]
        self.assertEqual(grid.data[int(10.0 / CELL_M) * WIDTH + int(19.7 / CELL_M)], 100)  # the wall
        self.assertEqual(grid.data[int(10.0 / CELL_M) * WIDTH + int(8.0 / CELL_M)], 0)  # where it drove
        self.assertEqual(grid.data[(HEIGHT - 1) * WIDTH], -1)  # far from all that it saw
        self.assertFalse((pathlib.Path(self.folder.name) / "state" / "goal.txt").exists())

    def test_a_height_image_is_a_patch_too(self):
        self.start()
        image = Image(height=40, width=40, encoding="32FC1", step=160)
        image.header.frame_id, image.header.stamp = "base_link", rospy.Time.now()
        rows = [[1.0 if r < 8 else float("nan") if r >= 32 else 0.0 for _ in range(40)] for r in range(40)]
        image.data = b"".join(struct.pack("<40f", *row) for row in rows)
        self.rover.image.publish(image)
        # Closed form: 40 x 40 pixels of 0.5 m around (5, 10); columns from x = -5 on, of which those below 0 lie off the map,
        # the lowest 8 rows not observed: 30 x 32 cells, the most northern rows 1 m higher.
        self.heard.wait(lambda: self.heard.known() == 30 * 32)
        data = self.heard.grids[-1].data
        self.assertEqual(data[int(16.0 / CELL_M) * WIDTH + 10], 100)
        self.assertEqual(data[int(8.0 / CELL_M) * WIDTH + 10], 0)

    def test_cancel_ends_the_goal(self):
        self.start()
        self.see()
        self.rover.ask(35.0, 10.0)
        self.heard.state(GoalStatus.ACTIVE, "found")
        self.rover.cancel.publish(Empty())
        self.heard.state(GoalStatus.PREEMPTED, "cancelled")
        self.heard.wait(lambda: not self.heard.paths[-1].poses)


class BadInput(NodeTest):
    def refused_call(self, *words):
        done = subprocess.run([NODE], capture_output=True, text=True, timeout=20)
        self.assertEqual(done.returncode, 2, done.stderr)
        lines = [line for line in done.stderr.splitlines() if "talus_node:" in line]
        self.assertEqual(len(lines), 1, done.stderr)
        for word in words:
            self.assertIn(word, lines[0])

    def test_no_roscore(self):
        uri = os.environ["ROS_MASTER_URI"]
        os.environ["ROS_MASTER_URI"] = f"http://127.0.0.1:{free_port()}"
        try:
            self.refused_call("no ROS master at", "start roscore")
        finally:
            os.environ["ROS_MASTER_URI"] = uri

    def test_bad_parameters(self):
        for name, value, words in (
            ("resolution", 0.5, ("~resolution is not known", "~resolution_m")),
            ("rover", "lunar_mikro", ("lunar_mikro", "lunar_micro")),
            ("width", -3, ("width",)),
            ("width", "wide", ("~width has another type",)),
            ("planner", "feild", ("field",)),
            ("max_age_s", 0.0, ("~max_age_s must be > 0",)),
        ):
            with self.subTest(name=name, value=value):
                before = rospy.get_param("/talus/" + name, None)
                rospy.set_param("/talus/" + name, value)
                self.refused_call(*words)
                rospy.set_param("/talus/" + name, before) if before is not None else rospy.delete_param("/talus/" + name)

    def test_state_of_another_grid(self):
        self.start()
        self.see()
        self.node.send_signal(signal.SIGINT)
        self.assertEqual(self.node.wait(10), 0)
        rospy.set_param("/talus/width", WIDTH + 1)
        self.refused_call("heights.ot", "another grid", "remove it")

    def test_messages_that_cannot_be_used(self):
        self.start()
        now, names, point = rospy.Time.now, ("x", "y", "z"), [(1.0, 0.0, 0.0)]
        short = cloud_of(point * 3, names, "base_link", now())
        short.data = short.data[:20]
        for message, words in (
            (cloud_of(point, names, "camera", now()), ("cloud:", "frame 'camera' is not known in 'map'")),
            (cloud_of(point, names, "", now()), ("cloud:", "no frame_id")),
            (cloud_of(point, names, "base_link", rospy.Time(0)), ("cloud:", "no stamp")),
            (cloud_of(point, names, "base_link", now() - rospy.Duration(60)), ("cloud:", "s old", "~max_age_s")),
            (cloud_of([], names, "base_link", now()), ("cloud:", "is empty")),
            (cloud_of([(math.nan,) * 3], names, "base_link", now()), ("cloud:", "no finite point")),
            (cloud_of([(1e4, 0.0, 0.0)], names, "base_link", now()), ("cloud:", "no point on the map")),
            (cloud_of([(1.0, 0.0, 1e30)], names, "base_link", now()), ("cloud:", "elevation_m = ")),
            (cloud_of(point, ("x", "y", "w"), "base_link", now()), ("cloud:", "no field 'z'")),
            (short, ("cloud:", "holds 20 bytes")),
        ):
            with self.subTest(words=words):
                message.header.stamp += now() - message.header.stamp if "s old" not in words and "no stamp" not in words else rospy.Duration(0)
                self.rover.cloud.publish(message)
                self.warned(*words)
                time.sleep(1.0)  # one line a second of each topic
        self.assertEqual(self.heard.known(), 0)
        self.rover.image.publish(Image(height=2, width=2, encoding="mono8", step=2, data=b"1234"))
        self.warned("heights:")
        self.rover.wheels.publish(cloud_of(point, names, "base_link", now()))
        self.warned("wheels:", "no field 'load_N'")
        self.see()  # it goes on

    def test_goals_that_cannot_be_used(self):
        self.start()
        self.see()
        for call, words in (
            (lambda: self.rover.ask(35.0, 10.0, frame="mars"), "frame 'mars' is not known"),
            (lambda: self.rover.ask(35.0, 10.0, age_s=60.0), "s old"),
            (lambda: self.rover.ask(math.nan, 10.0), "not finite"),
            (lambda: self.rover.ask(900.0, 10.0), "goal_invalid"),
        ):
            with self.subTest(words=words):
                after = len(self.heard.states)
                call()
                self.assertNotIn("\n", self.heard.state(GoalStatus.REJECTED, words, after).text)
        self.rover.ask(15.0, 10.0)
        self.heard.state(GoalStatus.ACTIVE, "found")

    def test_a_rover_that_is_no_longer_located(self):
        self.start()
        self.see()
        self.rover.ended.set()
        time.sleep(2.2)  # longer than ~max_age_s
        self.rover.ask(35.0, 10.0)
        self.assertIn("s old", self.heard.state(GoalStatus.PENDING, "waiting for the rover's place").text)
        self.assertEqual(self.heard.paths, [])

    def test_a_hundred_goals_a_second(self):
        self.start()
        self.see()
        for i in range(300):
            self.rover.ask(8.0 + 0.08 * i, 12.0)
            time.sleep(0.01)
        self.rover.ask(30.0, 5.0)
        # The newest counts, soon.
        self.heard.wait(lambda: self.heard.paths and self.heard.paths[-1].poses
                        and math.dist(self.place(self.heard.paths[-1].poses[-1]), (30.0, 5.0)) <= 0.51, 5.0)
        resident_kB = int(next(line for line in open(f"/proc/{self.node.pid}/status") if line.startswith("VmRSS")).split()[1])
        self.assertLess(resident_kB, 400_000)


def main():
    master = subprocess.Popen(["rosmaster", "--core", "-p", str(PORT)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        for _ in range(200):
            with socket.socket() as s:
                if s.connect_ex(("127.0.0.1", PORT)) == 0:
                    break
            time.sleep(0.05)
        rospy.init_node("traverse_test", disable_signals=True)
        result = unittest.main(exit=False, verbosity=2, warnings="ignore").result
        rospy.signal_shutdown("done")
    finally:
        master.terminate()
        master.wait(10)
    os._exit(0 if result.wasSuccessful() else 1)


if __name__ == "__main__":
    main()
