"""The generated Python of a model at arrays of states, for what a log needs: u, its columns, what is measured."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from copy import copy
from dataclasses import replace
from pathlib import Path
from typing import Literal, TypeAlias

import numpy as np

from symgen.generation.rejections import rejected_lines
from symgen.generation.results import Options, Result
from symgen.identification.arrays import Array
from symgen.identification.combinations import BodyCombinations, default_like
from symgen.identification.energies.energy_terms import EnergyTerms
from symgen.identification.energies.shown_terms import ShownTerms, columns_of_terms, shown_terms
from symgen.identification.not_identified import NotIdentifiedError
from symgen.model.checks.feasibility import measures_places
from symgen.model.combinations.base_parameters import BaseParameters
from symgen.model.configurations.mechanics import NumericSystem, default_values
from symgen.model.inertial_base import NOT_NAMED, InertialBase
from symgen.model.model import Model
from symgen.model.quantities import BASE_REGRESSOR
from symgen.pipeline import generate_of
from symgen.verify.running.python_module import PythonModule

Progress = Callable[[str], None]
# What a motion is given by: coordinates that are measured, or those of the task.
GivenBy: TypeAlias = Literal["measured", "task"]
# States of one call: more of them do not fit into the cache of a processor.
STATES_AT_ONCE = 4096
_PROJECTION = ("projected_control_matrix", "projected_control_pseudoinverse")


class MachineFunctions:
    """Functions of states (N, n), with the coordinates that a log has as `measured`; they are `verified`.

    Columns are those of `base`, which holds the model too: no motion tells the others apart.
    Where a motion is given by the task, rows of given places, rates and accelerations (N, k) are those of the task.
    `further` quantities are made beside those that identification takes.
    Inputs are least ones, whatever the file's allocation says: drives that work against each other are no motion.
    Raises NotIdentifiedError for a model without columns of its `base`, and where verification rejects a function;
    ModelError, about the file at `path`, where there are no states to verify at.
    """

    def __init__(
        self,
        path: Path,
        base: BaseParameters | EnergyTerms,
        measured: Sequence[str],
        progress: Progress,
        given_by: GivenBy = "measured",
        further: Sequence[str] = (),
    ) -> None:
        model = base.model
        self.base = base
        self.combinations: BodyCombinations | ShownTerms
        self.model = _prepared(model, measured)
        if isinstance(base, EnergyTerms):
            self.combinations = ShownTerms(base, tuple(range(len(base.monomials))), np.eye(len(base.monomials)))
        else:
            self.combinations = BodyCombinations(base)
            self.model = replace(self.model, inertial_base=InertialBase(base.columns, (), NOT_NAMED))
        self.parameters = default_values(model.parameters)
        self.directions = model.m if model.assembly is None else model.assembly.ranks.actuation
        self.is_redundant = model.m > self.directions
        geometric = any(row.kind == "geometric" for row in model.constraints)
        self._place, self._rate, self._acceleration = (
            f"{what}_from_{given_by}" for what in ("configuration", "velocity", "acceleration")
        )
        outputs = ["inverse_dynamics", *(() if isinstance(base, EnergyTerms) else (BASE_REGRESSOR,)), *further]
        outputs += [self._place] if geometric or given_by == "task" else []
        outputs += [self._rate, self._acceleration] if model.constraints or given_by == "task" else []
        outputs += _PROJECTION if self.is_redundant else []
        options = Options(outputs=tuple(outputs), scalars=("float64",), parts=("python",), fixed_parameters=True)
        self.verified = _accepted(generate_of(path, self.model, options, progress), outputs)
        (source,) = (text for name, text in self.verified.files.items() if name.endswith(".py"))
        self._module = PythonModule(str(source)).module

    @property
    def closes_loops(self) -> bool:
        """Whether configurations follow from what is given."""
        return hasattr(self._module, self._place)

    def one_configuration(self, given: Array, near: Array) -> tuple[Array, str]:
        """q (n) for given places (k), near another; what the status means where there is none."""
        try:
            return np.asarray(getattr(self._module, self._place)(given, near)), ""
        except self._module.StateError as refusal:
            return near, str(refusal)

    def configurations(self, given: Array, near: Array) -> Array:
        """q (N, n) for given places (N, k), each near another (N, n); NaN where there is none."""
        return self.quantity(self._place, given, near)

    def motion(self, q: Array, rates: Array, accelerations: Array) -> tuple[Array, Array]:
        """Admissible rates and accelerations (N, n), nearest to given ones (N, k)."""
        if not hasattr(self._module, self._rate):
            return rates, accelerations
        return self.quantity(self._rate, q, rates), self.quantity(self._acceleration, q, rates, accelerations)

    def quantity(self, name: str, *given: Array) -> Array:
        """A quantity (N, ...) that was made, at arrays (N, k), with all parameters of the file as they are."""
        return self._called(name, given)

    def inputs(self, state: tuple[Array, Array, Array], changed: Mapping[str, float] | None = None) -> Array:
        """Least inputs u (N, m) at (q, qd, qdd), with some parameters changed."""
        values = {**self.parameters, **(changed or {})}
        return self.least(state[0], self._called("inverse_dynamics", state, values))

    def columns(self, state: tuple[Array, Array, Array]) -> Array:
        """Those of the combinations (N, m, b) at (q, qd, qdd), with all parameters of the file as they are."""
        if isinstance(self.combinations, BodyCombinations):
            every = self.quantity(BASE_REGRESSOR, *state)
            return every[..., self.combinations.kept] if self.combinations.known else every
        made = columns_of_terms(
            self.combinations.terms, self.parameters, lambda changed: self.inputs(state, self._followed(changed))
        )
        return made[..., list(self.combinations.kept)]

    def telling_apart(self, state: tuple[Array, Array, Array]) -> MachineFunctions:
        """The same with what a motion (q, qd, qdd) tells apart in place of all combinations of energies.

        Where gains are asked, sums that the file knows are no combinations: they say what drives are loaded by.
        """
        made, said = copy(self), self.model.identify
        if isinstance(self.combinations, ShownTerms):
            made.combinations = shown_terms(self.combinations.terms, self.columns(state))
        elif said is not None and said.gains:
            made.combinations = self.combinations.as_numbers_say()
        return made

    def _followed(self, changed: Mapping[str, float]) -> dict[str, float]:
        """All values, those that are expressions of changed ones with them."""
        return default_like(self.model, self.parameters, changed)

    def least(self, q: Array, u: Array) -> Array:
        """The least inputs (N, m) with the same effect: what drives do against each other is taken out."""
        if not self.is_redundant:
            return u
        matrices = [self.quantity(name, q) for name in _PROJECTION]
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


def _accepted(result: Result, outputs: Sequence[str]) -> Result:
    """The same, where nothing of it was rejected and nothing lacks."""
    if rejected := rejected_lines(result):
        raise NotIdentifiedError("\n".join(("verification rejects what would be fitted with", *rejected)))
    made = {kernel.name for kernel in result.programs["float64"].kernels}
    if lacking := [name for name in outputs if name not in made]:
        raise NotIdentifiedError(f"the model has no {lacking[0]}, which identification is made of")
    return result


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
