# SPDX-License-Identifier: BSD-3-Clause
"""A reduced sweep on a Dask cluster of two workers that share nothing but the results folder: the
task is done, what is left behind is what was promised, and a browser finds its way through it.
"""
import contextlib
import json
import os
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, os.path.dirname(__file__))
import runs

WORDS = ("table", "--seeds", "1", "motion:=none,light", "gait:=stand", "framework:=true",
         "--keep-bags", "all")


def dask(program, home, *words):
    """A process of the cluster with a home, a scratch folder and a working directory of its own."""
    os.makedirs(home)
    own = dict.fromkeys(("HOME", "TMPDIR", "ROS_HOME"), home)
    return subprocess.Popen([sys.executable, "-m", f"distributed.cli.dask_{program}", *words],
                            cwd=home, env={**os.environ, **own}, stdin=subprocess.DEVNULL,
                            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


@contextlib.contextmanager
def browser():
    """Headless Chromium."""
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
    options = webdriver.ChromeOptions()
    for word in ("--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage"):
        options.add_argument(word)
    page = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
    try:
        yield page
    finally:
        page.quit()


def scheduler_address(path):
    end = time.monotonic() + 60.0
    while time.monotonic() < end:
        try:
            with open(path, encoding="utf-8") as stream:
                return json.load(stream)["address"]
        except (OSError, ValueError):
            time.sleep(0.1)
    raise AssertionError("the Dask scheduler does not start")


class ReducedSweep(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.results = os.path.join(folder.name, "results")
        cls.homes = [os.path.join(folder.name, name) for name in ("one", "two")]
        cls.json = os.path.join(folder.name, "table.json")
        cluster = cls.start_cluster(folder.name)
        try:
            cls.run_ = runs.run("experiment", *WORDS, "--scheduler", cluster[0],
                                "--json", cls.json, f"results:={cls.results}")
        finally:
            for process in cluster[1]:
                process.terminate()
                process.wait(60.0)
        cls.left_over = runs.processes_of(cls.results)

    @classmethod
    def start_cluster(cls, folder):
        file = os.path.join(folder, "scheduler.json")
        processes = [dask("scheduler", os.path.join(folder, "scheduler"), "--port", "0",
                          "--no-dashboard", "--host", "127.0.0.1", "--scheduler-file", file)]
        address = scheduler_address(file)
        processes += [dask("worker", home, address, "--nthreads", "1", "--no-nanny",
                           "--no-dashboard", "--local-directory", home) for home in cls.homes]
        return address, processes

    @property
    def trials(self):
        place = os.path.join(self.results, "table", "trials")
        return [os.path.join(place, name) for name in sorted(os.listdir(place))
                if not name.endswith(".failed")]  # a first attempt on a very busy machine

    def test_succeeds_on_a_still_and_on_a_lightly_moving_platform(self):
        self.assertEqual(self.run_.code, 0, self.run_.out + self.run_.error)
        with open(self.json, encoding="utf-8") as stream:
            content = json.load(stream)
        for trial in content["trials"]:
            self.assertEqual(trial["verdict"], "S", trial["reason"])
            self.assertTrue(trial["inspected"], trial["reason"])
        self.assertEqual([cell["motion"] for cell in content["cells"]], ["none", "light"])

    def test_leaves_evidence_and_no_process(self):
        self.assertEqual(len(self.trials), 2)
        for trial in self.trials:
            for name in ("trial.bag", "verdict.json", "report.html", "parameters.yaml", "log"):
                self.assertTrue(os.path.exists(os.path.join(trial, name)), name)
        self.assertEqual(self.left_over, [])

    def test_both_workers_took_part(self):
        for home in self.homes:
            self.assertTrue(any(name.startswith("rospack_cache") for name in os.listdir(home)),
                            os.listdir(home))

    def test_a_second_run_on_this_machine_keeps_every_trial(self):
        run = runs.run("experiment", *WORDS, f"results:={self.results}")
        self.assertEqual(run.code, 0, run.out + run.error)
        self.assertIn("2 of them finished before", run.out)
        self.assertIn("0 trials in", run.out)

    def test_a_browser_goes_from_the_table_to_a_trial(self):
        from selenium.webdriver.support.ui import WebDriverWait
        with browser() as page:
            page.get("file://" + os.path.join(self.results, "table", "index.html"))
            self.assertEqual(page.title, "Trials")
            page.find_element("css selector", "a.test").click()
            self.assertEqual(page.title, "Trial S")
            self.assertIn("motion-none", page.current_url)
            self.assertIn("TRACKING", page.find_element("css selector", ".timeline").text)
            for plots in page.find_elements("css selector", ".plots"):
                page.execute_script("arguments[0].scrollIntoView()", plots)
                WebDriverWait(page, 30).until(
                    lambda _, plots=plots: plots.find_elements("css selector", ".bk-Figure, .bk-GridPlot"))
            film = "return document.querySelector('video')"
            WebDriverWait(page, 30).until(lambda _: page.execute_script(film + ".duration > 5"))
            drawn = page.execute_script(
                "return Array.from(document.images).map(i => i.complete ? i.naturalWidth : 0)")
            self.assertGreaterEqual(len(drawn), 3)
            self.assertGreater(min(drawn), 0)
            fetched = page.execute_script(
                "return performance.getEntriesByType('resource').map(e => e.name)")
            self.assertEqual([name for name in fetched if not name.startswith(("data:", "blob:"))], [])
            page.find_element("css selector", ".back a").click()
            self.assertEqual(page.title, "Trials")


if __name__ == "__main__":
    unittest.main()
