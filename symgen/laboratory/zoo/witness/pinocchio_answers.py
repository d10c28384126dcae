"""What was generated for trees beside Pinocchio: u from RNEA, a recursion, accelerations from ABA, articulated bodies.

Springs, friction, force elements, rotors and energies are added by the zoo, and u is shared out over the inputs by its
own rule; where loops or wheels close a tree only u is compared, along what they leave free.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from symgen.laboratory.zoo.witness.allocation import directed, holding, is_directed, preloads
from symgen.laboratory.zoo.witness.kkt import EquationEvaluator, EquationValues, GenericRanks
from symgen.laboratory.zoo.witness.numbers.fields import Floats
from symgen.laboratory.zoo.witness.numbers.float_rows import normalized, null_space
from symgen.laboratory.zoo.witness.numbers.tape import NodeProgram
from symgen.laboratory.zoo.witness.pinocchio_trees import PinocchioTree
from symgen.laboratory.zoo.witness.reading.mechanics import equations
from symgen.laboratory.zoo.witness.reading.reader import SystemReader
from symgen.laboratory.zoo.witness.states import FloatState

WITHOUT = ("bodies", "gravity")
# an entry smaller than this beside the largest one is known as well as that, times this
SMALL = 1e-3
# of the weight of all bodies, on levers of a metre: it is turned into the axes of bodies and back, and what rounding
# leaves of that is all there is where a machine all but rests
TURNED = 1e-6
# what doubles lose of what is worked out in them here, sixteen roundings as the generated u may
ROUNDING = 16 * 2.0**-53
COMPARED = ("inverse_dynamics", "forward_dynamics")


class PinocchioAnswers:
    """A tree, and what acts on it beside gravity."""

    def __init__(self, tree: PinocchioTree, blocks: Mapping[str, Any], ranks: GenericRanks) -> None:
        self._tree, self._ranks = tree, ranks
        self._system = SystemReader({name: block for name, block in blocks.items() if name not in WITHOUT})
        system_equations = equations(self._system)
        self._evaluate = EquationEvaluator(NodeProgram(self._system.tape, system_equations.flat), system_equations)
        self._closed = len(self._system.rows) > sum(bool(part.quaternion) for part in tree.parts)

    def apart(
        self, quantity: str, state: FloatState, values: Mapping[str, float], given: Sequence[float]
    ) -> float | None:
        """How far a result is from Pinocchio's, relative to what it is summed up from; None where there is none."""
        at = self._evaluate(values, Floats())
        q, qd, qdd, u = (np.array(part) for part in (state.q, state.qd, state.qdd, state.u))
        mass, bias = self._tree.forces(q, qd)
        rotors: Any = np.array(at.mass)
        rounded = 0.0
        control: Any = np.array(at.control).reshape(len(q), -1)
        # of what cancels, rounding leaves a share of the parts
        parts = np.abs(bias) + np.abs(at.bias) + TURNED * self._tree.weight
        free = null_space(at, self._ranks.constraints)
        limited = (self._system.blocks.get("allocation") or {}).get("limits")
        if quantity == "inverse_dynamics" and limited and not is_directed(at, self._ranks):
            return None
        if quantity == "inverse_dynamics":
            load = self._tree.load(q, qd, qdd) + rotors @ qdd + np.array(at.bias)
            expected, share = self._inputs(at, control, free, load, values)
            rounded = self._rounded(at, free.T @ control, load, expected)
            parts = parts + (np.abs(mass) + np.abs(rotors)) @ np.abs(qdd) + np.abs(control) @ np.abs(expected)
            # what no input supplies turns the inputs that it is shared out over
            rest = free @ (free.T @ (load - control @ expected))
            sizes = np.abs(share) @ parts + np.abs(share @ share.T) @ np.abs(control).T @ np.abs(rest)
        elif self._closed or not self._tree.takes(rotors):
            return None
        else:
            forces = control @ u - np.array(at.bias)
            expected = self._tree.accelerations(q, qd, forces, rotors)
            answers = free @ np.linalg.solve(free.T @ (mass + rotors) @ free, free.T)
            parts = parts + np.abs(control) @ np.abs(u) + (np.abs(mass) + np.abs(rotors)) @ np.abs(expected)
            sizes = np.abs(answers) @ parts
        away = np.maximum(np.abs(np.array(given) - expected) - rounded, 0.0)
        sizes = sizes + np.abs(expected)
        sizes = sizes + SMALL * sizes.max(initial=0.0)
        return float((away / np.where(sizes > 0, sizes, 1)).max(initial=0.0))

    def _rounded(self, at: EquationValues, projected: Any, load: Any, inputs: Any) -> float:
        """What doubles leave of u here: what rows leave free is known as well as these are independent, and u follows
        from it as well as the inputs are along it.
        """
        reach = np.linalg.svd(projected, compute_uv=False)[: self._ranks.actuation]
        rows = np.linalg.svd(normalized(np.array(at.rows, dtype=float).reshape(-1, at.n)), compute_uv=False)
        held = rows[: self._ranks.constraints].min(initial=1.0)
        lost = np.linalg.norm(load) / held + reach.max(initial=0.0) * np.linalg.norm(inputs)
        return float(ROUNDING * lost / reach.min(initial=np.inf))

    def _inputs(
        self, at: EquationValues, control: Any, free: Any, load: Any, values: Mapping[str, float]
    ) -> tuple[Any, Any]:
        """u under a load, and the matrix that makes it of the load where no limit acts."""
        inputs, block = self._system.inputs, self._system.blocks.get("allocation") or {}
        weights = np.array([values.get(f"weight_{name}", 1.0) for name in inputs]) ** 0.5
        left, sizes, right = np.linalg.svd(free.T @ control / weights, full_matrices=False)
        rank = self._ranks.actuation
        share = (right[:rank].T / sizes[:rank]) @ left[:, :rank].T @ free.T / weights[:, None]
        near = np.array(preloads(inputs, block, values, 0.0) or [0.0] * len(inputs))
        u, held = near + share @ (load - control @ near), holding(at, self._ranks)
        return np.array([float(x) for x in directed(held, list(u), inputs, block, values, 1.0)]), share
