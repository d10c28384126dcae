"""Parameters that must keep their values, because rows that depend on each other can be closed for no others.

Where y^T B = 0 on the branch that is meant, no motion changes y^T g to first order: a parameter that does opens the
loops for good.  A parallelogram with three cranks closes for three equal lengths only.
"""

from __future__ import annotations

from collections.abc import Callable

from symgen.model.configurations.assembly import Assembly
from symgen.model.configurations.dense import Rows, null_space
from symgen.model.configurations.mechanics import NumericSystem, default_values

# Of a parameter, its change, and how many times as far what is left must grow with it.
STEP, AS_FAR = 1e-5, 10.0
# Of the change, that no motion makes up for.
OPENS = 1e-3
# Of what is left of the change that is larger, by which it may differ from the proportion.
LINEAR = 0.2
# Of rows of length 1: up to which they depend on each other; of the largest entry, up to which columns are nothing.
TIED_RANK, NOISE = 1e-6, 1e-9
# Of a row that takes no part, which is what rounding leaves in y.
REST_OF_ROWS = 1e-11


def tied_parameters(written: NumericSystem, counted: NumericSystem, assembly: Assembly) -> tuple[str, ...]:
    """Their names; `written` has the rows as they stand, `counted` those that hold nothing as 0 = 0."""
    rows = counted.geometric
    if assembly.ranks.geometric == len(rows):
        return ()
    q = assembly.places[0].q
    jacobian = counted.jacobian(q)[: len(rows)]
    units = [1 / (max(map(abs, row), default=0.0) or 1.0) for row in jacobian]
    columns = [[unit * row[j] for unit, row in zip(units, jacobian, strict=True)] for j in range(len(q))]
    most = max((abs(entry) for column in columns for entry in column), default=0.0)
    telling = [column for column in columns if max(map(abs, column)) > NOISE * most]
    still = null_space(telling, len(rows), TIED_RANK)
    if len(still) != len(rows) - assembly.ranks.geometric:
        return ()
    before = written.residuals(q, range(len(rows)))[0]

    def change(name: str, step: float) -> list[float]:
        after = written.having(default_values(written.parameters, {name: written.defaults[name] + step}))
        pairs = zip(units, after.residuals(q, range(len(rows)))[0], before, strict=True)
        return [unit * (there - here) for unit, there, here in pairs]

    sizes = {name: abs(value) or 1.0 for name, value in written.defaults.items()}
    return tuple(p.name for p in written.parameters if _opens(still, change, p.name, sizes[p.name]))


def _opens(still: Rows, change: Callable[[str, float], list[float]], name: str, size: float) -> bool:
    """Whether a change of a parameter leaves of the rows what no motion makes up for, in proportion to itself."""
    try:
        little, more = change(name, STEP * size), change(name, AS_FAR * STEP * size)
    except (ArithmeticError, ValueError):
        return False
    for vector in still:
        near, far = (sum(y * x for y, x in zip(vector, moved, strict=True)) for moved in (little, more))
        whole = sum(abs(y * x) for y, x in zip(vector, little, strict=True))
        rest = REST_OF_ROWS * max(map(abs, vector)) * max(map(abs, little))
        if abs(near) > max(OPENS * whole, rest) and abs(far - AS_FAR * near) < LINEAR * AS_FAR * abs(near):
            return True
    return False
