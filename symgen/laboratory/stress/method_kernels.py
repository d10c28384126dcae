"""The methods of u, q̈, λ and N_B other than the generated ones, compiled as these are."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from symgen.generation.runnable import SCALARS, Runner
from symgen.ir.kernel import Scalar, Status
from symgen.lowering.schedule import schedule
from symgen.methods.quantity import scalars
from symgen.methods.selection import every_method
from symgen.methods.table import METHODS, NAMED
from symgen.model.model import Model
from symgen.symbolic.traverse import cost
from symgen.verify.reference.reference import State

# Sums of minors of large systems grow past what a compiler takes in minutes.
MOST_OPERATIONS = 20_000
LABELS: dict[str, str] = {row.name: f"method {row.name}" for row in METHODS}


class MethodKernels:
    """Every method of the `quantities` of a model, for both scalar types; `left_out` says which are too long."""

    def __init__(self, model: Model, folder: Path, quantities: Sequence[str]) -> None:
        derived = every_method(model, [name for name in quantities if name in NAMED])
        self._runners: list[tuple[str, Runner]] = []
        self.left_out: tuple[str, ...] = ()
        for count, (name, mechanics, of_method) in enumerate(derived):
            weights = {quantity.name: cost(scalars(quantity)).weight for quantity in of_method}
            wanted = [quantity for quantity in of_method if weights[quantity.name] <= MOST_OPERATIONS]
            self.left_out += tuple(
                f"{LABELS[name]} of {quantity}: not run, {weight} operations"
                for quantity, weight in weights.items()
                if weight > MOST_OPERATIONS
            )
            if wanted:
                place = folder / f"method_{count}"
                place.mkdir()
                self._runners.append((LABELS[name], Runner(model, schedule(mechanics, wanted, SCALARS), place)))

    def run(self, state: State, scalar: Scalar) -> Iterator[tuple[str, str, Sequence[float] | None]]:
        """Label, quantity and result of each method; None where the method refuses the state."""
        for label, runner in self._runners:
            for name in runner.names:
                outcome = runner.run(name, state, scalar)
                yield label, name, outcome.entries if outcome.status == Status.OK else None
