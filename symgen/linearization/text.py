"""What `symgen explain MODEL.yaml linearization` prints."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Sequence

import numpy as np

from symgen.linearization.linear_system import Array, LinearSystem, Poles
from symgen.linearization.regulator import Regulator

# Columns of a terminal that lines keep to, and states up to which matrices are printed.
WIDTH, LARGEST_PRINTED = 80, 12
# Digits of what is printed.
DIGITS = 4


def linear_system_text(system: LinearSystem, held: Regulator | None) -> str:
    """The equilibrium, the linear system, its poles, and gains where they were asked for."""
    model = system.model
    places = [f"{c.name} = {_number(x)}" for c, x in zip(model.coordinates, system.q, strict=True)]
    inputs = [f"{i.name} = {_number(x)}" for i, x in zip(model.inputs, system.u, strict=True)]
    lines = [f"{model.name} at rest", *_listed("at", places), *_listed("held by", inputs)]
    size, places_moved, rates_moved = len(system.a), system.of_places.shape[1], system.of_rates.shape[1]
    lines += ["", f"x' = A x + B v with {size} states: {places_moved} places, {rates_moved} rates"]
    lines += _listed("places along", _directions(system.of_places, [c.name for c in model.coordinates]))
    if not np.array_equal(system.of_places, system.of_rates):
        lines += _listed("rates along", _directions(system.of_rates, [c.rate for c in model.coordinates]))
    if size <= LARGEST_PRINTED:
        lines += ["", "A", *_matrix(system.a)]
        if model.m:
            lines += ["", "B", *_matrix(system.b)]
    lines += ["", *_listed("poles", _poles(system.poles))]
    if model.m:
        unreached = system.unreached
        lines += _listed("no input moves", _poles(unreached)) if len(unreached) else ["  the inputs reach all of them"]
    if held is not None:
        lines += ["", "u = u_0 - K (q - q_0) - D q', least Q |x|^2 + R |v|^2"]
        for name, gains, columns in (
            ("K", held.of_places, [c.name for c in model.coordinates]),
            ("D", held.of_rates, [c.rate for c in model.coordinates]),
        ):
            for i, row in zip(model.inputs, gains, strict=True):
                terms = [f"{_number(x)} {column}" for x, column in zip(row, columns, strict=True) if abs(x) > 1e-12]
                lines += _listed(f"{name} {i.name}", terms or ["0"])
        lines += _listed("poles with it", _poles(held.poles))
    return "\n".join(lines)


def _directions(basis: Array, names: Sequence[str]) -> list[str]:
    """Each direction as what moves with it."""
    texts = []
    for column in basis.T:
        terms = [f"{_number(x)} {name}" for x, name in zip(column, names, strict=True) if x]
        several = f"({' + '.join(terms)})".replace("+ -", "- ")
        texts.append(names[int(np.argmax(column))] if len(terms) == 1 else several)
    return texts


def _listed(head: str, items: Iterable[str]) -> list[str]:
    """Items behind what they are, in lines that fit."""
    text = ", ".join(item.replace(" ", "\u00a0") for item in items)
    wrapped = textwrap.wrap(text, WIDTH - 18, break_long_words=False)
    heads = [f"  {head:<14}", *(" " * 16 for _ in wrapped)]
    return [f"{start}{line}".replace("\u00a0", " ") for start, line in zip(heads, wrapped, strict=False)]


def _matrix(matrix: Array) -> list[str]:
    texts = [[_number(x) for x in row] for row in matrix]
    width = max(len(text) for row in texts for text in row)
    return ["  " + " ".join(text.rjust(width) for text in row) for row in texts]


def _poles(poles: Poles) -> list[str]:
    """Each pole, conjugate ones as one."""
    plain = (_number(pole.real) for pole in poles if pole.imag == 0)
    pairs = (f"{_number(pole.real)} ± {_number(pole.imag)}i" for pole in poles if pole.imag > 0)
    return [*plain, *pairs]


def _number(x: float) -> str:
    return "0" if abs(x) < 1e-9 else f"{x:.{DIGITS}g}"
