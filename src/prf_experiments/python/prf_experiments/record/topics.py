# SPDX-License-Identifier: BSD-3-Clause
"""Which topics a trial's bag holds, by the one table of interfaces in prf_msgs.

The list is explicit, so that a topic that is missing in a bag is noticed.
"""
from prf_msgs import interfaces

TABLE = interfaces.load()

CLOCK = TABLE.of_kind("clock")
SENSORS = TABLE.of_kind("sensor")
SURROUNDINGS = TABLE.of_kind("surroundings")
GROUND_TRUTH = TABLE.of_kind("ground_truth")
OUTPUTS = TABLE.of_kind("output")
TRANSFORMS = TABLE.of_kind("transform")
EXEMPT = TABLE.of_kind("exempt")
DESCRIPTION, = TABLE.of_kind("description")
EVENTS = "fault/events"  # of the fault injector
GUIDE, = TABLE.of_kind("teaching", recorded=False)
