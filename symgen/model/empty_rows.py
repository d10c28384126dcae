"""Rows that hold nothing: their gradients vanish in every configuration, up to the rounding of the file's numbers.

Numbers in a file are rounded: 0.19 + 1.0 - 1.19 is 1e-16, and an axis that is parallel to another in the drawing is so
but for 1e-16.  What is left of such a row must not count as a row of tiny length.  So every number of the model is
shaken by a tiny share of itself: a row that changes by more than it is long is what rounding leaves.  That needs no
scale, so that a row in other units is the same row, and no list of what cancels.
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from dataclasses import fields, is_dataclass, replace
from fractions import Fraction
from typing import Any

from symgen.diagnostics import Mistake, Notice, Span
from symgen.model.expression import Number, Pi
from symgen.model.mechanics import Mechanics
from symgen.model.mechanism import is_component
from symgen.model.model import ConstraintRow
from symgen.model.names import shown_names
from symgen.model.sparse import Row
from symgen.model.walk import exact_value, names_in
from symgen.records import dataclass

SEED = 20260607
SHARE = 1e-10  # by which numbers are shaken: far more than rounding to 16 digits is, far less than any dimension
SHAKES, POINTS, OTHERS, ATTEMPTS = 3, 2, 2, 20
PI = Fraction("3.14159265358979323846264338327950288419716939937510")
ZERO = Number(Fraction(0))


@dataclass(frozen=True, slots=True)
class _Sizes:
    """Of each row: its longest entry, by how much its entries change when shaken, and the same of its value."""

    lengths: tuple[float, ...]
    changes: tuple[float, ...]
    values: tuple[float, ...]
    shifts: tuple[float, ...]

    def is_empty(self, i: int) -> bool:
        """Whether nothing but rounding is left of the row."""
        return self.lengths[i] <= self.changes[i]

    def holds(self, i: int) -> bool:
        """Whether nothing but rounding is left of the value of a row that is constant."""
        return abs(self.values[i]) <= self.shifts[i]


def check_empty_rows(mechanics: Mechanics) -> tuple[tuple[ConstraintRow, ...], list[Mistake | Notice]]:
    """The rows, those that hold nothing as 0 = 0, and what is to be told of them."""
    rows = mechanics.constraints
    usual = _sizes(mechanics)
    if usual is None:
        return rows, []
    empty = [i for i in range(len(rows)) if usual.is_empty(i)]
    if not empty:
        return rows, []
    others = list(_with_other_parameters(mechanics))
    told: list[Mistake | Notice] = []
    idle: dict[Span | None, list[str]] = {}
    fitting: dict[Span | None, list[str]] = {}
    taken = list(rows)
    for i in empty:
        row = rows[i]
        if not usual.holds(i):
            told.append(
                Mistake(
                    f"the constraint `{row.name}` does not depend on the configuration: it demands "
                    f"{usual.values[i]:.6g} = 0",
                    _remedy(row),
                    row.span,
                )
            )
        elif not all(other.is_empty(i) for other in others):
            told.append(_vanishing(mechanics, row))
        else:
            taken[i] = replace(row, expression=ZERO)
            group = idle if all(other.holds(i) for other in others) else fitting
            group.setdefault(row.span, []).append(row.name)
    told += [Notice(_says_nothing(names, rows), span) for span, names in idle.items()]
    told += [
        Notice(
            f"{_the_constraints(names)} {'does' if len(names) == 1 else 'do'} not depend on the configuration: what "
            "is demanded of parameters holds for their default values, and nothing is said about motion",
            span,
        )
        for span, names in fitting.items()
    ]
    return tuple(taken), told


def _remedy(row: ConstraintRow) -> str:
    if any(is_component(name.name) for name in names_in(row.expression)):
        return "check the lengths and axes on the way round the loop: no coordinate changes this"
    return "write an expression of coordinates that can become zero"


def _the_constraints(names: Sequence[str]) -> str:
    return f"the constraint{'' if len(names) == 1 else 's'} {shown_names(names)}"


def _says_nothing(names: Sequence[str], rows: Sequence[ConstraintRow]) -> str:
    kinds = {row.kind for row in rows if row.name in names}
    where = "configurations" if kinds == {"geometric"} else "motions"
    verb = ("is", "says") if len(names) == 1 else ("are", "say")
    return f"{_the_constraints(names)} {verb[0]} zero for all {where} and {verb[1]} nothing"


def _vanishing(mechanics: Mechanics, row: ConstraintRow) -> Mistake:
    """A row whose rank is another for almost all values of the parameters."""
    index = mechanics.constraints.index(row)
    named = [
        name
        for name, changed in _each_changed(mechanics)
        if (sizes := _sizes(changed)) is not None and not sizes.is_empty(index)
    ]
    by = shown_names(named) if named else "several parameters together"
    return Mistake(
        f"the constraint `{row.name}` does not depend on the configuration for the default values of the parameters, "
        f"for others it does: {by} would change the number of constraints",
        "give defaults for which it counts, or write numbers in place of these parameters",
        row.span,
    )


def _with_other_parameters(mechanics: Mechanics) -> Iterator[_Sizes]:
    found = 0
    for _, parameters in mechanics.anywhere(ATTEMPTS):
        sizes = _sizes(mechanics.having(parameters))
        if sizes is not None:
            yield sizes
            found += 1
        if found == OTHERS:
            return


def _each_changed(mechanics: Mechanics) -> Iterator[tuple[str, Mechanics]]:
    """The mechanics with one parameter changed."""
    for _, parameters in mechanics.anywhere(1):
        for name, value in parameters.items():
            yield name, mechanics.having({**mechanics.defaults, name: value})


def _sizes(mechanics: Mechanics) -> _Sizes | None:
    """Measured at a few random configurations; None where the rows have no value."""
    generator = random.Random(SEED)
    count, geometric = len(mechanics.constraints), len(mechanics.geometric)
    shaken = [_shaken(mechanics, generator) for _ in range(SHAKES)]
    lengths, changes = [0.0] * count, [0.0] * count
    values, shifts = [0.0] * count, [0.0] * count
    found = 0
    for q, _ in mechanics.anywhere(ATTEMPTS):
        try:
            here, rows = _at(mechanics, q)
            beside = [_at(one, q) for one in shaken]
        except (ArithmeticError, ValueError):
            continue
        for i, row in enumerate(rows):
            lengths[i] = max(lengths[i], *map(abs, row.values()), 0.0)
            for _, other in beside:
                for j in {*row, *other[i]}:
                    changes[i] = max(changes[i], abs(row.get(j, 0.0) - other[i].get(j, 0.0)))
        for i in range(geometric):
            values[i] = max(values[i], here[i], key=abs)
            shifts[i] = max(shifts[i], *(abs(here[i] - there[i]) for there, _ in beside))
        found += 1
        if found == POINTS:
            return _Sizes(tuple(lengths), tuple(changes), tuple(values), tuple(shifts))
    return None


def _at(mechanics: Mechanics, q: Sequence[float]) -> tuple[list[float], list[Row]]:
    """g and B."""
    return mechanics.residuals(q, range(len(mechanics.geometric)))[0], mechanics.rows(q)


def _shaken(mechanics: Mechanics, generator: random.Random) -> Mechanics:
    """The mechanics with every number changed by a tiny share of it."""

    def shake(part: Any) -> Any:
        match part:
            case Number(value=value):
                return Number(value * shift()) if value else part
            case Pi():
                return Number(PI * shift())
            case tuple():
                # what rounding leaves of a zero beside the other entries of a vector is shaken as these are
                sizes = [abs(Fraction(exact_value(one) or 0)) for one in part]
                tiny = Fraction(SHARE) * max(sizes, default=0)
                pairs = zip(part, sizes, strict=True)
                return tuple(Number(tiny * shift()) if 0 < size < tiny else shake(one) for one, size in pairs)
        if is_dataclass(part) and not isinstance(part, (type, Span)):
            parts = {field.name: getattr(part, field.name) for field in fields(part)}
            return replace(part, **{name: shake(one) for name, one in parts.items() if not isinstance(one, str)})
        return part

    def shift() -> Fraction:
        return 1 + Fraction(generator.choice((-1, 1)) * generator.uniform(0.5, 1) * SHARE)

    defaults = {name: value * float(shift()) for name, value in mechanics.defaults.items()}
    return mechanics.having(
        defaults, shake(mechanics.constraints), shake(mechanics.definitions), shake(mechanics.mechanism)
    )
