"""u by elimination: of forces, until a small core is left; u follows from it, internal forces come out.

Where M selects rows, the passive rows give the multipliers and the drive rows give u; in general inputs are unknowns
like the multipliers.  N_B, B B^T or any choice of coordinates do not occur.

All steps of the elimination are invertible.  So the core loses rank exactly where [M, B^T] does, an input
singularity; beside regular ones the internal forces Z = (inputs that do no work along any motion) lose rank exactly
where B does, because a force of B^T alone would then be in balance.  The method is valid at every regular
configuration.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace

from symgen.linear_algebra.guards import Guard
from symgen.mechanics.absolute_angles import AbsoluteAngles, absolute_angles
from symgen.mechanics.genericity import Genericity
from symgen.mechanics.never_zero import Definite
from symgen.mechanics.system import System
from symgen.methods.admission import OfInputs, ranks
from symgen.methods.inverse_dynamics.core_equations import CoreEquations, core_equations
from symgen.methods.inverse_dynamics.elimination import Elimination
from symgen.methods.method import Candidate, Method, solved_for_u
from symgen.methods.system import MethodInput
from symgen.methods.workspace import Workspace
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Vector
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import cost, substitute

NOT_ELIMINATED = "its steps leave more than a few rows, or M does not select rows"


def elimination_candidate(
    mechanics: System, generic: Genericity, steps: Callable[[System], Elimination] = Elimination
) -> Candidate | None:
    """u by elimination, or None where it does not apply; `mechanics` may be in absolute angles.

    Needs full actuation and independent constraints.  `steps` makes the elimination.
    """
    core = core_equations(mechanics, generic, steps)
    if core is None:
        return None
    solved = core.solved()
    back = SymbolsOfTheModel(mechanics)
    outputs, own = back.scalars(solved.u), back.scalars(mechanics.balance)
    return solved_for_u(MethodInput(mechanics, generic), outputs, back.guards(solved.guards), own)


def core_of_stand_ins(system: MethodInput) -> tuple[CoreEquations, System, Vector] | str:
    """What is left of the elimination where stand-ins take the place of the load (n), and in which system these stand.

    u is linear in them.  Else why there is none.
    """
    if system.driven is not None:
        return system.driven
    mechanics = in_absolute_angles(system.mechanics)
    forces = tuple(mechanics.graph.stand_in(f"force {k}") for k in range(mechanics.n))
    core = core_equations(mechanics, system.generic, lambda of: Elimination(of, forces))
    return NOT_ELIMINATED if core is None else (core, mechanics, forces)


class SymbolsOfTheModel:
    """From the symbols that elimination works in, such as absolute angles, to the model's own."""

    def __init__(self, mechanics: System) -> None:
        self._graph, self._definite = mechanics.graph, Definite(mechanics)
        self._back = _symbols_back(mechanics, mechanics.change) | _positive_sizes(mechanics)

    def scalars(self, given: Sequence[Scalar]) -> Vector:
        """The scalars in the model's symbols."""
        return tuple(substitute(self._graph, given, self._back))

    def guards(self, given: Iterable[Guard]) -> tuple[Guard, ...]:
        """The guards that a state can fail, in the model's symbols."""
        return tuple(
            _moved(self._graph, guard, self._back) for guard in given if not self._definite.holds(guard.denominator)
        )


def _symbols_back(mechanics: System, change: AbsoluteAngles | None) -> dict[Scalar, Scalar]:
    """The symbols of absolute angles in terms of the model's."""
    if change is None:
        return {}
    graph, model = mechanics.graph, mechanics.model
    replacements: dict[Scalar, Scalar] = {}
    given = (
        (mechanics.q, [c.name for c in model.coordinates]),
        (mechanics.qd, [c.rate for c in model.coordinates]),
        (mechanics.qdd, [c.acceleration for c in model.coordinates]),
    )
    for own, names in given:
        absolute = change.absolute(tuple(graph.symbol(name) for name in names))
        replacements |= dict(zip(own, absolute, strict=True))
    return replacements


def _positive_sizes(mechanics: System) -> dict[Scalar, Scalar]:
    """|p| = p for parameters that are declared positive.

    Not for those that are so by nature: an offset in metres may be turned round at run time, and the size of a
    denominator that is not negative then is what keeps its test.
    """
    graph = mechanics.graph
    positive = [graph.symbol(p.name) for p in mechanics.model.parameters if p.range is not None and p.range[0] > 0]
    return {graph.function("abs", (p,)): p for p in positive}


def _moved(graph: Graph, guard: Guard, back: dict[Scalar, Scalar]) -> Guard:
    assert guard.scale is not None
    denominator, scale = substitute(graph, [guard.denominator, guard.scale], back)
    first = tuple(_moved(graph, cause, back) for cause in guard.first)
    return replace(guard, denominator=denominator, first=first, scale=scale)


def _elimination(workspace: Workspace) -> Candidate | str:
    system = about_to_be_eliminated(workspace, workspace.lumped)
    if system.driven is not None:
        return system.driven
    made = elimination_candidate(in_absolute_angles(system.mechanics), system.generic)
    return NOT_ELIMINATED if made is None else replace(made, system=system)


def about_to_be_eliminated(workspace: Workspace, lumped: bool) -> MethodInput:
    """The system on a new graph, with the twists of free bodies for rates where its equations count less that way.

    `lumped` regroups the parameters of bodies.
    """
    system = MethodInput.fresh(workspace.model, workspace.generic, lumped)
    if not workspace.model.mechanism.has_mass:
        return system
    from symgen.mechanics.rigid_bodies.free_bodies import free_bodies  # models given by energies start without it

    if not free_bodies(system.mechanics):
        return system
    from symgen.mechanics.rigid_bodies.body_axes import BodyAxes

    turned = MethodInput(BodyAxes(workspace.model, lumped), workspace.generic)
    return turned if cost(turned.given).weight < cost(system.given).weight else system


def in_absolute_angles(mechanics: System) -> System:
    """The system in absolute angles, where it has relative ones and its rates are those of the coordinates."""
    if not mechanics.twist_determinant.is_one:
        return mechanics
    change = absolute_angles(mechanics.q, mechanics.constraint_jacobian)
    return mechanics if change.is_identity else System(mechanics.model, mechanics, change, mechanics.lumped)


def _rest(workspace: Workspace, candidate: Candidate) -> list[Scalar]:
    """Minors, or else what the elimination's invertible steps leave."""
    return ranks(workspace, candidate) or [guard.denominator for guard in candidate.derived.guards]


ELIMINATION: Method = OfInputs(_elimination, _rest)
