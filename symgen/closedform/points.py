"""Points of a model at 40 digits: evaluation of ring elements, configurations on V, and ranks."""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager
from fractions import Fraction
from functools import lru_cache, reduce
from operator import mul

import flint
import mpmath
from mpmath import mp, mpf
from sympy.polys.rings import PolyElement

from symgen.closedform.algebra.quotient import Matrix, Quotient
from symgen.closedform.mechanics import ExactSystem
from symgen.model.configurations.dense import pivots
from symgen.model.expressions.expression import Binary, Call, Expression, Name, Negation, Number, Pi, Power
from symgen.model.model import Model
from symgen.validity.descent import Evaluated, zero_beside

# Decimal digits to which a point satisfies the constraints.
POINT_DIGITS = 40
RANK_THRESHOLD = mpf(10) ** -18
# Newton steps towards a point on the constraints.
MOST_STEPS = 60
# Times the size of its start beyond which a search has lost its way.
FARTHEST = 1e6


def number(value: Fraction) -> mpf:
    """An exact rational at working precision."""
    return mpf(value.numerator) / mpf(value.denominator)


def evaluate_expression(
    expression: Expression, values: dict[str, mpf], definitions: Mapping[str, Expression]
) -> mpf:
    """The value of a model expression; raises ValueError where it is not a real number.

    Values of definitions are entered in `values`, so that each is worked out once however definitions nest.
    """
    match expression:
        case Number(value):
            return number(value)
        case Pi():
            return mp.pi
        case Name(name):
            if name not in values and name in definitions:
                values[name] = evaluate_expression(definitions[name], values, definitions)
            return values[name]
        case Negation(operand):
            return -evaluate_expression(operand, values, definitions)
        case Binary(operator, left, right):
            a = evaluate_expression(left, values, definitions)
            b = evaluate_expression(right, values, definitions)
            return a + b if operator == "+" else a - b if operator == "-" else a * b if operator == "*" else a / b
        case Power(base, exponent):
            power = evaluate_expression(base, values, definitions) ** number(exponent)
            return _real(power)
        case Call(function, arguments):
            inner = [evaluate_expression(a, values, definitions) for a in arguments]
            return _real(getattr(mpmath, function)(*inner))


def _real(value: object) -> mpf:
    if isinstance(value, mpmath.mpc):
        raise ValueError("not a real number")
    return value


def _working_precision() -> AbstractContextManager[None]:
    """Flint's numbers, an order of magnitude faster, with the digits of mpmath's."""
    precision: AbstractContextManager[None] = flint.ctx.workprec(mp.prec)
    return precision


class RingPoint:
    """Values of all variables of a ring, ready to evaluate its elements."""

    def __init__(self, mechanics: ExactSystem, values: Mapping[str, mpf]) -> None:
        self.values = dict(values)
        ring, definitions = mechanics.ring, mechanics.translator.definitions
        generators = [self.values.get(name, mpf(0)) for name in ring.variables]
        known = dict(self.values)
        for name in mechanics.translator.nested:  # in the order of use: a long chain is no deep recursion
            evaluate_expression(Name(name), known, definitions)
        for atom in ring.basis.atoms:
            angle = mpf(0)
            for base, factor in atom:
                angle += number(factor) * evaluate_expression(base, known, definitions)
            generators += [mpmath.sin(angle), mpmath.cos(angle)]
        for opaque in ring.opaque:
            generators.append(evaluate_expression(opaque.expression, known, definitions))
        with _working_precision():
            self._generators = [flint.arb(value) for value in generators]

    def polynomial(self, p: PolyElement) -> mpf:
        """The value of a ring element."""
        with _working_precision():
            return _as_mpf(self._value(p))

    def quotient(self, value: Quotient) -> mpf:
        """The value of a fraction."""
        with _working_precision():
            return _as_mpf(self._fraction(value))

    def matrix(self, matrix: Matrix) -> list[list[mpf]]:
        """The values of a matrix."""
        return [[_as_mpf(value) for value in row] for row in self.flint_matrix(matrix)]

    def constraints(self, mechanics: ExactSystem, model: Model) -> list[list[mpf]]:
        """B with rows of ordinary size."""
        rows = zip(self.matrix(mechanics.jacobian), _units(model), strict=True)
        return [[mpf(2) ** unit * x for x in row] for row, unit in rows]

    def flint_matrix(self, matrix: Matrix) -> list[list[flint.arb]]:
        """The same as flint's numbers, without their error bounds."""
        with _working_precision():
            return [[self._fraction(entry) for entry in row] for row in matrix]

    def _fraction(self, value: Quotient) -> flint.arb:
        top = self._value(value.numerator)
        if value.is_polynomial:
            return top
        bottom = self._value(value.denominator)
        if bottom == 0:
            raise ZeroDivisionError
        return (top / bottom).mid()

    def _value(self, p: PolyElement) -> flint.arb:
        generator = self._generators.__getitem__
        total = flint.arb(0)
        for coefficient, positions in _terms(p):
            total += reduce(mul, map(generator, positions), coefficient)
        return total.mid()


@lru_cache(maxsize=4096)  # the same rows at every step of Newton's method; at the working precision of all points
def _terms(p: PolyElement) -> tuple[tuple[flint.arb, tuple[int, ...]], ...]:
    """Coefficients, and the positions of the generators that are multiplied, each as often as its power says."""
    return tuple(
        (
            flint.arb(int(coefficient.numerator)) / int(coefficient.denominator),
            tuple([position for position, exponent in enumerate(monomial) for _ in range(exponent)]),
        )
        for monomial, coefficient in p.items()
    )


def _as_mpf(value: flint.arb) -> mpf:
    mantissa, exponent = value.mid().man_exp()
    return mpf((int(mantissa), int(exponent)))


def parameter_values(model: Model) -> dict[str, mpf]:
    """The parameters' default values."""
    values: dict[str, mpf] = {}
    for parameter in model.parameters:
        values[parameter.name] = evaluate_expression(parameter.value, values, {})
    return values


def generic_points(model: Model, mechanics: ExactSystem, count: int, on_constraints: bool = True) -> list[RingPoint]:
    """Points at the default parameters, random (but the same every time) in everything else; on V by default.

    Fewer than `count` when Newton's method does not reach V or expressions have no real value.  They lie near the
    configurations that loading found on the branch of V that is meant.
    """
    mp.dps = POINT_DIGITS + 10
    source = random.Random(1)
    parameters = parameter_values(model)
    known = model.assembly
    starts = [dict(model.configuration)]
    if on_constraints and known is not None and (known.has_branches or mechanics.residual):
        names = [c.name for c in model.coordinates]
        starts = [dict(zip(names, map(Fraction, place.q), strict=True)) for place in known.places]
    points: list[RingPoint] = []
    for attempt in range(6 * count):
        if len(points) == count:
            break
        values = dict(parameters)
        start = starts[attempt % len(starts)]
        for c in model.coordinates:
            spread = 0.3 if c.name in start and mechanics.residual else 2.0
            middle = number(start.get(c.name, Fraction(0)))
            values[c.name] = middle + mpf(source.uniform(-spread, spread) / (1 + attempt // 3))
        for name in mechanics.ring.variables:
            values.setdefault(name, mpf(source.uniform(-2, 2)))
        try:
            point = _onto_constraints(model, mechanics, values) if on_constraints else RingPoint(mechanics, values)
        except (ValueError, ArithmeticError):
            continue
        if point is not None:
            points.append(point)
    return points


def _onto_constraints(model: Model, mechanics: ExactSystem, values: dict[str, mpf]) -> RingPoint | None:
    """A point on V beside `values`; None where no way leads there, ArithmeticError where it leads far away."""
    if not mechanics.residual:
        return RingPoint(mechanics, values)
    names = [c.name for c in model.coordinates]
    units = _units(model)[: len(mechanics.residual)]
    rows = mechanics.jacobian[: len(units)]
    farthest = FARTHEST * max(1.0, *(abs(float(values[name])) for name in names))

    def at(x: list[flint.arb]) -> RingPoint:
        return RingPoint(mechanics, values | dict(zip(names, map(_as_mpf, x), strict=True)))

    def evaluate(x: list[flint.arb]) -> Evaluated:
        if any(abs(float(value)) > farthest for value in x):
            raise ArithmeticError("the way to the constraints is lost")
        point = at(x)
        gaps = _scaled(point.flint_matrix(mechanics.residual), units)
        return [gap for (gap,) in gaps], _scaled(point.flint_matrix(rows), units)

    with _working_precision():
        start = [flint.arb(values[name]) for name in names]
        zero = zero_beside(evaluate, start, 10.0**-POINT_DIGITS, MOST_STEPS, 1e-3)
    return None if zero is None else at(zero)


def _units(model: Model) -> tuple[int, ...]:
    """The powers of 2 that bring rows to ordinary size."""
    units = () if model.assembly is None else model.assembly.units
    return units or (0,) * model.r


def _scaled(rows: list[list[flint.arb]], units: Sequence[int]) -> list[list[flint.arb]]:
    return [[flint.arb(2) ** unit * x for x in row] if unit else row for row, unit in zip(rows, units, strict=True)]


def rank(matrix: Sequence[Sequence[mpf]]) -> int:
    """The numerical rank by elimination, beside the largest entry: a row that vanishes on V has no size of its own."""
    scale = max((abs(x) for row in matrix for x in row), default=mpf(0))
    return pivots([list(row) for row in matrix], RANK_THRESHOLD * scale)
