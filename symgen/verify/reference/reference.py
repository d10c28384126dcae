"""The independent reference: every quantity at one state, to at least 50 digits.

It starts from T, U, the constraint expressions, the inputs and the applied forces as parsed, differentiates by
truncated Taylor arithmetic, and solves at known ranks in ball arithmetic, whose radii bound its own error.  It shares
nothing with the derivation of kernels.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, TypeAlias, TypeVar

from flint import ctx

from symgen.model.availability import lacking
from symgen.model.model import Model
from symgen.model.quantities import ROWS
from symgen.verify.reference.arithmetic.linear import square
from symgen.verify.reference.arithmetic.tape import ball, precision
from symgen.verify.reference.configurations.manifold import ManifoldRanks, generic_ranks
from symgen.verify.reference.evaluation import Evaluation
from symgen.verify.reference.friction import FrictionLocksError
from symgen.verify.reference.inputs.limits import NoneWithinError
from symgen.verify.reference.measures import measures_of_parts
from symgen.verify.reference.quantities import DIFFERENCED, QUANTITIES
from symgen.verify.reference.system import ReferenceSystem
from symgen.verify.reference.translation import literal_values

Exact: TypeAlias = int | float | Fraction | Any
# Binary digits that the reference begins with.
REFERENCE_BITS = 256
# Decimal digits of a result, relative to its size.
REFERENCE_DIGITS = 50
# Results with norms and radii below this vanish.
VANISHING = 10.0 ** -(REFERENCE_DIGITS + 10)
# Binary digits that it goes up to, doubling them, where a state needs them.
MOST_BITS = 4096
# Times the working precision, where a matrix cannot be told from one of lower rank.
MORE_BITS = (1, 2, 4, 8)
NEAR_SINGULAR = "give `ranges` that leave out the configurations beside it, if they are never met"
Result = TypeVar("Result")


class ReferenceValueError(Exception):
    """The reference has no value here: a rank drops, or a function is evaluated outside its domain."""


class BeyondLimitsError(ReferenceValueError):
    """No inputs within their limits produce the motion."""


class LocksError(ReferenceValueError):
    """Friction returns half or more of the reactions it grows with."""


@dataclass(frozen=True, slots=True)
class State:
    """One input of all kernels, as exact numbers (int, float, Fraction) or balls; `task` is where its coordinates are
    to be, of models that have one."""

    q: tuple[Exact, ...]
    qd: tuple[Exact, ...]
    qdd: tuple[Exact, ...]
    u: tuple[Exact, ...]
    parameters: tuple[Exact, ...]
    task: tuple[Exact, ...] = ()

    @property
    def parts(self) -> tuple[tuple[Exact, ...], ...]:
        """All of it, in the order of the constructor."""
        return self.q, self.qd, self.qdd, self.u, self.parameters, self.task


class Reference:
    """The reference of one model; `ranks` are found at random points of V when they are not given.

    Raises ReferenceValueError when no point of the constraint manifold is found.
    """

    def __init__(self, model: Model, ranks: ManifoldRanks | None = None) -> None:
        self.model = model
        self.system = ReferenceSystem(model)
        known = ranks or generic_ranks(self.system)
        if known is None:
            raise ReferenceValueError(
                f"{model.name}: no configuration that satisfies the geometric constraints was found; "
                "give a start under `configuration`, and the ranges of the coordinates"
            )
        self.ranks = known
        self._literals: dict[int, list[Any]] = {}

    def quantities(self) -> tuple[str, ...]:
        """The names this model has (not those whose result would be empty)."""
        delta, actuation = self.model.n - self.ranks.constraints, self.ranks.actuation
        return tuple(name for name in QUANTITIES if lacking(ROWS[name], self.model, delta, actuation) is None)

    def literals(self) -> list[Any]:
        """The literals of the model at the working precision."""
        if ctx.prec not in self._literals:
            self._literals[ctx.prec] = literal_values(self.system.literals)
        return self._literals[ctx.prec]

    def evaluate(self, state: State, quantities: Sequence[str]) -> dict[str, tuple[Any, ...]]:
        """Row-major entries of each quantity, as balls that hold at least 50 digits of the quantity's norm.

        Raises ReferenceValueError where a quantity does not exist (a rank drops).
        """
        return {name: tuple(matrix.entries()) for name, matrix in self.precise(state, quantities).items()}

    def precise(self, state: State, quantities: Sequence[str]) -> dict[str, Any]:
        """Like `evaluate`, as matrices of balls (vectors are columns)."""
        bits = 2 * REFERENCE_BITS if DIFFERENCED.intersection(quantities) else REFERENCE_BITS
        while bits <= MOST_BITS:
            matrices = self.matrices(state, quantities, bits)
            with precision(bits):
                if all(_accurate(matrix) for matrix in matrices.values()):
                    return matrices
            bits *= 2
        raise ReferenceValueError(
            f"{self.model.name}: {MOST_BITS} bits do not give {REFERENCE_DIGITS} digits at this state; {NEAR_SINGULAR}"
        )

    def matrices(
        self, state: State, quantities: Sequence[str], bits: int = REFERENCE_BITS, literals: Sequence[Any] | None = None
    ) -> dict[str, Any]:
        """Each quantity as a matrix of balls (vectors are columns) at a working precision, whatever the radii become.

        `literals` replace the values of the model's literals.
        """

        def evaluated() -> dict[str, Any]:
            evaluation = self.evaluation(state, literals)
            return {name: QUANTITIES[name](evaluation) for name in quantities}

        return self.regular(evaluated, bits)

    def measured(self, state: State, quantities: Sequence[str], bits: int) -> tuple[dict[str, Any], list[Any]]:
        """Like `matrices`, and both measures of each part of the system, as balls."""

        def evaluated() -> tuple[dict[str, Any], list[Any]]:
            evaluation = self.evaluation(state)
            return {name: QUANTITIES[name](evaluation) for name in quantities}, measures_of_parts(evaluation)

        return self.regular(evaluated, bits)

    def regular(self, work: Callable[[], Result], bits: int) -> Result:
        """What `work` makes of evaluations at a working precision, or at a greater one where that tells no rank.

        Sums over subsets of rows in units far apart lose digits with the power of their sizes: a ball that may hold a
        singular matrix says nothing of the matrix yet.  Raises ReferenceValueError where more bits say no more.
        """
        for more in MORE_BITS:
            if more > 1 and more * bits > MOST_BITS:
                break
            with precision(more * bits), suppress(ZeroDivisionError):
                try:
                    return work()
                except NoneWithinError:
                    raise BeyondLimitsError(f"{self.model.name}: no inputs within their limits do this") from None
                except FrictionLocksError:
                    raise LocksError(f"{self.model.name}: friction locks at this state") from None
        raise ReferenceValueError(f"{self.model.name}: a rank drops at this state; {NEAR_SINGULAR}")

    def evaluation(self, state: State, literals: Sequence[Any] | None = None) -> Evaluation:
        """The state with every intermediate at hand, at the working precision of the caller."""
        return Evaluation(
            self.system,
            self.ranks,
            q=[ball(x) for x in state.q],
            qd=[ball(x) for x in state.qd],
            qdd=[ball(x) for x in state.qdd],
            u=[ball(x) for x in state.u],
            parameters=[ball(x) for x in state.parameters],
            task=[ball(x) for x in state.task],
            literals=self.literals() if literals is None else literals,
        )


def _accurate(matrix: Any) -> bool:
    """Whether the radii leave 50 digits of the norm, or 60 digits absolutely for a result that vanishes."""
    size = square(matrix)
    error = float(size.rad())
    return error <= 10.0**-REFERENCE_DIGITS * float(size) or float(size) + error <= VANISHING**2
