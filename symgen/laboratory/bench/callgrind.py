"""Instructions a call, from valgrind's callgrind: exact from run to run, library functions included."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Collection
from pathlib import Path


def find_valgrind() -> str | None:
    """The valgrind of this machine, or None."""
    return shutil.which("valgrind")


def count_instructions(program: Path, states: int, entries: Collection[str]) -> dict[str, float]:
    """Mean instructions of one call of each entry over the first `states` states."""
    profile = program.parent / "callgrind.out"
    command = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={profile}"]
    command += ["--compress-strings=no", "--compress-pos=no", str(program), "count", str(states)]
    subprocess.run(command, cwd=program.parent, check=True, capture_output=True)
    return inclusive_costs(profile.read_text(encoding="utf-8", errors="replace"), entries)


def inclusive_costs(profile: str, entries: Collection[str]) -> dict[str, float]:
    """Inclusive cost of one call of each entry, from a profile with uncompressed strings.

    A line `calls=N ...` after `cfn=NAME` is followed by a line with the position and the inclusive cost of those calls.
    """
    costs: dict[str, tuple[int, int]] = {}
    callee, calls = "", 0
    for line in profile.splitlines():
        if line.startswith("cfn="):
            callee = line[4:].strip()
        elif line.startswith("calls="):
            calls = int(line[6:].split()[0])
        elif calls:
            if callee in entries:
                before = costs.get(callee, (0, 0))
                costs[callee] = (before[0] + calls, before[1] + int(line.split()[1]))
            calls = 0
    return {entry: cost / number for entry, (number, cost) in costs.items()}
