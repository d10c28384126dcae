"""What of a machine is impossible or says nothing, whatever format it is from."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from symgen.diagnostics import Mistake
from symgen.model.robots.machine import Machine
from symgen.model.robots.reader import MAXIMUM_ANGLE


def check_machine(machine: Machine, ranged: Collection[str]) -> Iterator[Mistake]:
    """Axes without direction and ranges without a way; `ranged` are the joints whose ranges the model file gives."""
    for joint in machine.joints:
        if joint.kind in ("revolute", "prismatic") and not any(joint.axis):
            remedy = "give its direction, such as 0 0 1"
            yield Mistake(f"the axis of the joint `{joint.name}` has length zero", remedy, joint.span)
        lower, upper = joint.values.get("lower"), joint.values.get("upper")
        if lower is None or upper is None or joint.name in ranged:
            continue
        if lower.value >= upper.value:
            shown = " and ".join(f"{float(end.value):.6g}" for end in (lower, upper))
            message = f"the limits of the joint `{joint.name}` leave no way between {shown}"
            yield Mistake(message, "give the lower one first, or remove both", lower.span)
        elif joint.kind == "revolute" and max(abs(lower.value), abs(upper.value)) > MAXIMUM_ANGLE:
            message = f"the joint `{joint.name}` turns by more than {MAXIMUM_ANGLE} rad"
            yield Mistake(message, "remove its limits", upper.span)
