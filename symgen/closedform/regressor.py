"""The regressor in the ring: derivatives of a load that is linear in the inertial parameters."""

from __future__ import annotations

from collections.abc import Sequence

from symgen.closedform.algebra.matrices import multiply
from symgen.closedform.algebra.quotient import Matrix
from symgen.closedform.exact import Exact
from symgen.closedform.mechanics import ExactSystem, make_translator
from symgen.closedform.structure import RankStructure
from symgen.model.by_inertial_parameters import by_inertial_parameters
from symgen.model.inertial_parameters import inertial_parameters
from symgen.model.kinematics.energy_form import energy_form
from symgen.model.model import Model


class ExactRegressor:
    """Y of one model, whose ranks are known; its ring holds a variable for each inertial parameter."""

    def __init__(self, model: Model, structure: RankStructure) -> None:
        given = energy_form(by_inertial_parameters(model))
        self.exact = Exact(given, ExactSystem(given, make_translator(given)), structure)
        self._count = len(inertial_parameters(model.mechanism))

    def matrix(self, numbers: Sequence[int] | None = None) -> Matrix:
        """M~^+ dtau/dpi (m x p), or some of its columns."""
        exact, translator = self.exact, self.exact.mechanics.translator
        every = [p.name for p in exact.model.parameters[-self._count :]]
        names = every if numbers is None else [every[k] for k in numbers]
        columns = tuple(tuple(translator.derivative(tau, name) for name in names) for (tau,) in exact.load)
        return multiply(exact.ring, exact.control_pseudoinverse, columns)
