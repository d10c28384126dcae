"""Derivatives of the reference by central differences in many digits.

A step of 2^(-b/3) at b binary digits leaves two thirds of them: what is left out and what is rounded are as large.
Second derivatives take steps of 2^(-b/4) both ways, which leave half.
They share nothing with the rules by which kernels are differentiated.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, Literal, TypeAlias

from flint import arb, arb_mat, ctx

from symgen.verify.reference.evaluation import Evaluation

Part: TypeAlias = Literal["q", "qd", "qdd", "u", "parameters"]
# What depends on q and parameters alone, which a change of rates leaves as it is.
AT_REST = (
    "at", "inverse", "projector_off", "projector", "projected_control", "driven", "control_inverse", "weighted",
)  # fmt: skip


def slopes(e: Evaluation, value: Callable[[Evaluation], Any], part: Part, digits: int = 3) -> list[Any]:
    """The derivatives of a column by each entry of q, qd, qdd, u or the parameters, a column each.

    The step is 2^(-b/digits).
    """
    step = arb(2) ** -(ctx.prec // digits)
    value(e)  # what it takes of AT_REST is known from here on
    columns = []
    for k in range(len(getattr(e, part))):
        above, below = (value(one) for one in _moved(e, part, k, step))
        columns.append((above - below) / (2 * step))
    return columns


def _moved(e: Evaluation, part: Part, k: int, step: Any) -> Iterator[Evaluation]:
    """The state with one entry a step further, and a step back."""
    at_rest = {name: e.__dict__[name] for name in AT_REST if name in e.__dict__}
    for sign in (1, -1):
        entries = list(getattr(e, part))
        entries[k] = entries[k] + sign * step
        state: dict[str, Any] = {part: entries, "derivatives": {}}
        moved = replace(e, **state)
        if part not in ("q", "parameters"):
            moved.__dict__.update(at_rest)
        yield moved


def jacobian(e: Evaluation, value: Callable[[Evaluation], Any], by: Sequence[Part]) -> Any:
    """The derivatives of a column (k x 1) by parts of the state, beside each other."""
    columns = [slope for part in by for slope in slopes(e, value, part)]
    rows = columns[0].nrows()
    return arb_mat(rows, len(columns), [column[i, 0] for i in range(rows) for column in columns])


def curvature(e: Evaluation, value: Callable[[Evaluation], Any], direction: Mapping[Part, Sequence[Any]]) -> Any:
    """The second derivatives of a number (1 x 1) by parts of the state times a direction of these, a column.

    Four values for each entry: on either side of it, a step ahead along the direction and a step back.
    """
    step = arb(2) ** -(ctx.prec // 4)
    ends = []
    for sign in (1, -1):
        state: dict[str, Any] = {"derivatives": {}}
        for part, rates in direction.items():
            state[part] = [x + sign * step * v for x, v in zip(getattr(e, part), rates, strict=True)]
        end = replace(e, **state)
        ends.append([slope[0, 0] for part in direction for slope in slopes(end, value, part, digits=4)])
    return arb_mat(len(ends[0]), 1, [(ahead - back) / (2 * step) for ahead, back in zip(*ends, strict=True)])
