"""Small models built without the model file's front end, so that a fault of one cannot hide one of the other."""

from __future__ import annotations

import ast
from fractions import Fraction

from symgen.model.expressions.expression import Binary, Call, Expression, Name, Negation, Number, Pi, Power
from symgen.model.model import AppliedForce, ConstraintRow, Coordinate, Input, Model, Parameter

OPERATORS = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/"}


def expression(text: str) -> Expression:
    """An expression in the model language, by Python's own parser."""
    return _convert(ast.parse(text, mode="eval").body)


def _convert(node: ast.expr) -> Expression:
    match node:
        case ast.Constant(value):
            return Number(Fraction(str(value)))
        case ast.Name("pi"):
            return Pi()
        case ast.Name(name):
            return Name(name)
        case ast.UnaryOp(ast.USub(), operand):
            return Negation(_convert(operand))
        case ast.BinOp(base, ast.Pow(), ast.Constant(exponent)):
            return Power(_convert(base), Fraction(str(exponent)))
        case ast.BinOp(base, ast.Pow(), ast.UnaryOp(ast.USub(), ast.Constant(exponent))):
            return Power(_convert(base), -Fraction(str(exponent)))
        case ast.BinOp(left, operator, right):
            return Binary(OPERATORS[type(operator)], _convert(left), _convert(right))
        case ast.Call(ast.Name(function), arguments):
            return Call(function, tuple(_convert(a) for a in arguments))
    raise ValueError(ast.dump(node))


def build(
    name: str,
    coordinates: str,
    kinetic: str,
    potential: str = "0",
    parameters: dict[str, str] | None = None,
    geometric: tuple[str, ...] = (),
    nonholonomic: tuple[str, ...] = (),
    inputs: dict[str, dict[str, str]] | None = None,
    applied: dict[str, str] | None = None,
    independent: tuple[str, ...] = (),
    configuration: dict[str, str] | None = None,
    ranges: dict[str, tuple[str, str]] | None = None,
) -> Model:
    """A model from texts; coordinates range over +-3, rates and accelerations over +-1."""
    wide, unit = (Fraction(-3), Fraction(3)), (Fraction(-1), Fraction(1))
    rows = [ConstraintRow(f"g_{i}", "geometric", expression(e)) for i, e in enumerate(geometric)]
    rows += [ConstraintRow(f"a_{i}", "nonholonomic", expression(e)) for i, e in enumerate(nonholonomic)]
    given = ranges or {}
    return Model(
        name=name,
        description="",
        source="",
        coordinates=tuple(Coordinate(c, None, "", True, wide, unit, unit) for c in coordinates.split()),
        parameters=tuple(
            Parameter(
                p, None, "", expression(v), (Fraction(given[p][0]), Fraction(given[p][1])) if p in given else None
            )
            for p, v in (parameters or {}).items()
        ),
        definitions=(),
        kinetic_energy=expression(kinetic),
        potential_energy=expression(potential),
        constraints=tuple(rows),
        inputs=tuple(
            Input(i, None, "", tuple((c, expression(e)) for c, e in column.items()))
            for i, column in (inputs or {}).items()
        ),
        applied_forces=tuple(AppliedForce(c, expression(e)) for c, e in (applied or {}).items()),
        outputs=(),
        independent_velocities=independent,
        configuration=tuple((c, Fraction(v)) for c, v in (configuration or {}).items()),
        constraint_rank_tolerance=None,
        actuation_rank_tolerance=None,
        published=(),
        paths=(),
        report="short",
        notices=(),
        text_hash="0" * 64,
    )


def skate() -> Model:
    """Sec. 5.1: torque T about the vertical, force K along the blade."""
    return build(
        "skate",
        "phi x y",
        "Theta/2*phi_dot**2 + m/2*(x_dot**2 + y_dot**2)",
        parameters={"Theta": "0.8", "m": "2.5"},
        nonholonomic=("sin(phi)*x_dot - cos(phi)*y_dot",),
        inputs={"T": {"phi": "1"}, "K": {"x": "cos(phi)", "y": "sin(phi)"}},
        independent=("phi", "x"),
        ranges={"m": ("2", "3")},
    )


def slider_crank() -> Model:
    """Crank a, coupler angle b, slider x, gravity, viscous friction of the slider; driven at the crank."""
    return build(
        "slider_crank",
        "a b x",
        "J_1/2*a_dot**2 + m_2/2*((l_1*sin(a)*a_dot + l_2/2*sin(b)*b_dot)**2"
        " + (l_1*cos(a)*a_dot + l_2/2*cos(b)*b_dot)**2) + J_2/2*b_dot**2 + m_3/2*x_dot**2",
        "m_2*9.81*(l_1*sin(a) + l_2/2*sin(b))",
        parameters={
            "l_1": "0.3",
            "l_2": "0.8",
            "J_1": "0.02",
            "m_2": "1.5",
            "J_2": "m_2*l_2**2/12",
            "m_3": "2",
            "d": "4",
        },
        geometric=("l_1*cos(a) + l_2*cos(b) - x", "l_1*sin(a) + l_2*sin(b)"),
        inputs={"tau": {"a": "1"}},
        applied={"x": "-d*x_dot"},
        independent=("a",),
        configuration={"a": "0.7", "b": "-0.3", "x": "1"},
    )


def double_pendulum() -> Model:
    """No constraint; one input on two degrees of freedom."""
    return build(
        "double_pendulum",
        "a b",
        "m/2*l**2*a_dot**2 + m/2*l**2*(a_dot**2 + (a_dot + b_dot)**2 + 2*a_dot*(a_dot + b_dot)*cos(b))",
        "-2*m*9.81*l*cos(a) - m*9.81*l*cos(a + b)",
        parameters={"m": "1.5", "l": "0.4"},
        inputs={"tau": {"b": "1"}},
    )


def three_cranks() -> Model:
    """A beam on three parallel cranks: 6 coordinates, 6 constraints of rank 5."""
    loops = []
    for name, offset in (("a", "-c"), ("b", "0"), ("d", "c")):
        loops.append(f"l*cos({name}) + ({offset}) - x - ({offset})*cos(p)")
        loops.append(f"l*sin({name}) - y - ({offset})*sin(p)")
    return build(
        "three_cranks",
        "a b d x y p",
        "J/2*(a_dot**2 + b_dot**2 + d_dot**2) + m/2*(x_dot**2 + y_dot**2) + m*c**2/6*p_dot**2",
        "m*9.81*y",
        parameters={"l": "1", "c": "1.5", "J": "0.1", "m": "3"},
        geometric=tuple(loops),
        inputs={"T_1": {"a": "1"}, "T_2": {"b": "1"}},
        independent=("a",),
        configuration={"a": "0.9", "b": "0.9", "d": "0.9", "x": "0.62", "y": "0.78", "p": "0"},
    )
