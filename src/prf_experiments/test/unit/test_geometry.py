# SPDX-License-Identifier: BSD-3-Clause
import unittest

import numpy as np

from prf_experiments import geometry


def random_poses(count, seed):
    generator = np.random.default_rng(seed)
    quaternions = generator.normal(size=(count, 4))
    quaternions /= np.linalg.norm(quaternions, axis=1, keepdims=True)
    return np.hstack([generator.normal(size=(count, 3)), quaternions])


class Geometry(unittest.TestCase):
    def test_a_pose_and_its_inverse_cancel(self):
        poses = random_poses(100, 1)
        cancelled = geometry.compose(poses, geometry.inverse(poses))
        np.testing.assert_allclose(cancelled[:, :3], 0.0, atol=1e-12)
        np.testing.assert_allclose(np.abs(cancelled[:, 6]), 1.0)

    def test_composition_is_associative(self):
        a, b, c = (random_poses(50, seed) for seed in (1, 2, 3))
        np.testing.assert_allclose(geometry.compose(geometry.compose(a, b), c),
                                   geometry.compose(a, geometry.compose(b, c)), atol=1e-12)

    def test_rotation_keeps_length_and_follows_the_product(self):
        p, q, v = random_poses(50, 1)[:, 3:], random_poses(50, 2)[:, 3:], random_poses(50, 3)[:, :3]
        np.testing.assert_allclose(geometry.rotate(geometry.multiply(p, q), v),
                                   geometry.rotate(p, geometry.rotate(q, v)), atol=1e-12)

    def test_quarter_turn_about_z_takes_x_to_y(self):
        turn = geometry.exp([0.0, 0.0, np.pi / 2])
        np.testing.assert_allclose(geometry.rotate(turn, [1.0, 0.0, 0.0]), [0, 1, 0], atol=1e-12)

    def test_log_undoes_exp(self):
        for vector in np.random.default_rng(4).normal(size=(50, 3)) * 0.9:
            np.testing.assert_allclose(geometry.log(geometry.exp(vector)), vector, atol=1e-9)
        np.testing.assert_allclose(geometry.log([0, 0, 0, 1.0]), np.zeros(3))

    def test_slerp_takes_the_shorter_arc_at_even_pace(self):
        start, end = geometry.exp([0.2, 0.0, 0.0]), -geometry.exp([0.6, 0.0, 0.0])
        np.testing.assert_allclose(geometry.log(geometry.slerp(start, end, 0.25)), [0.3, 0, 0],
                                   atol=1e-12)

    def test_mean_of_quaternions_ignores_their_sign(self):
        turns = [geometry.exp([0.0, angle, 0.0]) for angle in (-0.1, 0.1, 0.3)]
        mean = geometry.mean_quaternion([turns[0], -turns[1], turns[2]])
        np.testing.assert_allclose(geometry.log(mean), [0.0, 0.1, 0.0], atol=1e-4)


if __name__ == "__main__":
    unittest.main()
