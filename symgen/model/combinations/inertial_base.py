"""The base of a model for the quantities that are made of it: its columns, and values that hold at run time.

Kernels are given every parameter by itself, those of the geometry among them.  What combinations are at the values of
the file is no matter of forms; that forms hold at others is seen at values in general position.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from fractions import Fraction

from symgen.model.checks.as_numbers import with_numbers_by_default
from symgen.model.combinations.ball_matrices import Echelon
from symgen.model.combinations.base_parameters import (
    BaseParameters,
    CombinationSearch,
    base_parameters,
    in_general_position,
    with_enough_digits,
)
from symgen.model.combinations.coefficient_forms import CoefficientForm, FormTerm, form_value
from symgen.model.combinations.geometry import geometric_expressions, names_reached
from symgen.model.combinations.motion_states import NoMotionError
from symgen.model.combinations.taylor_balls import may_vanish
from symgen.model.configurations.mechanics import default_values
from symgen.model.expressions.combine import divided, plus, times
from symgen.model.expressions.expression import Call, Expression, Name, Number, Power
from symgen.model.expressions.names import shown_names
from symgen.model.expressions.walk import exact_value
from symgen.model.inertial_base import NOT_NAMED, InertialBase
from symgen.model.inertial_parameters import expressions
from symgen.model.model import Model

# What a length or an angle that is 0 in the file is changed to.
FROM_ZERO = Fraction(1, 32)
NUMBERS = "write numbers in their place in frames, points, constraints and gravity"


def inertial_base(model: Model, with_values: bool) -> InertialBase:
    """The base of a model with bodies or rotors: its columns, and values where these are asked for."""
    model = with_numbers_by_default(model)
    try:
        there = with_enough_digits(lambda: CombinationSearch(model).echelon({}))
    except NoMotionError:
        return InertialBase((), (), "no regular motion was found at which inertial parameters could be told apart")
    columns = tuple(sorted(there.pivots))
    if not with_values:
        return InertialBase(columns, (), NOT_NAMED)
    varied = _varied(model)
    try:
        made = base_parameters(_with(model, varied))
        why = with_enough_digits(lambda: _why_not_everywhere(made, columns, varied))
    except NoMotionError:
        why = f"with other values of {shown_names(varied)} no motion was found: {NUMBERS}"
    if why:
        return InertialBase(columns, (), why)
    given = dict(zip(made.parameters, expressions(model.mechanism), strict=True))
    values: list[Expression] = []
    for one in made.base:
        total = given[one.stays]
        for other, form in one.added:
            total = plus(total, times(_expression(form), given[other]))
        values.append(total)
    return InertialBase(columns, tuple(values))


def _varied(model: Model) -> dict[str, Fraction]:
    """Parameters of the geometry and of gravity that may have other values; what is 0 in the file is not here."""
    reached = names_reached(model, (*geometric_expressions(model), *model.mechanism.gravity))
    tied = _tied(model)
    defaults, exact = default_values(model.parameters), _exact_values(model)
    names = [p.name for p in model.parameters if p.name in reached and p.name not in tied]
    return {name: exact.get(name, Fraction(defaults[name])) or FROM_ZERO for name in names}


def _tied(model: Model) -> tuple[str, ...]:
    """Parameters that keep their values, as the loops close for no others."""
    return () if model.assembly is None else model.assembly.tied


def _exact_values(model: Model) -> dict[str, Fraction]:
    values = {p.name: exact_value(p.value) for p in model.parameters}
    return {name: value for name, value in values.items() if value is not None}


def _with(model: Model, given: Mapping[str, Fraction]) -> Model:
    """The model with these values for parameters that are 0."""
    made = (
        replace(p, value=Number(given[p.name])) if p.name in given and exact_value(p.value) == 0 else p
        for p in model.parameters
    )
    return replace(model, parameters=tuple(made))


def _why_not_everywhere(made: BaseParameters, columns: tuple[int, ...], varied: Mapping[str, Fraction]) -> str:
    """Why the forms do not hold at all values of the parameters, or nothing."""
    given = in_general_position(varied, 1)
    there = CombinationSearch(made.model).echelon(given)
    names = shown_names(varied)
    if there.rank != len(columns):
        counts = f"{len(columns)} combinations of inertial parameters count, and {there.rank} with others"
        return f"with the values of {names} in the file {counts}: {NUMBERS}"
    forms = [form for one in made.base for _, form in one.added]
    if unknown := [form for form in forms if not form.terms]:
        by = dict.fromkeys(name for form in unknown for name in form.changed_by)
        return _without_forms(by or varied or _tied(made.model))
    if not made.columns == columns == tuple(sorted(there.pivots)) or not _hold(made, given, there):
        return _without_forms(varied)
    return ""


def _without_forms(names: Collection[str]) -> str:
    return f"no short closed forms in {shown_names(names)} were found for its combinations: {NUMBERS}"


def _hold(made: BaseParameters, given: Mapping[str, Fraction], there: Echelon) -> bool:
    """Whether every coefficient is what its form says there, 0 where it has none.

    Nothing is divided by what is 0 in the file: columns that do not depend on each other there have no pole.
    """
    for one in made.base:
        forms = {made.parameters.index(other): form for other, form in one.added}
        row = there.rows[there.pivots.index(made.parameters.index(one.stays))]
        for k, entry in enumerate(row):
            if k not in there.pivots and not may_vanish(entry - form_value(forms[k], given) if k in forms else entry):
                return False
    return True


def _expression(form: CoefficientForm) -> Expression:
    total: Expression = Number(Fraction(0))
    for term in form.terms:
        total = plus(total, _product(term))
    return total


def _product(term: FormTerm) -> Expression:
    above: Expression = Number(term.factor)
    if term.root != 1:
        above = times(above, Call("sqrt", (Number(Fraction(term.root)),)))
    below: Expression = Number(Fraction(1))
    for name, power in term.powers:
        factor = Name(name) if abs(power) == 1 else Power(Name(name), Fraction(abs(power)))
        above, below = (times(above, factor), below) if power > 0 else (above, times(below, factor))
    return divided(above, below)
