# SPDX-License-Identifier: BSD-3-Clause
"""The node record_run of real_robot.launch: records a robot's run until it is ended, for judge and report."""
import json
import os
import tempfile
import time

import rospy
import std_msgs.msg

from prf_experiments.record import estimated, topics
from prf_experiments.run import arguments as args
from prf_experiments.run import names, processes, session, trial

RECORDED = [name for name in topics.TABLE.recorded if name not in topics.GROUND_TRUTH] + [estimated.STAND_IN]


def describe(demonstration: str, driver: str) -> dict:
    """What the bag says of itself."""
    return {"command": "roslaunch prf_experiments real_robot.launch", "arguments": {"demonstration": demonstration},
            "tick_s": names.driver_period(driver), "versions": trial.versions()}


def main(words: list[str]) -> int:
    words = [word for word in words if not word.startswith("__") and ":=" not in word]  # of roslaunch
    parser = args.Parser(prog="record_run", description=__doc__)
    parser.add_argument("bag")
    parser.add_argument("--demonstration", default="")
    parser.add_argument("--driver", default="")
    options = parser.parse_args(words)

    def action():
        bag = args.plain_path(options.bag)
        session.check_space(os.path.dirname(bag))
        if os.path.exists(bag):
            raise session.SessionError(f"{bag} is there already: give another name")
        rospy.init_node("record_run", argv=["record_run"])
        publisher = rospy.Publisher("/" + topics.DESCRIPTION, std_msgs.msg.String, latch=True, queue_size=1)
        publisher.publish(json.dumps(describe(options.demonstration, options.driver), sort_keys=True))
        with tempfile.TemporaryDirectory() as logs:
            recorder = processes.Recorder(bag, RECORDED, os.path.join(logs, "recorder.log"), "recorder")
            try:
                while not rospy.is_shutdown():
                    recorder.check()
                    time.sleep(0.2)
            finally:
                recorder.stop()
        return 0
    return session.guarded("record_run", action)
