"""What kernels are given at a state: its parts, and as measured values what encoders say a moment later.

Where the machine is then it has not been seen, which is what measured values are good for: a configuration is looked
for from the one before.  Rates and accelerations are measured as they are.  Weights are the numbers that the inputs and
accelerations of a state are, on which what is weighted does not depend; rates and accelerations of the task are those
of coordinates likewise.  A direction of (q, qd, qdd) is (qd, qdd, q), none of the state's own.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from symgen.backends.locals import array_arguments
from symgen.ir.kernel import Argument, Kernel, Load
from symgen.model.quantities import DIRECTION
from symgen.verify.reference.configurations.given import MOMENT
from symgen.verify.reference.reference import State

# The parts of a state that further arguments are taken from.
_PARTS = {
    "q_m": "q", "qd_m": "qd", "qdd_m": "qdd", "x_t": "task", "xd_t": "qd", "xdd_t": "qdd", "w_u": "u", "w_qdd": "qdd",
}  # fmt: skip
_DIRECTION = ("qd", "qdd", "q")


def entry(given: Mapping[str, Sequence[Any]], load: Load) -> Any:
    """The value of a load, of parts of one state by name, `p` among them."""
    part, place = source(load, len(given["q"]))
    value = given[part][place]
    return value + given["qd"][load.place] * MOMENT if load.argument == "q_m" else value


def parts_of(state: State) -> dict[str, Sequence[Any]]:
    """The parts of a state by name."""
    q, qd, qdd, u, parameters, task = state.parts
    return {"q": q, "qd": qd, "qdd": qdd, "u": u, "p": parameters, "task": task}


def loaded(given: Mapping[str, Any], load: Load) -> Any:
    """The same of many states, a row each."""
    return entry({name: rows.T for name, rows in given.items()}, load)


def source(load: Load, n: int) -> tuple[str, int]:
    """The part of a state of n coordinates that a load is of, and the place there."""
    if load.argument == DIRECTION:
        return _DIRECTION[load.place // n], load.place % n
    return (_PARTS[load.argument], load.place) if load.argument in _PARTS else (load.argument, load.index)


def entries(state: State, argument: Argument) -> Sequence[Any]:
    """An array argument at a state."""
    if argument.name not in _PARTS and argument.name != DIRECTION:
        return tuple(getattr(state, argument.name))
    loads = (Load("", argument.name, i, place=place) for i, place in enumerate(argument.places))
    return tuple(entry(parts_of(state), load) for load in loads)


def arrays(state: State, kernels: Sequence[Kernel]) -> dict[str, Sequence[Any]]:
    """All array arguments of kernels of one model at a state, by name."""
    every = {argument.name: argument for kernel in kernels for argument in array_arguments(kernel)}
    return {name: entries(state, argument) for name, argument in every.items()}
