"""The forms of u, q̈, λ and N_B other than the generated ones, compiled as these are."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from symgen.dynamics.compared import motions_of
from symgen.dynamics.forms.form import FORM_NAMES
from symgen.dynamics.forms.motions import BY_FRAMES, MOTION_NAMES
from symgen.dynamics.inverse import forms_of
from symgen.ir.kernel import Scalar, Status
from symgen.ir.schedule import schedule
from symgen.model.model import Model
from symgen.stress.kernels import SCALARS, Runner
from symgen.verify.reference import State

LABELS: dict[str, str] = {name: f"form {name}" for name in dict.fromkeys((*FORM_NAMES, *MOTION_NAMES, BY_FRAMES))}


class FormKernels:
    """Every form of the `quantities` of a model, for both scalar types."""

    def __init__(self, model: Model, folder: Path, quantities: Sequence[str]) -> None:
        derived = [(name, mechanics, found) for name, (mechanics, found) in motions_of(model).items()]
        if "inverse_dynamics" in quantities:
            derived += [(name, mechanics, (found,)) for name, (mechanics, found) in forms_of(model).items()]
        self._runners: list[tuple[str, Runner]] = []
        for count, (name, mechanics, found) in enumerate(derived):
            wanted = [quantity for quantity in found if quantity.name in quantities]
            if wanted:
                place = folder / f"form_{count}"
                place.mkdir()
                self._runners.append((LABELS[name], Runner(model, schedule(mechanics, wanted, SCALARS), place)))

    def run(self, state: State, scalar: Scalar) -> Iterator[tuple[str, str, Sequence[float] | None]]:
        """Label, quantity and result of each form; None where the form refuses the state."""
        for label, runner in self._runners:
            for name in runner.names:
                outcome = runner.run(name, state, scalar)
                yield label, name, outcome.entries if outcome.status == Status.OK else None
