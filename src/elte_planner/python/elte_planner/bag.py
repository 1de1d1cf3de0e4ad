# SPDX-License-Identifier: BSD-3-Clause
"""Demonstrations from bags. Needs rosbag and scipy, and only when a bag is read."""
import numpy as np

from elte_planner._core import Demonstration


def _row(pose):
    return [pose.position.x, pose.position.y, pose.position.z, pose.orientation.x,
            pose.orientation.y, pose.orientation.z, pose.orientation.w]


def _messages(path, topic):
    try:
        from prf_msgs import bags
    except ImportError as error:
        raise ImportError(f"{path}: a bag is read with rosbag of ROS 1, which this Python has not ({error})") from None
    try:
        with bags.opened(path) as bag:
            found = [message for _, message, _ in bag.read_messages(topics=["/" + topic.lstrip("/")])]
    except bags.BagError as error:
        raise ValueError(str(error)) from None
    if not found:
        raise ValueError(f"{path}: nothing on topic '{topic}', `rosbag info` lists what it holds")
    return found


def _expect(messages, kind, path, topic):
    if messages[0]._type != kind:
        raise ValueError(f"{path}: topic '{topic}' is a {messages[0]._type}, must be a {kind}")


def _target_of_plan(last, goal_in_target):
    """Target T with T * goal_in_target = last, all x y z qx qy qz qw."""
    from scipy.spatial.transform import Rotation
    turn = Rotation.from_quat(last[3:]) * Rotation.from_quat(goal_in_target[3:]).inv()
    quaternion = turn.as_quat()  # of either sign; that with w >= 0 is taken
    return np.concatenate([last[:3] - turn.apply(goal_in_target[:3]),
                           np.copysign(1.0, quaternion[3]) * quaternion])


def load_bag(path, topic, target_topic=None):
    """Demonstration from a topic of a bag: geometry_msgs/PoseStamped, one message per sample, or
    prf_msgs/SkillTrajectory, of which the last plan is taken, with its target.

    target_topic: geometry_msgs/PoseStamped in the same frame, of which the last is the target's
    pose. Without it the target of poses is taken to be where the demonstration ends. Raises
    ValueError with file, topic and reason; ImportError without rosbag.
    """
    path = str(path)
    messages = _messages(path, topic)
    if messages[0]._type == "prf_msgs/SkillTrajectory":
        plans = [message for message in messages if message.poses]
        if not plans:
            raise ValueError(f"{path}: no plan on topic '{topic}', `rosbag info` lists what it holds")
        frame = plans[-1].header.frame_id
        times = [duration.to_sec() for duration in plans[-1].time_from_start]
        rows = np.array([_row(pose) for pose in plans[-1].poses])
        goal_in_target = np.array(_row(plans[-1].goal_in_target))
    else:
        _expect(messages, "geometry_msgs/PoseStamped", path, topic)
        frame = messages[0].header.frame_id
        if any(message.header.frame_id != frame for message in messages):
            raise ValueError(f"{path}: topic '{topic}' is in several frames, must be in one")
        start = messages[0].header.stamp
        times = [(message.header.stamp - start).to_sec() for message in messages]
        rows = np.array([_row(message.pose) for message in messages])
        goal_in_target = np.array([0, 0, 0, 0, 0, 0, 1])
    target = None
    if target_topic is not None:
        targets = _messages(path, target_topic)
        _expect(targets, "geometry_msgs/PoseStamped", path, target_topic)
        if targets[-1].header.frame_id != frame:
            raise ValueError(f"{path}: topic '{target_topic}' is in frame "
                             f"'{targets[-1].header.frame_id}', must be in '{frame}'")
        target = np.array(_row(targets[-1].pose))
    try:
        if target is None:
            target = _target_of_plan(rows[-1], goal_in_target)
        return Demonstration(np.array(times), rows[:, :3], rows[:, 3:], frame, topic, target)
    except ValueError as error:
        raise ValueError(f"{path}: topic '{topic}': {error}") from None
