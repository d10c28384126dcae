"""Rows that hold nothing: their gradients vanish in every configuration, up to the rounding of the file's numbers."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import islice

from symgen.diagnostics import Mistake, Notice, Span
from symgen.model.expression import Number
from symgen.model.mechanics import Mechanics
from symgen.model.mechanism import is_component
from symgen.model.model import ConstraintRow, Input
from symgen.model.names import shown_names
from symgen.model.shaken import Shaken
from symgen.model.sparse import Row
from symgen.model.walk import names_in

POINTS, OTHERS, ATTEMPTS = 2, 2, 20
CONSTANT = 1e-6  # of a gap, that it may differ by
VALUE = -1  # the number under which the value of a row stands beside its entries
ZERO = Number(Fraction(0))


class _Rows:
    """The rows shaken at a few random configurations; the value of a geometric row is one of its entries."""

    def __init__(self, mechanics: Mechanics) -> None:
        self._shaken = Shaken(mechanics, (), self._evaluated)
        places = (q for q, _ in mechanics.anywhere(ATTEMPTS))
        self.known = sum(islice(filter(None, map(self._shaken.look, places)), POINTS)) == POINTS

    @staticmethod
    def _evaluated(mechanics: Mechanics, _: Sequence[Input], q: Sequence[float]) -> list[Row]:
        rows = [dict(row) for row in mechanics.rows(q)]
        for row, value in zip(rows, mechanics.residuals(q, range(len(mechanics.geometric)))[0], strict=False):
            row[VALUE] = value
        return rows

    def is_empty(self, i: int) -> bool:
        """Whether nothing but rounding is left of the row."""
        return all(self._shaken.is_rest(i, j) for j in self._shaken.sizes[i] if j != VALUE)

    def value(self, i: int) -> float:
        """The value of a row at the first of the configurations."""
        return self._shaken.first[i][VALUE]

    def holds(self, i: int) -> bool:
        """Whether nothing but rounding is left of the value of a row that is constant."""
        return self._shaken.within(i, VALUE)


def check_empty_rows(mechanics: Mechanics) -> tuple[tuple[ConstraintRow, ...], list[Mistake | Notice]]:
    """The rows, those that hold nothing as 0 = 0, and what is to be told of them."""
    rows = mechanics.constraints
    usual = _Rows(mechanics) if rows else None
    if usual is None or not usual.known:
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
                    f"{usual.value(i):.6g} = 0",
                    _remedy(row),
                    row.span,
                )
            )
        elif not all(other.is_empty(i) for other in others) and not _stays_open(
            mechanics, [j for j in empty if rows[j].span == row.span]
        ):
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


def _stays_open(mechanics: Mechanics, together: Sequence[int]) -> bool:
    """Whether, for other parameters, rows of one loop are the components of a gap that no motion changes in length."""
    if any(i >= len(mechanics.geometric) for i in together):
        return False
    for _, parameters in mechanics.anywhere(OTHERS):
        other = mechanics.having(parameters)
        found = []
        for q, _ in mechanics.anywhere(ATTEMPTS):
            try:
                found.append(math.hypot(*other.residuals(q, together)[0]))
            except (ArithmeticError, ValueError):
                continue
        if not found or not 0 < max(found) < math.inf or max(found) - min(found) > CONSTANT * max(found):
            return False
    return True


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
        if (seen := _Rows(changed)).known and not seen.is_empty(index)
    ]
    by = shown_names(named) if named else "several parameters together"
    return Mistake(
        f"the constraint `{row.name}` does not depend on the configuration for the default values of the parameters, "
        f"for others it does: {by} would change the number of constraints",
        "give defaults for which it counts, or write numbers in place of these parameters",
        row.span,
    )


def _with_other_parameters(mechanics: Mechanics) -> Iterator[_Rows]:
    seen = (_Rows(mechanics.having(parameters)) for _, parameters in mechanics.anywhere(ATTEMPTS))
    yield from islice((rows for rows in seen if rows.known), OTHERS)


def _each_changed(mechanics: Mechanics) -> Iterator[tuple[str, Mechanics]]:
    """The mechanics with one parameter changed."""
    for _, parameters in mechanics.anywhere(1):
        for name, value in parameters.items():
            yield name, mechanics.having({**mechanics.defaults, name: value})
