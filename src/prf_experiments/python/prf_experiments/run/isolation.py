# SPDX-License-Identifier: BSD-3-Clause
"""A trial in a network namespace of its own: nobody outside can reach its nodes. See docs/security.md."""
import fcntl
import os
import socket
import struct
import subprocess
import sys
from collections.abc import Sequence

MARK = "PRF_EXPERIMENTS_ISOLATED"  # environment variable of what runs inside
SIOCGIFFLAGS, SIOCSIFFLAGS, IFF_UP = 0x8913, 0x8914, 0x1


class IsolationError(Exception):
    """This process may not have a namespace of its own; the message says why."""


def is_inside() -> bool:
    return os.environ.get(MARK) == "1"


def prefix() -> list[str]:
    """The command that runs another one in a new network namespace. Raises IsolationError."""
    words = ["unshare", "--net"]
    if os.geteuid() != 0:
        words += ["--user", "--map-root-user"]
    try:
        probe = subprocess.run([*words, "true"], capture_output=True, text=True, check=False,
                               timeout=10)
    except (OSError, subprocess.TimeoutExpired) as error:
        raise IsolationError(f"isolated:=true needs the program unshare: {error}") from None
    if probe.returncode != 0:
        raise IsolationError("isolated:=true is not possible here, this user may make no network "
                             f"namespace: {probe.stderr.strip()}; leave it out, or allow user namespaces")
    return words


def enter(module: str, words: Sequence[str]) -> None:
    """Runs the module again inside, in place of this process. Raises IsolationError."""
    command = [*prefix(), sys.executable, "-m", module, *words]
    os.execvpe(command[0], command, {**os.environ, MARK: "1"})


def raise_loopback() -> None:
    """A new namespace has a loopback interface that is down."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as any_socket:
        request = struct.pack("16sH14x", b"lo", 0)
        flags = struct.unpack("16sH14x", fcntl.ioctl(any_socket, SIOCGIFFLAGS, request))[1]
        fcntl.ioctl(any_socket, SIOCSIFFLAGS, struct.pack("16sH14x", b"lo", flags | IFF_UP))
