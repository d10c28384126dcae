"""Derivatives of q_ddot and lambda from the equations of motion, not from the steps that solve them.

With rho = G q_ddot + C q_dot + Q - Q_a + B^T lambda - M u and kappa = B q_ddot + B_dot q_dot, q_ddot and lambda held,

    d q_ddot = -K d rho - Y d kappa,   d lambda = -Y^T (d rho - G Y d kappa),

where K = d q_ddot / d f and Y^T = d lambda / d f for loads f on the coordinates: the method that q_ddot takes is linear
in them and is asked for both.  Y is B_G^+ (17).  For trees this is -G^-1 d rho (Carpentier and Mansard, Analytical
Derivatives of Rigid Body Dynamics Algorithms, 2018).
"""

from __future__ import annotations

from dataclasses import replace

from symgen.mechanics.system import System
from symgen.methods.admission import ByTheorem
from symgen.methods.derivatives.held_equations import all_slopes, weighted_slopes
from symgen.methods.forward_dynamics.motions import NO_FRICTION
from symgen.methods.graphs import moved
from symgen.methods.method import Candidate, Method
from symgen.methods.quantity import Quantity
from symgen.methods.system import MethodInput
from symgen.methods.table import Use, methods
from symgen.methods.workspace import Workspace
from symgen.model.blocks.frames import ONE
from symgen.model.model import Input, Model
from symgen.model.quantities import MOTIONS, ROWS, FurtherName
from symgen.records import dataclass
from symgen.symbolic.accumulation import shortest_jacobian
from symgen.symbolic.calculus import derivative_along
from symgen.symbolic.matrix import Matrix, Vector, flatten, matmul, matvec, subtract_vectors, transpose
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import substitute

_WEIGHTS: FurtherName = "w_qdd"
_OF_MULTIPLIERS = "multipliers_jacobian"


@dataclass(frozen=True, slots=True)
class _Loaded:
    """q_ddot and lambda of a system with a load on each coordinate; the loads are the last of its inputs."""

    mechanics: System
    loads: Vector
    accelerations: Quantity
    multipliers: Vector

    @property
    def by(self) -> Vector:
        """q, q_dot and u."""
        mechanics = self.mechanics
        return (*mechanics.q, *mechanics.qd, *mechanics.u[: -mechanics.n])

    @property
    def held(self) -> dict[Scalar, Scalar]:
        """The values of q_ddot and lambda without loads, by their symbols."""
        graph = self.mechanics.graph
        values = substitute(
            graph, (*self.accelerations.outputs, *self.multipliers), dict.fromkeys(self.loads, graph.zero)
        )
        return dict(zip((*self.mechanics.qdd, *self.held_multipliers), values, strict=True))

    @property
    def held_multipliers(self) -> Vector:
        """Symbols that stand for lambda."""
        return tuple(self.mechanics.graph.stand_in(f"held {k}") for k in range(self.mechanics.r))

    @property
    def residuals(self) -> tuple[Vector, Vector]:
        """rho (n) and kappa (r)."""
        mechanics, graph = self.mechanics, self.mechanics.graph
        unloaded = (*mechanics.u[: -mechanics.n], *(graph.zero for _ in self.loads))
        rho = subtract_vectors(mechanics.balance, matvec(graph, mechanics.control_matrix, unloaded))
        if not mechanics.r:
            return rho, ()
        rows, bias = mechanics.constraint_jacobian, mechanics.constraint_acceleration_bias(mechanics.qd)
        pressed = matvec(graph, transpose(rows, mechanics.n), self.held_multipliers)
        along = matvec(graph, rows, mechanics.qdd)
        return (
            tuple(x + y for x, y in zip(rho, pressed, strict=True)),
            tuple(x + y for x, y in zip(along, bias, strict=True)),
        )


class _ImplicitMotions(ByTheorem):
    """J_a, J_lambda and w^T J_a."""

    theorem = "it divides by what q_ddot divides by"

    def build(self, workspace: Workspace, quantity: str) -> Candidate | str:
        """The derivatives, or why there are none by this method."""
        if workspace.model.rough:
            return NO_FRICTION
        system = _loaded(workspace)
        if isinstance(system, str):
            return system
        mechanics, graph = system.mechanics, system.mechanics.graph
        rho, kappa = system.residuals
        if _WEIGHTS in ROWS[quantity].arguments:
            (weights,) = mechanics.further(_WEIGHTS)
            along = dict(zip(system.loads, weights, strict=True))
            answers = derivative_along(graph, (*system.accelerations.outputs, *system.multipliers), along)
            slopes = weighted_slopes((tuple(-x for x in answers),), (*rho, *kappa), system.by)
            shape: tuple[int, ...] = (len(system.by),)
        else:
            shares = _of_multipliers(system) if quantity == _OF_MULTIPLIERS else _of_accelerations(system)
            slopes = all_slopes(shares, (*rho, *kappa), system.by)
            shape = (len(shares), len(system.by))
        outputs = flatten(slopes.with_values(graph, system.held).rows)
        derived = replace(system.accelerations, name=quantity, shape=shape, outputs=outputs)
        return Candidate(MethodInput(mechanics, workspace.generic), derived)


def _of_accelerations(system: _Loaded) -> Matrix:
    """-[K, Y]; K is symmetric."""
    graph, n = system.mechanics.graph, system.mechanics.n
    answers = shortest_jacobian(graph, system.accelerations.outputs, system.loads)
    pressed = shortest_jacobian(graph, system.multipliers, system.loads)
    return tuple(
        (*(-answers[min(i, j)][max(i, j)] for j in range(n)), *(-row[i] for row in pressed)) for i in range(n)
    )


def _of_multipliers(system: _Loaded) -> Matrix:
    """-[Y^T, -Y^T G Y]."""
    mechanics, graph = system.mechanics, system.mechanics.graph
    pressed = shortest_jacobian(graph, system.multipliers, system.loads)
    weighted = matmul(graph, pressed, mechanics.mass_matrix, mechanics.n)
    held = matmul(graph, weighted, transpose(pressed, mechanics.n), mechanics.r)
    return tuple((*(-x for x in row), *other) for row, other in zip(pressed, held, strict=True))


def _loaded(workspace: Workspace) -> _Loaded | str:
    """The motion by the valid method that counts least, on a graph of its own."""
    model = _with_loads(workspace.model)
    generic = replace(workspace.generic, m=len(model.inputs))
    there = Workspace(model, generic)
    best: tuple[Candidate, Candidate | None] | None = None
    for row in methods(MOTIONS[0], Use.CHOSEN):
        method = row.load()
        one = method.build(there, MOTIONS[0])
        if not isinstance(one, Candidate) or (best is not None and best[0].weight <= one.weight):
            continue
        if method.validity(there, replace(one, method=row.name), first_only=True).admitted:
            other = method.build(there, MOTIONS[1]) if generic.r else None
            best = (one, other if isinstance(other, Candidate) else None)
    if best is None:
        return "none of the methods of q_ddot is valid"
    mechanics = System(model)
    accelerations, multipliers = (None if one is None else moved(mechanics.graph, one.derived) for one in best)
    assert accelerations is not None
    return _Loaded(
        mechanics, mechanics.u[-mechanics.n :], accelerations, () if multipliers is None else multipliers.outputs
    )


def _with_loads(model: Model) -> Model:
    """The model with an input on each coordinate behind its own."""
    loads = (Input(f"load {c.name}", None, "", ((c.name, ONE),)) for c in model.coordinates)
    return replace(model, inputs=(*model.inputs, *loads))


IMPLICIT: Method = _ImplicitMotions()
