"""A form: one way to compute one quantity, with its guards and the list of all its denominators.

Forms are data; one module builds each of them.  Whether a form may be chosen by itself is decided on its `divisors`
(`symgen.dynamics.admission`), never on the way it was built.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache
from typing import Literal, TypeAlias

from symgen.linear_algebra.guards import Guard
from symgen.records import dataclass
from symgen.symbolic.angles import share_angles
from symgen.symbolic.matrix import Vector
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import cost, topological

FormName: TypeAlias = Literal["minor", "nullspace", "elimination", "householder", "printed", "weighted", "kkt"]
FORM_NAMES: tuple[FormName, ...] = ("minor", "nullspace", "elimination", "householder", "printed", "weighted", "kkt")


@dataclass(frozen=True, slots=True)
class Method:
    """Outputs (row-major), the guards that decide on a status, and the denominators and pivots of the outputs.

    `divisors` holds every scalar that is not a number and by which the outputs divide, apart from those that the
    model's own expressions divide by.  `name` is one of `FORM_NAMES` for u; forms of other quantities have their own.
    """

    name: str
    quantity: str
    outputs: Vector
    guards: tuple[Guard, ...]
    divisors: tuple[Scalar, ...]

    @property
    def weight(self) -> int:
        """Counted cost of a regular state, outputs and tested denominators; angles that are sums follow from others."""
        needed = (*self.outputs, *(guard.denominator for guard in self.guards))
        return _weight(needed) if needed else 0


@lru_cache(maxsize=16)  # asked for again while forms are compared
def _weight(needed: tuple[Scalar, ...]) -> int:
    return cost(share_angles(needed[0].graph, needed)).weight


def form(
    name: str, quantity: str, outputs: Sequence[Scalar], guards: Iterable[Guard], own: Sequence[Scalar] = ()
) -> Method:
    """The form of these outputs; `own` are the model's expressions, whose denominators are not the form's.

    The denominators are read off the graph, so that none can be forgotten.
    """
    kept = tuple(guard for guard in guards if guard.denominator.constant is None)
    given = set(divisors(own))
    return Method(name, quantity, tuple(outputs), kept, tuple(d for d in divisors(outputs) if d not in given))


def divisors(outputs: Iterable[Scalar]) -> tuple[Scalar, ...]:
    """Every scalar the outputs divide by, numbers left out, in the order of evaluation."""
    found = {
        node.args[1]: None
        for node in topological(outputs)
        if node.op in ("div", "ratio_or_zero") and node.args[1].constant is None
    }
    return tuple(found)
