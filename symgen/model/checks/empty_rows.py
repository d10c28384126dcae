"""Rows that hold nothing: their gradients vanish in every configuration, up to the rounding of the file's numbers."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import islice

from symgen.diagnostics import Mistake, Notice, Span
from symgen.model.checks.shaken import Shaken
from symgen.model.configurations.mechanics import NumericSystem
from symgen.model.configurations.sparse import Row
from symgen.model.expressions.expression import Number
from symgen.model.expressions.names import shown_names
from symgen.model.expressions.walk import names_in
from symgen.model.mechanism import is_component
from symgen.model.model import ConstraintRow, Input

# Configurations at which rows are looked at, other values of the parameters for which that is repeated, and draws to
# find as many.
ROW_POINTS, OTHERS, ROW_DRAWS = 2, 2, 20
# Of the length of a gap, that it may differ by between configurations.
CONSTANT = 1e-6
# The number under which the value of a row stands beside its entries.
VALUE = -1
ZERO = Number(Fraction(0))


class _ShakenRows:
    """The rows shaken at a few random configurations; the value of a geometric row is one of its entries."""

    def __init__(self, mechanics: NumericSystem) -> None:
        self._shaken = Shaken(mechanics, (), self._evaluated)
        places = (q for q, _ in mechanics.anywhere(ROW_DRAWS))
        self.known = sum(islice(filter(None, map(self._shaken.look, places)), ROW_POINTS)) == ROW_POINTS

    @staticmethod
    def _evaluated(mechanics: NumericSystem, _: Sequence[Input], q: Sequence[float]) -> list[Row]:
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


def parameters_that_count(mechanics: NumericSystem) -> tuple[str, ...]:
    """Parameters for whose default values alone rows are empty, in the order of the file.

    With others there would be one more constraint, so that kernels for both cannot be one: these take the numbers.
    A gap that no motion changes in length is none of them, since there is no machine then.
    """
    usual = _ShakenRows(mechanics) if mechanics.constraints else None
    if usual is None or not usual.known:
        return ()
    rows = mechanics.constraints
    holding = [i for i in range(len(rows)) if usual.is_empty(i) and usual.holds(i)]
    loops = [[j for j in holding if rows[j].span == rows[i].span] for i in holding]
    counting = [i for i, loop in zip(holding, loops, strict=True) if not _stays_open(mechanics, loop)]
    named = set[str]()
    while (name := _other_parameters(mechanics, counting, named)) is not None:
        named.add(name)
    return tuple(parameter.name for parameter in mechanics.parameters if parameter.name in named)


def _other_parameters(mechanics: NumericSystem, counting: Sequence[int], but: set[str]) -> str | None:
    """The first parameter that keeps a row from being empty, with all that it takes besides; None where none does."""
    for values in _draws(mechanics, but, OTHERS) if counting else ():
        drawn = _ShakenRows(mechanics.having(values))
        row = next((i for i in counting if not drawn.is_empty(i)), None)
        if row is None:
            continue
        needed = []
        for name, default in mechanics.defaults.items():
            without = _ShakenRows(mechanics.having({**values, name: default}))
            if values[name] != default and without.known and not without.is_empty(row):
                values[name] = default
            elif values[name] != default:
                needed.append(name)
        return needed[0] if needed else None
    return None


def _draws(mechanics: NumericSystem, but: set[str], count: int) -> Iterator[dict[str, float]]:
    """Random parameters for which the rows are known, with some at their defaults."""
    for _, parameters in mechanics.anywhere(ROW_DRAWS):
        values = {**parameters, **{name: mechanics.defaults[name] for name in but}}
        if _ShakenRows(mechanics.having(values)).known:
            yield values
            count -= 1
        if not count:
            return


def check_empty_rows(mechanics: NumericSystem) -> tuple[tuple[ConstraintRow, ...], list[Mistake | Notice]]:
    """The rows, those that hold nothing as 0 = 0, and what is to be told of them.

    `parameters_that_count` are numbers here.
    """
    rows = mechanics.constraints
    usual = _ShakenRows(mechanics) if rows else None
    if usual is None or not usual.known:
        return rows, []
    empty = [i for i in range(len(rows)) if usual.is_empty(i)]
    if not empty:
        return rows, []
    others = [_ShakenRows(mechanics.having(values)) for values in _draws(mechanics, set(), OTHERS)]
    reports: list[Mistake | Notice] = []
    idle: dict[Span | None, list[str]] = {}
    fitting: dict[Span | None, list[str]] = {}
    taken = list(rows)
    for i in empty:
        row = rows[i]
        if not usual.holds(i):
            reports.append(
                Mistake(
                    f"the constraint `{row.name}` does not depend on the configuration: it demands "
                    f"{usual.value(i):.6g} = 0",
                    _remedy(row),
                    row.span,
                )
            )
        else:
            taken[i] = replace(row, expression=ZERO)
            group = idle if all(other.holds(i) for other in others) else fitting
            group.setdefault(row.span, []).append(row.name)
    reports += [Notice(_says_nothing(names, rows), span) for span, names in idle.items()]
    reports += [
        Notice(
            f"{_the_constraints(names)} {'does' if len(names) == 1 else 'do'} not depend on the configuration: what "
            "is demanded of parameters holds for their default values, and nothing is said about motion",
            span,
        )
        for span, names in fitting.items()
    ]
    return tuple(taken), reports


def _stays_open(mechanics: NumericSystem, together: Sequence[int]) -> bool:
    """Whether, for other parameters, rows of one loop are the components of a gap that no motion changes in length."""
    if any(i >= len(mechanics.geometric) for i in together):
        return False
    for _, parameters in mechanics.anywhere(OTHERS):
        other = mechanics.having(parameters)
        gaps = []
        for q, _ in mechanics.anywhere(ROW_DRAWS):
            try:
                gaps.append(math.hypot(*other.residuals(q, together)[0]))
            except (ArithmeticError, ValueError):
                continue
        if not gaps or not 0 < max(gaps) < math.inf or max(gaps) - min(gaps) > CONSTANT * max(gaps):
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
