"""The forms of u, q̈, λ and N_B other than the generated ones, run by the interpreter in the order of their C."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from symgen.dynamics.compared import motions_of
from symgen.dynamics.forms.form import FORM_NAMES
from symgen.dynamics.forms.motions import MOTION_NAMES
from symgen.dynamics.inverse import forms_of
from symgen.ir.interpret import Interpreter
from symgen.ir.kernel import Program, Scalar, Status
from symgen.ir.schedule import schedule
from symgen.model.model import Model
from symgen.verify.reference import State

LABELS = {name: f"form {name}" for name in dict.fromkeys((*FORM_NAMES, *MOTION_NAMES))}


class FormKernels:
    """Every form of the `quantities` of a model, for both scalar types."""

    def __init__(self, model: Model, scalars: Sequence[Scalar], quantities: Sequence[str]) -> None:
        self._programs: list[tuple[str, dict[Scalar, Program]]] = []
        if "inverse_dynamics" in quantities:
            for name, (mechanics, quantity) in forms_of(model).items():
                self._programs.append((LABELS[name], schedule(mechanics, [quantity], scalars)))
        for name, (mechanics, found) in motions_of(model).items():
            wanted = [quantity for quantity in found if quantity.name in quantities]
            self._programs.append((LABELS[name], schedule(mechanics, wanted, scalars)))
        self._interpreters = {
            scalar: Interpreter(programs[scalar].sincos, scalar) for _, programs in self._programs for scalar in scalars
        }

    def run(self, state: State, scalar: Scalar) -> Iterator[tuple[str, str, Sequence[float] | None]]:
        """Label, quantity and result of each form; None where the form refuses the state."""
        parts = {part: getattr(state, part) for part in ("q", "qd", "qdd", "u")}
        parameters = tuple(map(float, state.parameters))
        for label, programs in self._programs:
            for kernel in programs[scalar].kernels:
                status, outputs = self._interpreters[scalar].run(kernel, parts, parameters)
                yield label, kernel.name, outputs if status == Status.OK else None
