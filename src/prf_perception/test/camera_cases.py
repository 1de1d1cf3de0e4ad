# SPDX-License-Identifier: BSD-3-Clause
"""Cameras as people have them: lenses, encodings, windows and binning."""
import numpy as np
from detector_case import FOCAL, DetectorCase, frame
from sensor_msgs.msg import RegionOfInterest


class CameraCases(DetectorCase):
    def test_lens_distortion_is_taken_off(self):
        self.send(frame(0), lens=("plumb_bob", [0.0] * 5))
        self.send(frame(0), lens=("plumb_bob", [0.2, 0.0, 0.0, 0.0, 0.0]))
        self.answer(2)
        straight, bent = (a.detections[0].pose.pose.position.z for a in self.answers)
        # The mean of r^2 along an edge, a^2 + a^2 / 3 with a = 80 / 600, moves its straight fit out.
        self.assertAlmostEqual(bent / straight, 1.0 + 0.2 * 4 / 3 * (80 / FOCAL) ** 2, delta=5e-4)

    def each(self, requests):
        """The detections of each image, sent with these arguments of send()."""
        for count, request in enumerate(requests, 1):
            self.send(**request)
            self.wait(lambda count=count: len(self.answers) >= count)  # the node's queue takes ten
        return [a.detections for a in self.answers]

    # Fault 44: a lens of a model that is not known -> refused, also when all its numbers are zero
    def test_lenses_of_other_models_are_refused(self):
        lenses = [("plumb_bob", [0.1] * 8), ("kannala", [0.0] * 4), ("", [0.1]),
                  ("equidistant", []), ("rational_polynomial", [0.1] * 12)]
        self.assertEqual(self.each([{"pixels": frame(0), "lens": lens} for lens in lenses]),
                         [[]] * len(lenses))

    def test_zeros_mean_a_pinhole_for_a_model_of_the_pinhole_only(self):
        right = frame(0, columns=(540,))
        zero, plumb, rational, fisheye = (found[0].pose.pose.position for found in self.each([
            {"pixels": right, "lens": lens} for lens in (
                ("", []), ("plumb_bob", [0.0] * 5), ("rational_polynomial", [0.0] * 8),
                ("equidistant", [0.0] * 4))]))
        self.assertEqual((zero, zero), (plumb, rational))
        self.assertAlmostEqual(zero.x / zero.z, 220.5 / FOCAL, delta=2e-3)
        self.assertAlmostEqual(fisheye.x / fisheye.z, np.tan(220.5 / FOCAL), delta=2e-3)

    def test_what_cv_bridge_turns_into_grey_is_read(self):
        grey = frame(0)
        wide = grey.astype(np.uint16) * 257
        images = {"8UC1": grey, "mono16": wide, "yuv422": np.dstack([np.full_like(grey, 128), grey])}
        for kind, planes in (("bgr", 3), ("rgb", 3), ("bgra", 4), ("rgba", 4)):
            images[kind + "8"], images[kind + "16"] = (
                np.ascontiguousarray(np.repeat(image[:, :, None], planes, 2)) for image in (grey, wide))
        for pattern in ("rggb", "bggr", "gbrg", "grbg"):
            images[f"bayer_{pattern}8"], images[f"bayer_{pattern}16"] = grey, wide
        found = self.each([{"pixels": image, "encoding": name} for name, image in images.items()])
        for name, tags in zip(images, found):
            with self.subTest(encoding=name):
                self.assertEqual([tag.id for tag in tags], [0])
                self.assertAlmostEqual(tags[0].pose.pose.position.z, 0.375, delta=4e-3)

    def test_window_and_binning_move_and_scale_the_camera(self):
        """The image is 640 x 480 of a sensor that is larger; K is of the whole sensor."""
        def sensor(width, height, roi=None, binning=1, focal=FOCAL):
            def change(_, info):
                info.width, info.height, info.binning_x, info.binning_y = width, height, binning, binning
                info.K = [focal, 0, 800.0, 0, focal, 600.0, 0, 0, 1]
                info.roi = RegionOfInterest(*roi) if roi else RegionOfInterest()
            return {"pixels": frame(0), "change": change}
        # x_offset, y_offset, height, width, do_rectify; the tag's centre is at 319.5, 239.5.
        window, binned, both, *refused = self.each([
            sensor(1600, 1200, (480, 360, 480, 640, True)),
            sensor(1280, 960, None, 2, 2 * FOCAL),
            sensor(1600, 1200, (160, 120, 960, 1280, False), 2, 2 * FOCAL),
            sensor(640, 480, (480, 360, 480, 640, True)),  # the window's own size as the sensor's
            sensor(1600, 1200, (480, 360, 0, 0, False)), sensor(1600, 1200, None, 2),
            sensor(1600, 1200, (480, 360, 480, 640, False), 2)])
        self.assertEqual(refused, [[]] * 4)
        for found, axis in ((window, (320, 240)), (binned, (400, 300)), (both, (320, 240))):
            place = found[0].pose.pose.position
            self.assertAlmostEqual(place.z, 0.375, delta=2e-3)
            self.assertAlmostEqual(place.x / place.z, (319.5 - axis[0]) / FOCAL, delta=1e-3)
            self.assertAlmostEqual(place.y / place.z, (239.5 - axis[1]) / FOCAL, delta=1e-3)
