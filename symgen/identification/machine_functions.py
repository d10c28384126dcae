"""The generated Python of a model at arrays of states, for what a log needs: u, its regressor, what is measured."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from symgen.generation.draft import draft_of
from symgen.generation.files import sources_of
from symgen.generation.results import Options
from symgen.identification.arrays import Array
from symgen.identification.not_identified import NotIdentifiedError
from symgen.model.checks.feasibility import measures_places
from symgen.model.configurations.mechanics import NumericSystem, default_values
from symgen.model.model import Model
from symgen.verify.running.python_module import PythonModule

# States of one call: more of them do not fit into the cache of a processor.
STATES_AT_ONCE = 4096
_PLACE, _RATE, _ACCELERATION = (
    "configuration_from_measured",
    "velocity_from_measured",
    "acceleration_from_measured",
)
_PROJECTION = ("projected_control_matrix", "projected_control_pseudoinverse")


class MachineFunctions:
    """Functions of states (N, n), with the coordinates that a log has as `measured`.

    Inputs are least ones, whatever the file's allocation says: drives that work against each other are no motion.
    Raises NotIdentifiedError for a model that has no regressor.
    """

    def __init__(self, model: Model, measured: Sequence[str]) -> None:
        self.model = _prepared(model, measured)
        self.parameters = default_values(model.parameters)
        self.directions = model.m if model.assembly is None else model.assembly.ranks.actuation
        self.is_redundant = model.m > self.directions
        geometric = any(row.kind == "geometric" for row in model.constraints)
        outputs = ["inverse_dynamics", "regressor"]
        outputs += [_PLACE] if geometric else []
        outputs += [_RATE, _ACCELERATION] if model.constraints else []
        outputs += _PROJECTION if self.is_redundant else []
        options = Options(outputs=tuple(outputs), scalars=("float64",), parts=("python",), verify=False)
        sources = sources_of(draft_of(self.model, tuple(outputs), options), options)
        (source,) = (text for path, text in sources.items() if path.endswith(".py"))
        self._module = PythonModule(source).module
        if lacking := [name for name in outputs if not hasattr(self._module, name)]:
            raise NotIdentifiedError(f"the model has no {lacking[0]}, which identification is made of")

    @property
    def closes_loops(self) -> bool:
        """Whether configurations follow from measured coordinates."""
        return hasattr(self._module, _PLACE)

    def one_configuration(self, measured: Array, near: Array) -> tuple[Array, str]:
        """q (n) with the measured coordinates, near another; what the status means where there is none."""
        try:
            return np.asarray(self._module.configuration_from_measured(measured, near)), ""
        except self._module.StateError as refusal:
            return near, str(refusal)

    def configurations(self, measured: Array, near: Array) -> Array:
        """q (N, n) with measured coordinates (N, k), each near another (N, n); NaN where there is none."""
        return self._called(_PLACE, (measured, near))

    def motion(self, q: Array, rates: Array, accelerations: Array) -> tuple[Array, Array]:
        """Admissible rates and accelerations (N, n), nearest to measured ones (N, k)."""
        if not self.model.constraints:
            return rates, accelerations
        return self._called(_RATE, (q, rates)), self._called(_ACCELERATION, (q, rates, accelerations))

    def inputs(self, state: tuple[Array, Array, Array], changed: Mapping[str, float] | None = None) -> Array:
        """Least inputs u (N, m) at (q, qd, qdd), with some parameters changed."""
        values = {**self.parameters, **(changed or {})}
        return self.least(state[0], self._called("inverse_dynamics", state, values))

    def regressor(self, state: tuple[Array, Array, Array]) -> Array:
        """Y (N, m, p) at (q, qd, qdd), with all parameters of the file as they are."""
        return self._called("regressor", state)

    def least(self, q: Array, u: Array) -> Array:
        """The least inputs (N, m) with the same effect: what drives do against each other is taken out."""
        if not self.is_redundant:
            return u
        matrices = [self._called(name, (q,)) for name in _PROJECTION]
        return np.asarray(np.einsum("smn,snk,sk->sm", matrices[1], matrices[0], u), dtype=np.float64)

    def _called(self, name: str, given: tuple[Array, ...], values: Mapping[str, float] | None = None) -> Array:
        function = getattr(self._module, name)
        numbers = self._module.Parameters(*(values or self.parameters).values())
        with np.errstate(all="ignore"):
            parts = [function(*(array[part] for array in given), p=numbers) for part in parts_of(len(given[0]))]
        return np.concatenate(parts)


def parts_of(count: int) -> Iterator[slice]:
    """So many states in parts."""
    return (slice(k, k + STATES_AT_ONCE) for k in range(0, count, STATES_AT_ONCE))


def _prepared(model: Model, measured: Sequence[str]) -> Model:
    if model.rough:
        raise NotIdentifiedError(
            "friction that grows with reactions is not linear in its parameters: leave it out of a copy of the model"
        )
    if not model.inputs:
        raise NotIdentifiedError("the model has no inputs: name those that the log has under `inputs`")
    parts = model.coordinates, model.parameters, model.definitions, model.constraints, model.kinetic_energy
    places = model.assembly is None or measures_places(
        NumericSystem(*parts, model.mechanism), model.assembly, tuple(measured)
    )
    return replace(model, allocation=None, measured=tuple(measured), measures_places=places)
