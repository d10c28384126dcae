"""What is said of a task with fewer functions than there are directions of motion."""

from __future__ import annotations

from symgen.model.model import Model


def directions(count: int) -> str:
    """So many directions, in words."""
    return f"{count} direction{'s' if count > 1 else ''}"


def left_open(model: Model) -> str:
    """How many directions of motion a task leaves open."""
    return f"the task leaves {directions(model.task_leaves.rates)} open"


def norm_of_motions(model: Model) -> str:
    """By what motions along these directions are compared: units that stand side by side there are a choice."""
    units = dict.fromkeys(c.unit or "no unit" for c in model.coordinates)
    beside = f", {' beside '.join(units)}" if len(units) > 1 else ""
    return f"in the Euclidean norm of the coordinates as they stand{beside}"
