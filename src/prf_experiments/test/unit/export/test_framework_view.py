# SPDX-License-Identifier: BSD-3-Clause
import unittest

import numpy as np
import sensor_msgs.msg
from prf_experiments.export import additions, framework_view

from prf_msgs.msg import ExecutionProgress, TagDetection, TargetForecast, TargetPrediction


class FrameworkView(unittest.TestCase):
    def test_an_ellipsoid_has_four_standard_deviations_along_the_principal_axes(self):
        turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
        covariance = turn @ np.diag([0.01, 0.04, 0.09]) @ turn.T
        (diameters,), (orientation,) = additions.ellipsoids(covariance[np.newaxis])
        axes = additions.Rotation.from_quat(orientation).as_matrix()
        np.testing.assert_allclose(axes @ np.diag((diameters / 4.0) ** 2) @ axes.T, covariance, atol=1e-12)
        self.assertAlmostEqual(np.linalg.det(axes), 1.0)

    def test_a_covariance_that_is_not_finite_is_not_drawn(self):
        forecast = TargetForecast(predictions=[TargetPrediction(covariance=[0.01] * 36)])
        self.assertEqual(len(framework_view.ellipsoids(forecast).markers), 2)
        forecast.predictions[0].covariance = [np.nan] * 36
        self.assertEqual(len(framework_view.ellipsoids(forecast).markers), 1)  # the one that deletes

    def test_state_is_told_by_name_with_its_reason(self):
        progress = ExecutionProgress(state=ExecutionProgress.PAUSE, reason="target lost")
        self.assertEqual(framework_view.state_text(progress).text, "PAUSE\ntarget lost")

    def test_tags_are_outlined_in_the_image(self):
        grey = sensor_msgs.msg.Image(height=20, width=40, step=40, encoding="mono8", data=bytes(800))
        tag = TagDetection(corners_px=[5, 15, 15, 15, 15, 5, 5, 5])
        drawn = framework_view.outlined(grey, [tag])
        pixels = np.frombuffer(drawn.data, np.uint8).reshape(20, 40, 3)
        self.assertEqual(drawn.encoding, "rgb8")
        self.assertEqual(tuple(pixels[15, 10]), framework_view.GREEN)
        self.assertEqual(pixels[10, 10].sum(), 0)

    def test_an_image_of_another_encoding_stays(self):
        depth = sensor_msgs.msg.Image(height=1, width=1, step=2, encoding="16UC1", data=bytes(2))
        self.assertIs(framework_view.outlined(depth, []), depth)


if __name__ == "__main__":
    unittest.main()
