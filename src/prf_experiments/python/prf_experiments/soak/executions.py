# SPDX-License-Identifier: BSD-3-Clause
"""Asks for executions again and again, and notes what became of each."""
import threading
from dataclasses import dataclass

import actionlib
import rospy

from prf_msgs.msg import ExecuteSkillAction, ExecuteSkillGoal, ExecuteSkillResult

TIME_LIMIT = 60.0  # s of data for one execution
GRACE = 10.0  # s beyond it until an answer counts as lost
REST = 1.0  # s of data between two
CODES = {value: name for name, value in vars(ExecuteSkillResult).items()
         if name.isupper() and isinstance(value, int)}


@dataclass
class Execution:
    begin: int  # ns of data
    end: int
    result: str  # name of the code, or LOST
    text: str


class Executions(threading.Thread):
    def __init__(self):
        super().__init__(daemon=True)
        self.done: list[Execution] = []
        self.running_since: int | None = None
        self._stopping = threading.Event()

    def run(self) -> None:
        client = actionlib.SimpleActionClient("execute_skill", ExecuteSkillAction)
        try:
            while not self._stopping.is_set():
                if client.wait_for_server(rospy.Duration(1.0)):
                    self._execute(client)
                rospy.sleep(REST)
        except rospy.ROSInterruptException:
            pass  # the session is over

    def _execute(self, client):
        begin = rospy.Time.now().to_nsec()
        self.running_since = begin
        client.send_goal(ExecuteSkillGoal(time_limit=rospy.Duration(TIME_LIMIT)))
        answered = client.wait_for_result(rospy.Duration(TIME_LIMIT + GRACE))
        result = client.get_result() if answered else None
        if not answered:
            client.cancel_goal()
        self.done.append(Execution(
            begin, rospy.Time.now().to_nsec(),
            "LOST" if result is None else CODES.get(result.code, str(result.code)),
            "no answer" if result is None else result.text))
        self.running_since = None

    def stop(self) -> None:
        self._stopping.set()
