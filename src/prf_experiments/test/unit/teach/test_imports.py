# SPDX-License-Identifier: BSD-3-Clause
import contextlib
import io
import os
import tempfile
import unittest

import h5py
import numpy as np
from prf_experiments.judge import judge
from prf_experiments.teach import demonstration, imports
from scipy.spatial.transform import Rotation

from prf_experiments import geometry

TIMES = np.linspace(0.0, 4.0, 201)
UPRIGHT = [0.5, 0.5, 0.5, 0.5]  # the hand looks along x, the camera above it


def motion():
    """A hand that goes 0.3 m along x in 4 s over a hump, turned by a little less than UPRIGHT at first."""
    x = 0.3 + 0.3 * TIMES / 4.0
    turned = Rotation.from_euler("z", 0.3 * (1 - TIMES / 4.0)) * Rotation.from_quat(UPRIGHT)
    z = 0.5 + 0.05 * np.sin(np.pi * TIMES / 4.0)
    return geometry.make(np.column_stack([x, 0 * x, z]), turned)


class Imports(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def hdf5(self, name="demo.h5", leave_out=(), **replaced):
        poses = motion()
        stamps = 1_684_779_652 + TIMES
        data = {"joint_state_info/joint_time":
                np.column_stack([np.floor(stamps), np.round(1e9 * (stamps % 1.0))]),
                "joint_state_info/joint_positions": np.zeros((len(TIMES), 7)),
                "toolpose_info/toolpose_positions": poses[:, :3],
                "toolpose_info/toolpose_orientations": 1.01 * poses[:, 3:], **replaced}
        with h5py.File(self.path(name), "w") as file:
            for key, values in data.items():
                if key not in leave_out:
                    file[key] = values
        return self.path(name)

    def csv(self, header="qw,qx,qy,qz,z,y,x,time,grip", rows=None):
        columns = dict(zip(["x", "y", "z", "qx", "qy", "qz", "qw"], motion().T), time=TIMES + 7.0,
                       grip=0 * TIMES)
        path = self.path("demo.csv")
        table = np.column_stack([columns[name] for name in header.split(",") if name in columns])
        with open(path, "w", encoding="utf-8") as stream:
            stream.write("# from elsewhere\n" + header + "\n")
            for row in table if rows is None else rows:
                stream.write(",".join(str(value) for value in row) + "\n")
        return path

    def assert_is_the_motion(self, found):
        self.assertEqual(found.times[0], 0.0)
        self.assertAlmostEqual(found.times[-1], 4.0, delta=0.03)
        np.testing.assert_allclose(np.diff(found.times), 0.05, atol=0.001)
        np.testing.assert_allclose(found.poses[:, 0], 0.3 + 0.3 * found.times / 4.0, atol=1e-5)
        np.testing.assert_allclose(found.poses[:, 2], 0.5 + 0.05 * np.sin(np.pi * found.times / 4.0),
                                   atol=1e-5)
        turned = geometry.rotation(found.poses) * Rotation.from_quat(UPRIGHT).inv()
        np.testing.assert_allclose(turned.as_rotvec()[:, 2], 0.3 * (1 - found.times / 4.0),
                                   atol=1e-5)
        np.testing.assert_allclose(found.poses[0], motion()[0], atol=1e-5)
        np.testing.assert_allclose(found.poses[-1], motion()[-1], atol=1e-5)

    def test_hdf5_with_seconds_and_nanoseconds(self):
        self.assert_is_the_motion(imports.convert(self.hdf5(), None, "test"))

    def test_hdf5_with_times_of_its_own(self):
        path = self.hdf5(leave_out=["joint_state_info/joint_time"],
                         **{"toolpose_info/toolpose_time": TIMES})
        self.assert_is_the_motion(imports.convert(path, None, "test"))

    def test_hdf5_as_the_recorders_of_a_transform_write_it(self):
        poses, stamps = motion(), 1_684_779_652 + TIMES
        with h5py.File(self.path("demo.h5"), "w") as file:
            file["joint_state_info/joint_time"] = np.zeros((len(TIMES), 2))  # not the hand's
            file["transform_info/transform_time"] = np.column_stack(
                [np.floor(stamps), np.round(1e9 * (stamps % 1.0))])
            file["transform_info/transform_positions"] = poses[:, :3]
            file["transform_info/transform_orientations"] = poses[:, 3:]
        self.assert_is_the_motion(imports.convert(self.path("demo.h5"), None, "test"))

    def test_table_with_columns_in_any_order(self):
        self.assert_is_the_motion(imports.convert(self.csv(), None, "test"))

    def test_unsaid_target_is_at_the_stand_off_on_the_cameras_axis_upright(self):
        target = imports.convert(self.csv(), None, "test").target
        hand = motion()[-1]
        camera = geometry.compose(hand, imports.CAMERA_IN_HAND)
        lateral, along = judge.tag_in_camera(camera[None], target[None])
        self.assertAlmostEqual(lateral[0], 0.0, 9)
        self.assertAlmostEqual(along[0], judge.STAND_OFF, 9)
        # Seen along the base's x: x right (-y), y up (z), z toward the viewer (-x).
        for axis, seen in (((1, 0, 0), (0, -1, 0)), ((0, 1, 0), (0, 0, 1)),
                           ((0, 0, 1), (-1, 0, 0))):
            np.testing.assert_allclose(geometry.rotation(target).apply(axis), seen, atol=1e-6)

    def test_said_target_is_kept_and_the_file_can_be_read_again(self):
        out = self.path("out.csv")
        with contextlib.redirect_stdout(io.StringIO()) as told:
            code = imports.main([self.hdf5(), out, "--target-pose", "0.8 0 0.6 0 0 0 2"])
        self.assertEqual(code, 0)
        self.assertIn(out, told.getvalue())
        found = demonstration.read(out)
        np.testing.assert_allclose(found.target, [0.8, 0.0, 0.6, 0.0, 0.0, 0.0, 1.0])
        self.assert_is_the_motion(found)

    def test_what_cannot_be_used_is_named(self):
        short = [[0.5] * 9] * 1
        cases = [
            (self.path("absent.h5"), "no such file"), (self.path("demo.txt"), "must end with"),
            (self.hdf5("a.h5", ["toolpose_info/toolpose_positions"]), "no data set toolpose_info"),
            (self.hdf5("b.h5", ["joint_state_info/joint_time"]), "toolpose_time or joint_state"),
            (self.hdf5("c.h5", **{"toolpose_info/toolpose_orientations": np.zeros((201, 3))}),
             r"shape \(201, 3\)"),
            (self.hdf5("d.h5", **{"toolpose_info/toolpose_orientations": np.zeros((201, 4))}),
             "row 1 has no orientation"),
            (self.hdf5("e.h5", **{"toolpose_info/toolpose_time": TIMES[:9]}), "9 times, 201 pos"),
            (self.hdf5("f.h5", **{"toolpose_info/toolpose_time": TIMES[::-1]}), "back at row 2"),
            (self.hdf5("g.h5", **{"toolpose_info/toolpose_time": np.nan * TIMES}), "not finite")]
        for path, why in cases:
            with self.assertRaisesRegex(demonstration.DemonstrationError, why):
                imports.convert(path, None, "test")
        for header, rows, why in (("time,x,y,z", None, "no column qx"),
                                  ("qw,qx,qy,qz,z,y,x,time,grip", short, "no motion"),
                                  ("qw,qx,qy,qz,z,y,x,time,grip", [["a"] * 9], "must be a finite number")):
            with self.assertRaisesRegex(demonstration.DemonstrationError, why):
                imports.convert(self.csv(header, rows), None, "test")

    # Fault 48: times in ns, us or ms since 1970 -> known by their size; other units -> asked for by name
    def test_units_of_time(self):
        for power in (3, 6, 9):
            stamps = (1_684_779_652 + TIMES) * 10**power
            whole = np.array([1_684_779_652 * 10**power + round(t * 10**power) for t in TIMES])
            for times in (stamps, whole):
                self.assert_is_the_motion(imports.convert(self.hdf5(
                    **{"toolpose_info/toolpose_time": times}), None, "test"))
        for power, unit in ((3, "ms"), (6, "us"), (9, "ns")):
            with self.assertRaisesRegex(demonstration.DemonstrationError,
                                        f"time spans 4e.*s, must be at most 600 s; is it in {unit}|"
                                        f"time spans 4000 s.*{unit}"):
                imports.convert(self.hdf5(**{"toolpose_info/toolpose_time": TIMES * 10**power}), None, "test")

    # Fault 48: positions in mm -> refused with row, distance and the question
    def test_millimetres_are_refused(self):
        path = self.hdf5(**{"toolpose_info/toolpose_positions": 1000.0 * motion()[:, :3]})
        with self.assertRaisesRegex(demonstration.DemonstrationError, "demo.h5: row 1 is 583.* mm"):
            imports.convert(path, None, "test")
        with self.assertRaisesRegex(demonstration.DemonstrationError, "target_pose is 1000 m"):
            imports.convert(self.hdf5(), np.array([800.0, 0, 600, 0, 0, 0, 1]), "test")

    # Fault 54: a table of a spreadsheet: byte order mark, semicolons, decimal commas, CR LF -> read
    def test_tables_of_spreadsheets(self):
        with open(self.csv(), encoding="utf-8") as stream:
            text = stream.read()
        with open(self.path("demo.csv"), "w", encoding="utf-8-sig", newline="\r\n") as stream:
            stream.write(text.replace(",", ";").replace(".", ","))
        self.assert_is_the_motion(imports.convert(self.path("demo.csv"), None, "test"))

    def test_a_file_that_is_no_hdf5_is_refused(self):
        with open(self.path("x.h5"), "wb") as stream:
            stream.write(b"nothing")
        with self.assertRaisesRegex(demonstration.DemonstrationError, "cannot be read"):
            imports.convert(self.path("x.h5"), None, "test")


if __name__ == "__main__":
    unittest.main()
