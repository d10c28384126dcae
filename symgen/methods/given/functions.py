"""Functions of the configuration whose values are given: what encoders say, or the task that a motion is planned in."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, TypeAlias

from symgen.ir.kernel import Status
from symgen.records import dataclass
from symgen.symbolic.calculus import derivative_along, gradient
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Matrix, Vector, dot, flatten, identity
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.translate import translate

if TYPE_CHECKING:
    from symgen.mechanics.system import System


@dataclass(frozen=True, slots=True)
class Given:
    """k functions with their derivatives (k x n), and the values, rates and accelerations that they are to have.

    `places` are the numbers of the coordinates that stand there themselves, -1 for other functions; `status` is told
    where they do not determine the rest.
    """

    functions: Vector
    slopes: Matrix
    places: tuple[int, ...]
    values: Vector
    rates: Vector
    accelerations: Vector
    status: Status


GivenBy: TypeAlias = Callable[["System"], Given]
"""What is given of a system: `measured` or `task`."""


def measured(mechanics: System) -> Given:
    """What encoders say of some coordinates, in parts of what each is off by where the model says that."""
    model, units = mechanics.model, identity(mechanics.graph, mechanics.n)
    places, scales = model.measured_places, model.measured_scales
    values, rates, accelerations = (
        tuple(x * scale for x, scale in zip(given, scales, strict=True)) for given in mechanics.measured
    )
    return Given(
        tuple(mechanics.q[k] * scale for k, scale in zip(places, scales, strict=True)),
        tuple(tuple(x * scale for x in units[k]) for k, scale in zip(places, scales, strict=True)),
        tuple(k if scale == 1 else -1 for k, scale in zip(places, scales, strict=True)),
        values,
        rates,
        accelerations,
        Status.MEASURED_RANK,
    )


def task(mechanics: System) -> Given:
    """The coordinates of the task."""
    graph, order = mechanics.graph, {x: k for k, x in enumerate(mechanics.q)}
    functions = tuple(translate(graph, x.expression, mechanics.names) for x in mechanics.model.task)
    slopes = tuple(tuple(gradient(graph, x, mechanics.q)) for x in functions)
    places = tuple(order.get(x, -1) for x in functions)
    values, rates, accelerations = mechanics.further("x_t", "xd_t", "xdd_t")
    return Given(functions, slopes, places, values, rates, accelerations, Status.TASK_RANK)


def turning(
    graph: Graph, rows: Matrix, motion: Mapping[Scalar, Scalar], velocity: Sequence[Scalar]
) -> list[Scalar]:
    """How rows change along a motion, times the velocity of their unknowns."""
    changes = iter(derivative_along(graph, flatten(rows), motion))
    return [dot(graph, [next(changes) for _ in row], velocity) for row in rows]


def given_of(quantity: str, mechanics: System) -> Given:
    """What the quantity of a name is found from."""
    return measured(mechanics) if quantity.endswith("_from_measured") else task(mechanics)
