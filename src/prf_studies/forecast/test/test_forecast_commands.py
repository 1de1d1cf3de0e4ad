# SPDX-License-Identifier: BSD-3-Clause
"""The commands, shortly, on inputs made here: figures with the right keys, bad arguments refused with
code 2 and one line that names them."""
import json
import math
import os
import random
import subprocess
import tempfile
import unittest

import rosbag
import roslib.packages
import rospkg
import rospy
import yaml
from geometry_msgs.msg import TransformStamped
from tf2_msgs.msg import TFMessage

from prf_msgs.msg import TagDetection, TagDetectionArray

BASE, CAMERA = "j2s7s300_link_base", "camera_optical_frame"
HORIZONS_S = [0.1, 0.25, 0.5, 1.0, 2.0]
FILTERPY = """
class MerweScaledSigmaPoints:
    def __init__(self, *arguments):
        pass
class UnscentedKalmanFilter:
    def __init__(self, *arguments):
        pass
    def predict(self):
        pass
    def update(self, measured):
        pass
"""


def wave(t):
    return 0.9 + 0.05 * math.sin(2.4 * t), 0.01 * math.sin(7.0 * t), 0.3


def write_motion(path):
    with open(path, "w", encoding="utf-8") as file:
        file.write("# a wave\ntime,x,y,z,qx,qy,qz,qw\n")
        for k in range(700):
            t = 0.01 * k
            half = 0.05 * math.sin(2.4 * t)
            numbers = (t, *wave(t), 0.0, 0.0, math.sin(half), math.cos(half))
            file.write(",".join(f"{number:.9g}" for number in numbers) + "\n")


def write_bag(path, images, place=wave):
    noise = random.Random(1)  # of 1 mm, as the covariance says
    camera = TransformStamped(child_frame_id=CAMERA)
    camera.header.frame_id, camera.transform.rotation.w = BASE, 1.0
    with rosbag.Bag(path, "w") as bag:
        bag.write("/tf_static", TFMessage([camera]), rospy.Time(1))
        for k in range(images):
            stamp = rospy.Time.from_sec(1.0 + k / 30)
            array, tag = TagDetectionArray(), TagDetection(family="tag36h11", id=0)
            array.header.stamp, array.header.frame_id = stamp, CAMERA
            position = tag.pose.pose.position
            position.x, position.y, position.z = (
                value + noise.gauss(0.0, 1e-3) for value in place(k / 30))
            tag.pose.pose.orientation.w = 1.0
            tag.pose.covariance = [1e-6 if i % 7 == 0 else 0.0 for i in range(36)]
            array.detections.append(tag)
            bag.write("/tag_detections", array, stamp)


class Commands(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.holder = tempfile.TemporaryDirectory()
        cls.motion, cls.bag = cls.path("motion.csv"), cls.path("trial.bag")
        write_motion(cls.motion)
        write_bag(cls.bag, 90)

    @classmethod
    def tearDownClass(cls):
        cls.holder.cleanup()

    @classmethod
    def path(cls, name):
        return os.path.join(cls.holder.name, name)

    def run_command(self, name, *arguments, **environment):
        command = roslib.packages.find_node("prf_studies", name)[0]
        return subprocess.run([command, *map(str, arguments)], text=True, check=False, timeout=200,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              env={**os.environ, **environment})

    def figures(self, name, *arguments, **environment):
        out = self.path(name + ".json")
        done = self.run_command(name, *arguments, "--json", out, **environment)
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(out, encoding="utf-8") as file:
            return json.load(file), done.stdout

    def assert_refused(self, name, arguments, word):
        with self.subTest(name=name, arguments=arguments):
            done = self.run_command(name, *arguments)
            self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
            self.assertIn(word, done.stderr.strip().splitlines()[-1])
            self.assertNotIn("Traceback", done.stderr)

    def test_forecast_error_gives_position_and_orientation_at_every_horizon(self):
        content, printed = self.figures("forecast_error", "--csv", self.motion, "--columns",
                                        "time,x,y,z", "--warm-up", 1, "--predictors", "periodic",
                                        "paper", "hold")
        self.assertEqual(content["horizons_s"], HORIZONS_S)
        of_motion = content["conditions"]["motion.csv"]
        self.assertEqual(set(of_motion), {"periodic", "paper", "hold"})
        for figures in of_motion.values():
            self.assertEqual(figures["trials"], 1)
            for key in ("rms_error_m", "rms_orientation_error_rad"):
                self.assertEqual(len(figures[key]), len(HORIZONS_S))
        # Half a second ahead a wave of 0.05 m and one of 0.1 rad have moved as these have.
        rest = of_motion["hold"]
        self.assertTrue(0.03 < rest["rms_error_m"][2] < 0.06, rest)
        self.assertTrue(0.06 < rest["rms_orientation_error_rad"][2] < 0.12, rest)
        self.assertIn("periodic / paper at worst", printed)

    def test_a_variant_has_the_parameters_that_it_names(self):
        content, _ = self.figures("forecast_error", "--csv", self.motion, "--columns",
                                  "time,x,y,z", "--warm-up", 1, "--predictors", "ukf", "--variant",
                                  "same", "ukf", "acceleration_density=0.04", "--variant", "stiff",
                                  "ukf", "acceleration_density=0.0001")
        of_motion = content["conditions"]["motion.csv"]
        self.assertEqual(of_motion["same"], of_motion["ukf"])
        self.assertGreater(of_motion["stiff"]["rms_error_m"][0],
                           1.5 * of_motion["ukf"]["rms_error_m"][0])  # 1.8 seen; 1: ignored
        for variant, word in [(["x"], "--variant x"), (["x", "magic"], "magic"),
                              (["x", "ukf", "magic=1"], "magic"),
                              (["x", "ukf", "acceleration_density=a"], "NUMBER")]:
            self.assert_refused("forecast_error", ["--csv", self.motion, "--columns", "time,x,y,z",
                                                   "--variant", *variant], word)

    def gated_measurements(self, **changed):
        """Of the motion, with changed parameters of the node."""
        package = rospkg.RosPack().get_path("prf_predictor")
        with open(os.path.join(package, "config", "target_predictor.yaml"),
                  encoding="utf-8") as file:
            parameters = {**yaml.safe_load(file), **changed}
        with open(self.path("node.yaml"), "w", encoding="utf-8") as file:
            yaml.safe_dump(parameters, file)
        predictor = os.path.join(package, "config", "predictors", "ukf.yaml")
        done = self.run_command("evaluate_predictor", self.path("node.yaml"), predictor,
                                self.motion, "--warm-up=1", "--horizons=0.1",
                                "--columns=time,x,y,z", "--seeds=1")
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout)["gated"]

    def test_evaluate_predictor_takes_the_gate_from_the_nodes_parameters(self):
        self.assertEqual(self.gated_measurements(), 0)
        # Every second true measurement fails a gate of probability 0.51.
        self.assertGreater(self.gated_measurements(gate_probability=0.51, gate_speed=0.0), 20)
        predictor = os.path.join(rospkg.RosPack().get_path("prf_predictor"), "config",
                                 "predictors", "ukf.yaml")
        self.assert_refused("evaluate_predictor", [self.path("nothing.yaml"), predictor, self.motion,
                                                   "--horizons=1", "--columns=time,x,y,z",
                                                   "--seeds=1"], "nothing.yaml")

    def test_consistency_gives_nis_and_nees_with_their_bounds(self):
        content, _ = self.figures("consistency", "--csv", self.motion, "--columns", "time,x,y,z",
                                  "--warm-up", 1, "--predictors", "ukf")
        figures = content["conditions"]["motion.csv"]["ukf"]
        self.assertEqual(len(figures["nees"]), len(HORIZONS_S))
        for value in [figures["nis"], figures["orientation_nis"], *figures["nees"]]:
            self.assertTrue(math.isfinite(value["mean"]))
            self.assertTrue(0 <= value["within_bounds"] <= 1)
        low, high = figures["bounds"]  # chi-square, 3 degrees of freedom, one trial
        self.assertAlmostEqual(low, 0.216, delta=0.05)
        self.assertAlmostEqual(high, 9.348, delta=0.05)

    def test_fit_noise_raises_the_likelihood_and_writes_a_file_that_loads(self):
        out = self.path("fitted.yaml")
        content, _ = self.figures("fit_noise", self.bag, "--predictor", "paper", "--out", out,
                                  "--measurement-scale", 1.0)
        before, after = content["before"], content["after"]
        self.assertGreater(after["log_likelihood_per_measurement"], before["log_likelihood_per_measurement"])
        self.assertEqual(len(after["rms_error_m"]), len(HORIZONS_S))
        self.assertEqual(after["measurement_scale"], 1.0)
        with open(out, encoding="utf-8") as file:
            written = yaml.safe_load(file)
        self.assertEqual(set(written), {"predictor", "acceleration_density", "measurement_scale"})
        self.figures("fit_noise", self.bag, "--from", out)

    # Fault 54: a target that does not move, a fit that ends on its bounds -> refused, nothing is written
    def test_fit_noise_refuses_what_the_bag_does_not_determine(self):
        still, out = self.path("still.bag"), self.path("unwritten.yaml")
        write_bag(still, 90, lambda t: (0.9, 0.0, 0.3))
        self.assert_refused("fit_noise", [still, "--out", out], "still.bag: the target does not move")
        far = self.path("far.yaml")
        with open(far, "w", encoding="utf-8") as file:
            file.write("predictor: paper\nacceleration_density: 1.0e+05\nmeasurement_scale: 1.0\n")
        self.assert_refused("fit_noise", [self.bag, "--from", far, "--measurement-scale", 1.0, "--out", out],
                            "acceleration_density on its lower bound")
        self.assertFalse(os.path.exists(out))

    # Fault 54: a table with CR LF and semicolons -> read; times in ms, positions in mm -> refused with the unit
    def test_tables_as_people_have_them(self):
        with open(self.motion, encoding="utf-8") as file:
            text = file.read()
        rows = [line.split(",") for line in text.splitlines()[2:]]
        tables = {"windows": text.replace("\n", "\r\n"), "sheet": text.replace(",", ";").replace(".", ","),
                  "ms": "time,x,y,z\n" + "".join(f"{1e3 * float(row[0])},{','.join(row[1:4])}\n" for row in rows),
                  "mm": "time,x,y,z\n" + "".join(
                      row[0] + "".join(f",{1e3 * float(word)}" for word in row[1:4]) + "\n" for row in rows)}
        common = ["--columns", "time,x,y,z", "--warm-up", 1, "--predictors", "hold", "--csv"]
        errors = []
        for name, content in tables.items():
            path = self.path(name + ".csv")
            with open(path, "w", encoding="utf-8", newline="") as file:
                file.write(content)
            if name in ("ms", "mm"):
                unit = "is the time in s?" if name == "ms" else "in mm?"
                self.assert_refused("forecast_error", [*common, path], unit)
            else:
                figures, _ = self.figures("forecast_error", *common, path)
                errors.append(figures["conditions"][name + ".csv"]["hold"]["rms_error_m"])
        self.assertEqual(errors[0], errors[1])
        self.assert_refused("forecast_error", [*common, self.motion, "--warm-up", 8], "motion.csv: no forecast counts")

    def test_predictor_benchmark_compares_with_filterpy(self):
        os.makedirs(self.path("stub/filterpy"), exist_ok=True)
        for name, text in (("__init__.py", ""), ("kalman.py", FILTERPY)):
            with open(self.path("stub/filterpy/" + name), "w", encoding="utf-8") as file:
                file.write(text)
        path = os.pathsep.join([self.path("stub"), os.environ.get("PYTHONPATH", "")])
        content, _ = self.figures("predictor_benchmark", "--python", "/usr/bin/python3",
                                  PYTHONPATH=path)
        rows = {row["what"]: row for row in content["rows"]}
        self.assertTrue({"filterpy, 6 states", "paper", "periodic"} <= set(rows))
        for row in rows.values():
            self.assertAlmostEqual(row["filterpy_over_this"] * row["us"],
                                   rows["filterpy, 6 states"]["us"], places=6)

    def test_bad_arguments_end_with_code_2_and_what_is_wrong(self):
        few, text = self.path("few.bag"), self.path("text.csv")
        write_bag(few, 5)
        with open(text, "w", encoding="utf-8") as file:
            file.write("time,x,y,z\n0,0,0,0\n1,a,0,0\n")
        for name in ("forecast_error", "consistency"):
            for arguments, word in [
                    (["--seeds", "0"], "--seeds"), (["--jobs", "0"], "--jobs"),
                    (["--warm-up", "50"], "--warm-up"), (["--latency", "-1"], "--latency"),
                    (["--csv", self.path("none.csv")], "none.csv"),
                    (["--csv", text, "--columns", "time,x,y,z"], "text.csv"),
                    (["--csv", self.motion, "--columns", "t,x,y,z"], "column t"),
                    (["--predictors", "magic"], "magic"), (["--motions", "wild"], "wild")]:
                self.assert_refused(name, arguments, word)
        for arguments, word in [
                ([], "BAG"), ([self.bag, "--magic=1"], "--magic"), ([self.bag, "--tag", "x"], "--tag"),
                ([self.path("none.bag")], "none.bag"), ([few], "few.bag"),
                ([self.bag, "--tag", "7"], "tag 7"), ([self.bag, "--predictor", "magic"], "magic"),
                ([self.bag, "--predictor", "sines"], "sines"),
                ([self.bag, "--measurement-scale", "0"], "measurement-scale"),
                ([self.bag, "--from", self.motion], "motion.csv"),
                ([self.bag, "--out", self.path("no/folder.yaml")], "folder.yaml")]:
            self.assert_refused("fit_noise", arguments, word)
        self.assert_refused("predictor_benchmark", ["--python", self.path("none")], "none")
        self.assert_refused("predictor_benchmark", ["--magic"], "--magic")


if __name__ == "__main__":
    unittest.main()
