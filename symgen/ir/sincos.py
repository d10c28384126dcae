"""The portable sine/cosine pair as a straight-line function of + - * only.

The argument is reduced by multiples of pi/2 in three or four parts (Cody and Waite, Software Manual for the Elementary
Functions, ch. 8), whose leading parts are short enough that their products with the multiple are exact; minimax
polynomials on |r| <= pi/4 give both values; the quadrant acts through products with 0 and +-1, so that there is no
branch, no table, no integer and no library call, and every IEEE machine returns the same bits.
"""

from __future__ import annotations

from fractions import Fraction

from symgen.ir.kernel import Function, Literal, Local, Operand, OperationName, Scalar, Statement
from symgen.symbolic.scalar import PI

# Beyond these the reduction is no longer accurate, and kernels answer ANGLE_RANGE; the second ones cost two operations
# more (five in single precision) and serve wheels that turn for hours.
ANGLE_LIMIT: dict[Scalar, Fraction] = {"float64": Fraction(100_000), "float32": Fraction(100)}
WIDE_ANGLE_LIMIT: dict[Scalar, Fraction] = {"float64": Fraction(10_000_000), "float32": Fraction(40_000)}

# Coefficients of sin r = r + r z S(z) and cos r = 1 - z/2 + z^2 C(z), z = r^2: minimax on [0, (pi/4 + 2^-8)^2] among
# polynomials with coefficients of the scalar type.
SINE: dict[Scalar, tuple[float, ...]] = {
    "float64": (
        -0.1666666666666663,
        0.008333333333321745,
        -0.00019841269829238656,
        2.7557313486831633e-06,
        -2.5050725132834445e-08,
        1.589484384683705e-10,
    ),
    "float32": (
        -0.16666653752326965,
        0.008332106284797192,
        -0.00019507884280756116,
    ),
}
COSINE: dict[Scalar, tuple[float, ...]] = {
    "float64": (
        0.04166666666666659,
        -0.0013888888888872186,
        2.480158728829539e-05,
        -2.7557314015123173e-07,
        2.087567808506299e-09,
        -1.1357336743725894e-11,
    ),
    "float32": (
        0.04166664555668831,
        -0.0013887304812669754,
        2.4431425117654726e-05,
    ),
}
# 1.5 * 2^(p-1): adding and subtracting it rounds to the nearest integer.
ROUNDER: dict[Scalar, Fraction] = {"float64": Fraction(3 * 2**51), "float32": Fraction(3 * 2**22)}
# Bits of the leading parts of pi/2: their products with every multiple in range fit into the significand. In the wide
# range the second one ends where the last bit of 1 does, so that what is left is exact before the third is taken away.
LEADING_BITS: dict[Scalar, tuple[int, ...]] = {"float64": (36, 36), "float32": (17, 18)}
WIDE_LEADING_BITS: dict[Scalar, tuple[int, ...]] = {"float64": (30, 24, 30), "float32": (9, 9, 9)}


def angle_limit(scalar: Scalar, wide: bool) -> Fraction:
    """The largest magnitude of an argument whose sine and cosine are accurate."""
    return (WIDE_ANGLE_LIMIT if wide else ANGLE_LIMIT)[scalar]


def half_pi_parts(scalar: Scalar, wide: bool) -> tuple[Fraction, ...]:
    """pi/2 as a sum of short parts and a rest."""
    rest = PI / 2
    parts = []
    for bits in (WIDE_LEADING_BITS if wide else LEADING_BITS)[scalar]:
        shift = bits - 1 - _exponent(rest)
        part = Fraction(int(rest * 2**shift), 1) / 2**shift
        parts.append(part)
        rest -= part
    return (*parts, rest)


def _exponent(value: Fraction) -> int:
    """floor(log2 value)."""
    exponent = value.numerator.bit_length() - value.denominator.bit_length()
    return exponent if value >= Fraction(2) ** exponent else exponent - 1


class _SincosWriter:
    """Appends one statement per operation."""

    def __init__(self) -> None:
        self.statements: list[Statement] = []

    def __call__(self, target: str, operation: OperationName, a: Operand, b: Operand) -> Local:
        self.statements.append(Statement((target,), operation, (a, b)))
        return Local(target)


def sincos(scalar: Scalar, wide: bool = False) -> Function:
    """The function (sine, cosine) = sincos(x) for one scalar type and range."""
    emit = _SincosWriter()
    x = Local("x")
    rounder = Literal(ROUNDER[scalar])
    turns = emit("turns", "mul", x, Literal(2 / PI))
    shifted = emit("shifted", "add", turns, rounder)
    k = emit("k", "sub", shifted, rounder)
    r = x
    parts = half_pi_parts(scalar, wide)
    for place, part in enumerate(parts, start=1):
        product = emit(f"k{place}", "mul", k, Literal(part))
        before, r = r, emit(f"r{place}" if place < len(parts) else "r", "sub", r, product)
    z = emit("z", "mul", r, r)
    s = _horner(emit, "s", SINE[scalar], z)
    rz = emit("rz", "mul", r, z)
    bend = emit("sz", "mul", rz, s)
    if scalar == "float32" and wide:
        # The last subtraction rounds away up to an ulp of the result (1.65 in all at one cosine): it is given back.
        missed = emit("missed", "sub", emit("step", "sub", before, r), product)
        bend = emit("bend", "add", bend, missed)
    sine = emit("sin_r", "add", r, bend)
    c = _horner(emit, "c", COSINE[scalar], z)
    zc = emit("zc", "mul", z, c)
    one = Literal(Fraction(1))
    if scalar == "float32":
        # what rounding takes from 1 - z/2 is given back: the absolute error falls from 7.9e-8 to 6.4e-8
        half = emit("half", "mul", z, Literal(Fraction(1, 2)))
        near = emit("near", "sub", one, half)
        lost = emit("lost", "sub", emit("gone", "sub", one, near), half)
        cosine = emit("cos_r", "add", near, emit("rest", "add", lost, emit("zzc", "mul", z, zc)))
    else:
        inner = emit("ci", "sub", zc, Literal(Fraction(1, 2)))
        cosine = emit("cos_r", "add", one, emit("cz", "mul", z, inner))
    # m = k - the nearest multiple of 4, in {-2..2}; keep = cos(m pi/2), turn = sin(m pi/2): everything is exact
    coarse = Literal(4 * ROUNDER[scalar])
    m = emit("m", "sub", k, emit("four", "sub", emit("pushed", "add", k, coarse), coarse))
    emit.statements.append(Statement(("size",), "abs", (m,)))
    keep = emit("keep", "sub", one, Local("size"))
    turn = emit("turn", "mul", m, emit("fade", "sub", Literal(Fraction(2)), Local("size")))
    emit("sine", "add", emit("ss", "mul", keep, sine), emit("sc", "mul", turn, cosine))
    emit("cosine", "sub", emit("cc", "mul", keep, cosine), emit("cs", "mul", turn, sine))
    return Function("sincos", ("x",), tuple(emit.statements), ("sine", "cosine"))


def _horner(emit: _SincosWriter, name: str, coefficients: tuple[float, ...], z: Local) -> Operand:
    value: Operand = Literal(Fraction(coefficients[-1]))
    for place in range(len(coefficients) - 2, -1, -1):
        product = emit(f"{name}{place}p", "mul", z, value)
        value = emit(f"{name}{place}", "add", product, Literal(Fraction(coefficients[place])))
    return value
