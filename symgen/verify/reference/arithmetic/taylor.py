"""Truncated Taylor polynomials in coordinates and rates, over the registers of a tape.

A polynomial maps monomials to registers: key `((0, 2), (1,))` stands for q_0 q_2 qd_1 (increments of the coordinates,
rates about zero).  It keeps monomials up to a degree in the coordinates and a degree in the rates, so second
derivatives of T in the rates, with their gradients, come out of one pass (hyper-dual numbers are the special case).
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import factorial
from typing import TypeAlias

from symgen.diagnostics import SymgenBug
from symgen.verify.reference.arithmetic.tape import Register, Tape

Monomial: TypeAlias = tuple[tuple[int, ...], tuple[int, ...]]
Polynomial: TypeAlias = dict[Monomial, Register]
CONSTANT: Monomial = ((), ())


@dataclass(frozen=True)
class Taylor:
    """Arithmetic of polynomials of degree up to `coordinates` in the coordinates and `rates` in the rates.

    One of the coordinates may be the time along a line: to first order, the others to one degree less each.
    """

    tape: Tape
    coordinates: int
    rates: int
    along: int | None = None

    @property
    def of_rates(self) -> Taylor:
        """The arithmetic of the rates of places in this one: one degree less, linear in the rates."""
        return Taylor(self.tape, self.coordinates - 1, 1, self.along)

    def keeps(self, coordinates: tuple[int, ...], rates: tuple[int, ...]) -> bool:
        """Whether a monomial is not too high."""
        if len(coordinates) > self.coordinates or len(rates) > self.rates:
            return False
        if self.along is None:
            return True
        times = coordinates.count(self.along)
        return times <= 1 and len(coordinates) - times < self.coordinates

    def add(self, left: Polynomial, right: Polynomial) -> Polynomial:
        """Sum."""
        total = dict(left)
        for monomial, register in right.items():
            known = total.get(monomial)
            total[monomial] = register if known is None else self.tape.binary("add", known, register)
        return total

    def negate(self, operand: Polynomial) -> Polynomial:
        """Minus the operand."""
        return {monomial: self.tape.unary("neg", register) for monomial, register in operand.items()}

    def subtract(self, left: Polynomial, right: Polynomial) -> Polynomial:
        """Difference."""
        total = dict(left)
        for monomial, register in right.items():
            known = total.get(monomial)
            total[monomial] = (
                self.tape.unary("neg", register) if known is None else self.tape.binary("sub", known, register)
            )
        return total

    def multiply(self, left: Polynomial, right: Polynomial) -> Polynomial:
        """Product, truncated."""
        total: Polynomial = {}
        for (left_q, left_v), a in left.items():
            for (right_q, right_v), b in right.items():
                if not self.keeps(left_q + right_q, left_v + right_v):
                    continue
                monomial = (tuple(sorted(left_q + right_q)), tuple(sorted(left_v + right_v)))
                product = self.tape.binary("mul", a, b)
                known = total.get(monomial)
                total[monomial] = product if known is None else self.tape.binary("add", known, product)
        return total

    def divide(self, left: Polynomial, right: Polynomial) -> Polynomial:
        """Quotient; the divisor's value must not vanish."""
        if list(right) == [CONSTANT]:
            return {k: self.tape.binary("div", register, right[CONSTANT]) for k, register in left.items()}
        return self.multiply(left, self.reciprocal(right))

    def reciprocal(self, operand: Polynomial) -> Polynomial:
        """One over the operand."""
        inverse = self.tape.binary("div", self.tape.one, self._value(operand))
        coefficients = [inverse]
        for _ in range(self._order):
            coefficients.append(self.tape.unary("neg", self.tape.binary("mul", coefficients[-1], inverse)))
        return self._compose(coefficients, operand)

    def power(self, base: Polynomial, exponent: Fraction) -> Polynomial:
        """A power with an exact rational exponent; integer powers are products."""
        if exponent.denominator == 1:
            product = self._whole_power(base, abs(exponent.numerator))
            return product if exponent >= 0 else self.reciprocal(product)
        value = self._value(base)
        root = exponent == Fraction(1, 2)
        first = self.tape.unary("sqrt", value) if root else self.tape.binary("pow", value, self.tape.constant(exponent))
        if list(base) == [CONSTANT]:
            return {CONSTANT: first}
        inverse = self.tape.binary("div", self.tape.one, value)
        coefficients = [first]
        for k in range(1, self._order + 1):
            factor = (exponent - k + 1) / k
            coefficients.append(self.tape.scaled(factor, self.tape.binary("mul", coefficients[-1], inverse)))
        return self._compose(coefficients, base)

    def function(self, name: str, operand: Polynomial) -> Polynomial:
        """A function of one argument."""
        if name == "sqrt":
            return self.power(operand, Fraction(1, 2))
        value = self._value(operand)
        if list(operand) == [CONSTANT]:
            return {CONSTANT: self.tape.unary(name, value)}
        return self._compose(self._coefficients(name, value), operand)

    def angle(self, y: Polynomial, x: Polynomial) -> Polynomial:
        """atan2(y, x): its value, plus the arc tangent of the (nilpotent) tangent of the angle's change."""
        y_0, x_0 = self._value(y), self._value(x)
        value: Polynomial = {CONSTANT: self.tape.binary("atan2", y_0, x_0)}
        numerator = self.subtract(self.multiply(y, {CONSTANT: x_0}), self.multiply(x, {CONSTANT: y_0}))
        numerator.pop(CONSTANT, None)
        if not numerator:
            return value
        denominator = self.add(self.multiply(x, {CONSTANT: x_0}), self.multiply(y, {CONSTANT: y_0}))
        tangent = self.divide(numerator, denominator)
        cube = self.multiply(tangent, self.multiply(tangent, tangent))
        third = {CONSTANT: self.tape.constant(Fraction(-1, 3))}
        return self.add(value, self.add(tangent, self.multiply(cube, third)))

    @property
    def _order(self) -> int:
        return self.coordinates + self.rates

    def _value(self, operand: Polynomial) -> Register:
        return operand.get(CONSTANT, self.tape.zero)

    def _whole_power(self, base: Polynomial, exponent: int) -> Polynomial:
        result: Polynomial = {CONSTANT: self.tape.one}
        square = base
        while exponent:
            if exponent & 1:
                result = self.multiply(result, square)
            exponent >>= 1
            if exponent:
                square = self.multiply(square, square)
        return result

    def _compose(self, coefficients: list[Register], operand: Polynomial) -> Polynomial:
        """sum_k coefficients[k] h^k by Horner's rule, h the operand without its value."""
        change = {monomial: register for monomial, register in operand.items() if monomial != CONSTANT}
        if not change:
            return {CONSTANT: coefficients[0]}
        result: Polynomial = {CONSTANT: coefficients[-1]}
        for coefficient in reversed(coefficients[:-1]):
            result = self.add({CONSTANT: coefficient}, self.multiply(change, result))
        return result

    def _coefficients(self, name: str, a: Register) -> list[Register]:
        """Taylor coefficients of the function about `a`, up to the order kept."""
        tape = self.tape
        order = self._order
        if name in ("sin", "cos", "sinh", "cosh", "exp"):
            return self._periodic_coefficients(name, a)
        if order > 3:
            raise SymgenBug(f"reference: Taylor polynomials of order {order} are not provided for {name}")
        f = tape.unary(name, a)
        one, mul, add = tape.one, self._mul, self._add
        if name == "log":
            w = tape.binary("div", one, a)
            tail = [w, tape.scaled(Fraction(-1, 2), mul(w, w)), tape.scaled(Fraction(1, 3), mul(w, w, w))]
        elif name == "tan":
            w = add(one, mul(f, f))
            tail = [w, mul(f, w), mul(w, self._affine(Fraction(1, 3), Fraction(1), mul(f, f)))]
        elif name == "tanh":
            w = tape.binary("sub", one, mul(f, f))
            tail = [w, tape.unary("neg", mul(f, w)), mul(w, self._affine(Fraction(-1, 3), Fraction(1), mul(f, f)))]
        elif name == "atan":
            w = tape.binary("div", one, add(one, mul(a, a)))
            cubic = mul(w, w, w, self._affine(Fraction(-1, 3), Fraction(1), mul(a, a)))
            tail = [w, tape.unary("neg", mul(a, w, w)), cubic]
        elif name in ("asin", "acos"):
            w = tape.binary("div", one, tape.unary("sqrt", tape.binary("sub", one, mul(a, a))))
            cube = mul(w, w, w)
            cubic = mul(cube, self._affine(Fraction(1, 6), Fraction(1, 2), mul(a, a, w, w)))
            tail = [w, tape.scaled(Fraction(1, 2), mul(a, cube)), cubic]
            if name == "acos":
                tail = [tape.unary("neg", register) for register in tail]
        else:
            raise SymgenBug(f"reference: unknown function {name}")
        return [f, *tail][: order + 1]

    def _periodic_coefficients(self, name: str, a: Register) -> list[Register]:
        """Functions whose derivatives repeat after one, two or four steps."""
        partner = {"sin": "cos", "cos": "sin", "sinh": "cosh", "cosh": "sinh", "exp": "exp"}[name]
        cycle = [self.tape.unary(name, a), self.tape.unary(partner, a)]
        signs = {"sin": (1, 1, -1, -1), "cos": (1, -1, -1, 1)}.get(name, (1, 1, 1, 1))
        return [self.tape.scaled(Fraction(signs[k % 4], factorial(k)), cycle[k % 2]) for k in range(self._order + 1)]

    def _mul(self, *factors: Register) -> Register:
        product = factors[0]
        for factor in factors[1:]:
            product = self.tape.binary("mul", product, factor)
        return product

    def _add(self, left: Register, right: Register) -> Register:
        return self.tape.binary("add", left, right)

    def _affine(self, offset: Fraction, slope: Fraction, operand: Register) -> Register:
        return self._add(self.tape.constant(offset), self.tape.scaled(slope, operand))
