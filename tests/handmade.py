"""Small models and programs written by hand, for tests of the emitters."""

from __future__ import annotations

from fractions import Fraction

from symgen.ir.kernel import (
    Argument,
    Block,
    Check,
    Function,
    Kernel,
    Literal,
    Load,
    Local,
    Operand,
    OperationName,
    Program,
    Scalar,
    Statement,
    Status,
)
from symgen.model.expressions.expression import Binary, Call, Expression, Name, Number, Pi
from symgen.model.model import Coordinate, Input, Model, Parameter


def number(value: str) -> Number:
    return Number(Fraction(value))


def literal(value: str) -> Literal:
    return Literal(Fraction(value))


def op(target: str, operation: OperationName, *operands: str | Literal) -> Statement:
    values: tuple[Operand, ...] = tuple(Local(o) if isinstance(o, str) else o for o in operands)
    return Statement(tuple(target.split()), operation, values)


def coordinate(name: str, unit: str | None = "m", description: str = "") -> Coordinate:
    one = (Fraction(-1), Fraction(1))
    return Coordinate(name, unit, description, False, one, one, one)


def parameter(name: str, value: Expression, unit: str | None = None, description: str = "") -> Parameter:
    return Parameter(name, unit, description, value, None)


def model(
    name: str = "toy",
    coordinates: tuple[Coordinate, ...] = (coordinate("x"), coordinate("theta", "rad", "heading")),
    parameters: tuple[Parameter, ...] | None = None,
    description: str = "A toy",
    source: str = "nowhere",
) -> Model:
    if parameters is None:
        parameters = (
            parameter("L", number("2.6"), "m", "length"),
            parameter("I", Binary("*", Name("L"), number("0.1")), "kg*m^2", "a name that complex.h defines"),
            parameter("half_turn", Pi(), "rad"),
            parameter("root", Call("sqrt", (number("2"),))),
        )
    return Model(
        name=name,
        description=description,
        source=source,
        coordinates=coordinates,
        parameters=parameters,
        definitions=(),
        kinetic_energy=number("0"),
        potential_energy=number("0"),
        constraints=(),
        inputs=(Input("F", "N", "drive", ()),),
        applied_forces=(),
        outputs=(),
        independent_velocities=(),
        configuration=(),
        constraint_rank_tolerance=None,
        actuation_rank_tolerance=None,
        published=(),
        paths=(),
        report="short",
        notices=(),
        text_hash="",
    )


def loads(*arguments: str) -> tuple[Load, ...]:
    """Loads of the toy's x, theta, rates and parameters, by the names of the locals."""
    places = {"x": ("q", 0), "theta": ("q", 1), "x_dot": ("qd", 0), "theta_dot": ("qd", 1)}
    members = {"L": 0, "I": 1, "half_turn": 2, "root": 3}
    return tuple(
        Load(name, places[name][0], places[name][1]) if name in places else Load(name, "p", members[name], name)
        for name in arguments
    )


def inverse_dynamics() -> Kernel:
    """Every kind of statement that has the same bits everywhere, nested checks, an ignored argument."""
    first = Block((op("b_det", "mul", "c", "c"),), (Check(Status.CONSTRAINT_RANK, Local("b_det"), literal("0.01")),))
    size = Block((op("size", "abs", "theta"),), (Check(Status.ANGLE_RANGE, literal("100"), Local("size"), True),))
    work = Block(
        (
            op("s c", "sincos", "theta"),
            op("t1", "mul", "x", "s"),
            op("t2", "sub", "t1", literal("-0.1")),
            op("t3", "ratio_or_zero", "t2", "x"),
            op("t4", "neg", "t3"),
            op("det", "mul", "x", "c"),
            op("det_size", "abs", "det"),
            op("t5", "sqrt", "det_size"),
            op("t6", "copysign", "t5", "x"),
            op("t7", "div", "t4", "t6"),
            op("t8", "add", "t7", "I"),
            op("y1", "mul", "L", literal("1/3")),
        ),
        (Check(Status.ACTUATION_RANK, Local("det_size"), literal("0.001"), False, first),),
    )
    return Kernel(
        "inverse_dynamics",
        (Argument("q", 2), Argument("qd", 2), Argument("qdd", 2)),
        loads("x", "theta", "L", "I", "root"),
        (size, work),
        (Local("t8"), Local("y1")),
        (2,),
    )


def mass_matrix() -> Kernel:
    """Constants, repeated outputs and half a sine/cosine pair; no check."""
    block = Block((op("s c", "sincos", "theta"), op("g12", "mul", "L", "s")), ())
    outputs: tuple[Operand, ...] = (literal("1"), Local("g12"), Local("g12"), literal("-2.5"))
    return Kernel("mass_matrix", (Argument("q", 2),), loads("theta", "L"), (block,), outputs, (2, 2))


def constant() -> Kernel:
    """Nothing is loaded, nothing computed."""
    outputs = (literal("1"), literal("0"), literal("0"), literal("1/3"))
    return Kernel("control_matrix", (Argument("q", 2),), (), (), outputs, (2, 2))


def crude_sincos() -> Function:
    """A short pair of polynomials: enough to see that the program's own function is called."""
    statements = (
        op("x2", "mul", "x", "x"),
        op("a", "mul", "x2", literal("-1/6")),
        op("b", "add", "a", literal("1")),
        op("s", "mul", "x", "b"),
        op("d", "mul", "x2", literal("-1/2")),
        op("c", "add", "d", literal("1")),
    )
    return Function("sincos", ("x",), statements, ("s", "c"))


def program(scalar: Scalar = "float64", own_sincos: bool = True) -> Program:
    sincos = crude_sincos() if own_sincos else None
    return Program(scalar, sincos, (inverse_dynamics(), mass_matrix(), constant()))
