"""Kernels of a small model run by the interpreter and judged by the 50-digit reference at states given by hand."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache, cached_property

import shipped

from symgen.ir.interpret import Interpreter, round_float32
from symgen.ir.kernel import Kernel, Program, Scalar, Status
from symgen.lowering.schedule import schedule
from symgen.model.load import load_text
from symgen.model.model import Model
from symgen.quantities.select import Selection, derive_quantities
from symgen.verify.given import arrays
from symgen.verify.reference.parameter_values import parameters_from
from symgen.verify.reference.reference import Reference, State
from symgen.verify.sampling.task_ahead import with_task
from symgen.verify.tolerance import FACTOR, expectations


class System:
    """One model with its derivation, its kernels for both scalar types and its reference, each made on first use."""

    def __init__(self, text: str, outputs: Sequence[str] = ("all",)) -> None:
        self.model: Model = load_text(text, "laws.yaml")
        self.derivations: Selection = derive_quantities(self.model, outputs)
        self._programs: dict[Scalar, Program] = {}

    @cached_property
    def reference(self) -> Reference:
        return Reference(self.model)

    def program(self, scalar: Scalar = "float64") -> Program:
        if scalar not in self._programs:
            mechanics, quantities = self.derivations.mechanics, self.derivations.quantities
            self._programs[scalar] = schedule(mechanics, quantities, (scalar,))[scalar]
        return self._programs[scalar]

    def kernel(self, name: str, scalar: Scalar = "float64") -> Kernel:
        return next(kernel for kernel in self.program(scalar).kernels if kernel.name == name)

    @property
    def names(self) -> list[str]:
        return [quantity.name for quantity in self.derivations.quantities]

    def state(
        self,
        q: Sequence[float],
        qd: Sequence[float] = (),
        qdd: Sequence[float] = (),
        u: Sequence[float] = (),
        parameters: Mapping[str, float] | None = None,
        scalar: Scalar = "float64",
    ) -> State:
        """A state with floats of the scalar type; rates, accelerations and inputs default to uneven numbers."""
        n, m = len(self.model.coordinates), len(self.model.inputs)
        uneven = [0.71, -0.43, 0.37, 0.83, -0.59, 0.29, -0.97, 0.53, 0.61, -0.31, 0.47, -0.89]
        given = [float(x) for x in parameters_from(self.model, dict(parameters or {}))]
        parts = (q, qd or uneven[:n], qdd or uneven[-n:][::-1], u or uneven[2 : 2 + m], given)
        state = State(*(tuple(_float(x, scalar) for x in part) for part in parts))
        return replace(state, task=tuple(_float(x, scalar) for x in with_task(self.reference, state).task))

    def run(self, name: str, state: State, scalar: Scalar = "float64") -> tuple[Status, list[float]]:
        program = self.program(scalar)
        kernel = self.kernel(name, scalar)
        return Interpreter(program.sincos, scalar).run(kernel, arrays(state, [kernel]), state.parameters)

    def matrix(self, name: str, state: State, scalar: Scalar = "float64") -> list[list[float]]:
        """A quantity as rows; a vector is one column."""
        status, values = self.run(name, state, scalar)
        assert status is Status.OK, f"{name}: {status.name}"
        shape = self.kernel(name, scalar).shape
        columns = shape[1] if len(shape) > 1 else 1
        return [values[i : i + columns] for i in range(0, len(values), columns)]

    def errors(self, state: State, names: Sequence[str] = (), scalar: Scalar = "float64") -> dict[str, float]:
        """The error of each quantity in units of the tolerance: at most 1 for a correct kernel."""
        names = list(names or self.names)
        expected = expectations(self.reference, state, names, scalar, "laws")
        errors = {}
        for name in names:
            status, values = self.run(name, state, scalar)
            assert status is Status.OK, f"{name}: {status.name} at q = {state.q}"
            errors[name] = expected[name].in_units(expected[name].distance(values)) / FACTOR
        return errors

    def assert_right(self, state: State, names: Sequence[str] = (), scalar: Scalar = "float64") -> None:
        wrong = {name: error for name, error in self.errors(state, names, scalar).items() if not error <= 1}
        assert not wrong, f"{self.model.name} {scalar} at q = {state.q}: {wrong}"


class _Shipped(System):
    """A model of the repository with what its file asks for, which other tests of shipped models have derived, too."""

    def __init__(self, name: str) -> None:
        self.model = shipped.model(name)
        self.derivations = shipped.derivations(name)
        self._programs = shipped.programs(name)


def _float(value: float, scalar: Scalar) -> float:
    return float(value) if scalar == "float64" else round_float32(float(value))


@cache
def system(text: str, outputs: tuple[str, ...] = ("all",)) -> System:
    """A system shared by the tests of one process."""
    return System(text, outputs)


@cache
def shipped_system(name: str) -> System:
    """A model of the repository."""
    return _Shipped(name)
