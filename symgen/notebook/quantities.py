"""A model's quantities in a notebook: SymPy matrices and CasADi functions by name, derived when first asked for."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from symgen.model.load import load_model
from symgen.model.model import Model
from symgen.model.quantities import QUANTITIES

if TYPE_CHECKING:
    import casadi
    import sympy

    from symgen.closedform.forms import ClosedForm, ClosedForms

Value = TypeVar("Value")
CHOOSES = "kept in its named parts, see closed_forms.forms: limits choose by minima and maxima"
DESCRIPTIONS = {quantity.name: f"{quantity.symbol}, {quantity.description}" for quantity in QUANTITIES}


class Quantities(Mapping[str, Value], Generic[Value]):
    """Values by quantity name; made at the first access, listed with their meaning by `repr`.

    A KeyError says why a quantity is missing, or which names there are.
    """

    def __init__(
        self, kind: str, names: tuple[str, ...], missing: Mapping[str, str], make: Callable[[str], Value]
    ) -> None:
        self._kind = kind
        self._names = names
        self._missing = missing
        self._make = make
        self._made: dict[str, Value] = {}

    def __getitem__(self, name: str) -> Value:
        if name not in self._names:
            raise KeyError(self._missing.get(name, f"{name} is none of {', '.join(self._names)}"))
        if name not in self._made:
            self._made[name] = self._make(name)
        return self._made[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def __contains__(self, name: object) -> bool:
        return name in self._names

    def __repr__(self) -> str:
        width = max(map(len, self._names), default=0)
        lines = [f"  {name:{width}}  {DESCRIPTIONS.get(name, '')}" for name in self._names]
        return "\n".join([f"{self._kind} by quantity name:", *lines])


class NotebookModel:
    """A model and what was derived from it: `model`, `sympy`, `casadi`, `closed_forms`."""

    def __init__(self, model: Model) -> None:
        self.model = model

    @cached_property
    def closed_forms(self) -> ClosedForms:
        """Everything known in closed form, singular sets and named intermediates included."""
        from symgen.closedform.forms import derive_closed_forms

        return derive_closed_forms(self.model)

    @cached_property
    def sympy(self) -> Quantities[sympy.ImmutableDenseMatrix]:
        """Closed forms in SymPy symbols named like the coordinates, rates (`x_dot`), accelerations and parameters.

        Named intermediates are written out; `closed_forms` has them.  Forms that are too long to write are missing.
        """
        forms = self.closed_forms.forms
        written = tuple(name for name, form in forms.items() if form.matrix is not None and not _chooses(form))
        missing = {name: f"{name}: {form.note or CHOOSES}" for name, form in forms.items() if name not in written}
        return Quantities("SymPy matrices", written, missing, lambda name: _written_out(forms[name]))

    @cached_property
    def casadi(self) -> Quantities[casadi.Function]:
        """Functions of `q`, `qd`, `qdd`, `u`, as far as the quantity depends on them, and the parameters `p`."""
        from symgen.witness.casadi_derivation import witness_functions

        functions = witness_functions(self.model)
        return Quantities("CasADi functions", tuple(functions), {}, lambda name: functions[name])

    @property
    def parameters(self) -> Any:
        """Default values of the parameters, the column `p` of the CasADi functions."""
        from symgen.witness.translate import default_parameters

        return default_parameters(self.model)

    def __repr__(self) -> str:
        model = self.model
        names = ", ".join(coordinate.name for coordinate in model.coordinates)
        return (
            f"{model.name}: {model.n} coordinates ({names}), {model.r} constraints, {model.m} inputs\n"
            "  .sympy[name]   closed form of a quantity\n"
            "  .casadi[name]  function of those of q, qd, qdd, u that it needs, and of the parameters p\n"
            "  .parameters    default values of p"
        )


def derive(model: str | Path | Model) -> NotebookModel:
    """The quantities of a model file or model; ModelError with every mistake of the file, OSError without a file."""
    return NotebookModel(model if isinstance(model, Model) else load_model(Path(model)))


def _chooses(form: ClosedForm) -> bool:
    """Whether minima and maxima are among the intermediates: SymPy takes minutes to write them into each other."""
    from sympy import Max, Min

    return any(isinstance(meaning, (Max, Min)) for _, meaning in form.intermediates)


def _written_out(form: ClosedForm) -> sympy.ImmutableDenseMatrix:
    """The matrix without intermediates: these are in order of use, so the last is replaced first."""
    matrix: Any = form.matrix
    for symbol, meaning in reversed(form.intermediates):
        matrix = matrix.xreplace({symbol: meaning})
    return matrix
