# SPDX-License-Identifier: BSD-3-Clause
import unittest

import numpy as np
from scipy.spatial.transform import Rotation

from prf_experiments import geometry


def random_poses(count, seed):
    random = np.random.default_rng(seed)
    return geometry.make(random.normal(size=(count, 3)), Rotation.random(count, random_state=seed))


def matrix(pose):
    """Homogeneous matrix of a pose, by the formula of its quaternion."""
    x, y, z, w = pose[3:]
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), pose[0]],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), pose[1]],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), pose[2]],
        [0, 0, 0, 1]])


class Geometry(unittest.TestCase):
    def test_composition_is_the_product_of_the_matrices(self):
        first, second = random_poses(20, 1), random_poses(20, 2)
        for a, b, c in zip(first, second, geometry.compose(first, second)):
            np.testing.assert_allclose(matrix(c), matrix(a) @ matrix(b), atol=1e-12)

    def test_inverse_is_the_inverse_of_the_matrix(self):
        for pose in random_poses(20, 3):
            np.testing.assert_allclose(matrix(geometry.inverse(pose)), np.linalg.inv(matrix(pose)),
                                       atol=1e-12)

    def test_one_pose_goes_with_many_on_either_side(self):
        one, many = random_poses(1, 4)[0], random_poses(5, 5)
        for row in range(5):
            np.testing.assert_allclose(geometry.compose(one, many)[row],
                                       geometry.compose(one, many[row]), atol=1e-15)
            np.testing.assert_allclose(geometry.compose(many, one)[row],
                                       geometry.compose(many[row], one), atol=1e-15)

    def test_quarter_turn_about_z_takes_x_to_y(self):
        turned = [0.0, 0.0, 0.0, 0.0, 0.0, np.sqrt(0.5), np.sqrt(0.5)]
        np.testing.assert_allclose(geometry.compose(turned, [1.0, 0, 0, 0, 0, 0, 1])[:3], [0, 1, 0],
                                   atol=1e-12)

    def test_what_is_not_finite_stays_so_and_touches_nothing_else(self):
        poses, known = random_poses(3, 6), random_poses(3, 7)
        expected = geometry.compose(known, poses)
        poses[1] = np.nan
        found = geometry.compose(known, poses)
        self.assertTrue(np.all(np.isnan(found[1])))
        np.testing.assert_array_equal(found[[0, 2]], expected[[0, 2]])
        self.assertTrue(np.all(np.isnan(geometry.inverse(poses)[1])))


if __name__ == "__main__":
    unittest.main()
