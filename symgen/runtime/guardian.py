"""Ends the tools of a run that is killed: a small shell waits for the end of a pipe that only the run holds open.

A signal that a process cannot catch leaves what it started at work, and what the kernel can send instead reaches a
compiler's driver but not the compiler proper.
"""

from __future__ import annotations

import os
import shutil

# Lines of `+ group` and `- group`; at the end of the run every group that is left is killed.
_SCRIPT = """
left=""
while read -r sign group; do
    rest=""
    for one in $left; do [ "$one" = "$group" ] || rest="$rest $one"; done
    left="$rest"
    [ "$sign" = "-" ] || left="$left $group"
done
for one in $left; do kill -s KILL -- "-$one" 2>/dev/null; done
"""
_pipe: int | None = None


def watch(group: int) -> None:
    """The process group is killed should this process end without `forget`."""
    _send(f"+ {group}\n")


def forget(group: int) -> None:
    """The process group has ended."""
    _send(f"- {group}\n")


def _send(line: str) -> None:
    global _pipe
    if os.name != "posix":
        return
    if _pipe is None:
        _pipe = _guardian()
    try:
        if _pipe is not None:
            os.write(_pipe, line.encode())
    except BrokenPipeError:
        _pipe = None


def _guardian() -> int | None:
    """The end of the pipe to write to; None where there is no shell."""
    shell = shutil.which("sh")
    if shell is None:
        return None
    far, near = os.pipe()
    actions = [
        (os.POSIX_SPAWN_DUP2, far, 0),
        # a reader of this run's output must not wait for the guardian
        *((os.POSIX_SPAWN_OPEN, number, os.devnull, os.O_WRONLY, 0) for number in (1, 2)),
    ]
    # in a group of its own, which an interrupt at the terminal does not reach
    os.posix_spawn(shell, [shell, "-c", _SCRIPT], os.environ, file_actions=actions, setpgroup=0)
    os.close(far)
    return near
