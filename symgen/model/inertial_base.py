"""The base of a mechanism's inertial parameters, as data: which of them count, and with what the others add to them."""

from __future__ import annotations

from symgen.model.expressions.expression import Expression
from symgen.records import dataclass

# Why there is nothing that nobody asks for: forms take some times as long as columns.
NOT_NAMED = "it is made where `outputs` name it"


@dataclass(frozen=True, slots=True)
class InertialBase:
    """What loading found out, where quantities of it are asked for.

    `columns` are the numbers of the `inertial_parameters` that stand for all: the columns of the regressor that do not
    depend on each other.  `values` are the base parameters as expressions of the parameters of the file, in this order;
    none, and the reason `why`, where no expressions hold at all values of these.  Without columns `why` is the reason
    for that.
    """

    columns: tuple[int, ...]
    values: tuple[Expression, ...] = ()
    why: str = ""
