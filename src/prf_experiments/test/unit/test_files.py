# SPDX-License-Identifier: BSD-3-Clause
import os
import subprocess
import sys
import tempfile
import unittest

from prf_experiments import files

FULL = "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0)); "
EVALUATE = FULL + """
import sys
from prf_experiments.run import session, trial
content = trial.evaluate(sys.argv[1], {"arguments": {}}, None, "recorder ended", session.ProgressLine(),
                         draw="false")
print(content["verdict"], content["reason"])
"""


class Files(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.path = os.path.join(self.folder, "verdict.json")

    def test_a_file_appears_with_its_whole_content_and_alone(self):
        files.write_json(self.path, {"verdict": "S"})
        files.write(self.path, "new\n")
        self.assertEqual(os.listdir(self.folder), ["verdict.json"])
        with open(self.path, encoding="utf-8") as stream:
            self.assertEqual(stream.read(), "new\n")

    def on_a_full_disk(self, code, *words):
        return subprocess.run([sys.executable, "-c", code, *words], capture_output=True, text=True,
                              check=False, timeout=60)

    # Fault 49: the disk is full while a file is written -> the old file stays, no part of a new one
    def test_on_a_full_disk_the_old_file_stays_whole(self):
        files.write(self.path, "old\n")
        run = self.on_a_full_disk(
            FULL + "import sys; from prf_experiments import files; files.write(sys.argv[1], 'new')",
            self.path)
        self.assertIn("OSError", run.stderr)
        self.assertEqual(os.listdir(self.folder), ["verdict.json"])
        with open(self.path, encoding="utf-8") as stream:
            self.assertEqual(stream.read(), "old\n")

    # Fault 49: the verdict cannot be written -> INVALID with the reason is printed, no file of 0 bytes
    def test_a_verdict_that_cannot_be_written_is_invalid_without_a_traceback(self):
        run = self.on_a_full_disk(EVALUATE, self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("INVALID the results cannot be written", run.stdout)
        self.assertIn("recorder ended", run.stdout)
        self.assertEqual(os.listdir(self.folder), [])

    # Fault 49: the results folder vanishes -> INVALID with the reason, no traceback
    def test_a_folder_that_vanished_is_told(self):
        os.rmdir(self.folder)
        try:
            run = self.on_a_full_disk(EVALUATE, self.folder)
        finally:
            os.mkdir(self.folder)
        self.assertIn("No such file or directory", run.stdout)
        self.assertEqual(run.stderr, "")

    def test_a_device_is_written_to_and_not_replaced(self):
        files.write("/dev/null", "text")
        self.assertFalse(os.path.isfile("/dev/null"))


if __name__ == "__main__":
    unittest.main()
