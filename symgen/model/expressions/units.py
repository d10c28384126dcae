"""Units as vectors: exponents of the seven base dimensions and of ten.

An own table of about sixty lines, because a unit library (pint) takes 0.4 s to import, two thirds of the time a whole
run from model to C may take; a test holds the table against pint.  Angles are numbers (rad = 1), as in SI.  The power
of ten is carried along, so that metres mixed with millimetres are found like metres mixed with seconds.
"""

from __future__ import annotations

from fractions import Fraction

from symgen.diagnostics import Mistake
from symgen.model.expressions.expression import Binary, Expression, Name, Number, Power
from symgen.model.expressions.names import did_you_mean
from symgen.model.expressions.parser import parse_expression
from symgen.model.file.source import ScalarNode
from symgen.records import dataclass

BASE = ("kg", "m", "s", "A", "K", "mol", "cd")


@dataclass(frozen=True, slots=True)
class Unit:
    """Exponents of kg, m, s, A, K, mol, cd, and of ten: mm is (0, 1, 0, 0, 0, 0, 0), -3."""

    exponents: tuple[Fraction, ...]
    ten: Fraction = Fraction(0)

    def times(self, other: Unit, sign: int = 1) -> Unit:
        """The product, or with sign -1 the quotient."""
        pairs = zip(self.exponents, other.exponents, strict=True)
        return Unit(tuple(a + sign * b for a, b in pairs), self.ten + sign * other.ten)

    def to_power(self, exponent: Fraction) -> Unit:
        """The unit to a rational power."""
        return Unit(tuple(exponent * a for a in self.exponents), exponent * self.ten)

    def __str__(self) -> str:
        above = [_factor(base, e) for base, e in zip(BASE, self.exponents, strict=True) if e > 0]
        below = [_factor(base, -e) for base, e in zip(BASE, self.exponents, strict=True) if e < 0]
        scale = [] if self.ten == 0 else [f"10**{self.ten}" if self.ten.denominator == 1 else f"10**({self.ten})"]
        return "/".join(["*".join(scale + above) or "1", *below])


def _factor(base: str, exponent: Fraction) -> str:
    if exponent == 1:
        return base
    return f"{base}**{exponent}" if exponent.denominator == 1 else f"{base}**({exponent})"


def _unit(kg: int = 0, m: int = 0, s: int = 0, ampere: int = 0, ten: int = 0) -> Unit:
    return Unit(tuple(Fraction(e) for e in (kg, m, s, ampere, 0, 0, 0)), Fraction(ten))


def _base(index: int) -> Unit:
    return Unit(tuple(Fraction(int(i == index)) for i in range(len(BASE))))


NUMBER = _unit()
SECOND = _unit(s=1)
METRE = _unit(m=1)
KILOGRAM = _unit(kg=1)
_PREFIXABLE: dict[str, Unit] = {
    "g": _unit(kg=1, ten=-3),
    "m": _unit(m=1),
    "s": _unit(s=1),
    "A": _unit(ampere=1),
    "K": _base(4),
    "mol": _base(5),
    "Hz": _unit(s=-1),
    "N": _unit(1, 1, -2),
    "Pa": _unit(1, -1, -2),
    "J": _unit(1, 2, -2),
    "W": _unit(1, 2, -3),
    "C": _unit(s=1, ampere=1),
    "V": _unit(1, 2, -3, -1),
    "F": _unit(-1, -2, 4, 2),
    "ohm": _unit(1, 2, -3, -2),
    "S": _unit(-1, -2, 3, 2),
    "Wb": _unit(1, 2, -2, -1),
    "T": _unit(1, 0, -2, -1),
    "H": _unit(1, 2, -2, -2),
}
_PREFIXES = {"p": -12, "n": -9, "u": -6, "m": -3, "c": -2, "d": -1, "h": 2, "k": 3, "M": 6, "G": 9, "T": 12}
UNITS: dict[str, Unit] = {
    **{
        prefix + name: Unit(unit.exponents, unit.ten + ten)
        for prefix, ten in _PREFIXES.items()
        for name, unit in _PREFIXABLE.items()
    },
    **_PREFIXABLE,
    "cd": _base(6),
    "rad": NUMBER,
    "sr": NUMBER,
}
_ANGLES = {"deg", "degree", "degrees", "grad", "gon", "rev", "turn", "turns", "arcmin", "arcsec"}
_SPEEDS = {"rpm", "rps"}


def parse_unit(node: ScalarNode) -> Unit | Mistake:
    """The unit written in a scalar: products, quotients and powers of SI units."""
    tree = parse_expression(node)
    return tree if isinstance(tree, Mistake) else _unit_of(tree, node)


def _unit_of(tree: Expression, node: ScalarNode) -> Unit | Mistake:
    match tree:
        case Name(name=name) if name in UNITS:
            return UNITS[name]
        case Name(name=name):
            return Mistake(f"the unit `{name}` is not read", _remedy(name), tree.span)
        case Number(value=value) if value == 1:
            return NUMBER
        case Binary(operator="*" | "/" as operator, left=left, right=right):
            a, b = _unit_of(left, node), _unit_of(right, node)
            if isinstance(a, Mistake):
                return a
            return b if isinstance(b, Mistake) else a.times(b, 1 if operator == "*" else -1)
        case Power(base=base, exponent=exponent):
            inner = _unit_of(base, node)
            return inner if isinstance(inner, Mistake) else inner.to_power(exponent)
        case _:
            remedy = "write a unit as a product, quotient or power of SI units, such as kg*m**2 or m/s**2"
            return Mistake(f"`{node.value[:40]}` is no unit", remedy, tree.span or node.span)


def _remedy(name: str) -> str:
    if name in _ANGLES:
        return "write angles in rad"
    if name in _SPEEDS:
        return "write angular rates in rad/s"
    common = ["kg", *_PREFIXABLE]
    in_other_capitals = name.lower() in map(str.lower, common)
    if not in_other_capitals and (product := _as_product(name)):
        return f"write `{product}`"
    # Case matters in units, so that the nearest name is looked for among the common ones only.
    return did_you_mean(name, common, "use SI units: kg, m, s, A, K, rad, N, J, W, Pa, Hz, with prefixes")


def _as_product(name: str) -> str:
    """What was run together: `N*m` of Nm, `kg*m**2` of kgm2; empty where it is nothing of the kind."""
    letters = name.rstrip("0123456789")
    power = f"**{name[len(letters) :]}" if len(letters) < len(name) else ""
    common = ("kg", "rad", *_PREFIXABLE)
    if power and letters in common:
        return letters + power
    splits = ((letters[:k], letters[k:]) for k in range(1, len(letters)))
    return next((f"{left}*{right}{power}" for left, right in splits if left in common and right in common), "")
