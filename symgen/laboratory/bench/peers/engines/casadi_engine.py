"""CasADi: scalars of `SX`, C by its own code generator."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import pi
from typing import Any, ClassVar

import casadi

from symgen.laboratory.bench.peers.engines.engine import Engine, Inputs, Symbol
from symgen.witness.translate import power


class CasadiEngine(Engine):
    """Scalars are 1×1 SX; intermediates need no names, because SX shares what is equal."""

    tool: ClassVar[str] = "CasADi"

    def __init__(self) -> None:
        self._arrays: dict[str, Any] = {}

    def symbols(self, array: str, length: int) -> list[Symbol]:
        """The entries of one SX column, which `c_function` takes as it is."""
        self._arrays[array] = casadi.SX.sym(array, length)
        return [self._arrays[array][i] for i in range(length)]

    def number(self, value: Fraction) -> Symbol:
        """A constant of SX, rounded to a float64."""
        return casadi.SX(float(value))

    def pi(self) -> Symbol:
        """The number π as a constant."""
        return casadi.SX(pi)

    def power(self, base: Symbol, exponent: Fraction) -> Symbol:
        """base ** exponent; half-integer ones by the square root."""
        return power(base, exponent)

    def call(self, function: str, arguments: Sequence[Symbol]) -> Symbol:
        """The function of CasADi with that name."""
        return getattr(casadi, function)(*arguments)

    def derivative(self, value: Symbol, by: Symbol) -> Symbol:
        """∂value/∂by, dense."""
        return casadi.densify(casadi.jacobian(value, by))

    def gradient(self, value: Symbol, by: Sequence[Symbol]) -> list[Symbol]:
        """All derivatives at once, by CasADi's reverse mode."""
        entries = casadi.densify(casadi.gradient(value, casadi.vertcat(*by)))
        return [entries[i] for i in range(len(by))]

    def rates(self, values: Sequence[Symbol], by: Sequence[Symbol], direction: Sequence[Symbol]) -> list[Symbol]:
        """All derivatives along the direction at once, by CasADi's forward mode."""
        column = casadi.vertcat(*values)
        entries = casadi.densify(casadi.jtimes(column, casadi.vertcat(*by), casadi.vertcat(*direction)))
        return [entries[i] for i in range(len(values))]

    def is_zero(self, value: Symbol) -> bool:
        """Whether SX knows the value as 0."""
        return bool(value.is_zero())

    def name(self, value: Symbol) -> Symbol:
        """The value itself: SX shares it without a name."""
        return value

    def c_function(self, name: str, inputs: Inputs, outputs: Sequence[Symbol]) -> tuple[str, tuple[str, ...], bool]:
        """C of CasADi's code generator, called by its arg/res arrays."""
        third = "qdd" if "qdd" in inputs else "u"
        arrays = [self._arrays[array] for array in ("q", "qd", third, "p")]
        source, functions = generated(name, arrays, casadi.vertcat(*outputs))
        return source, functions, True


def generated(name: str, arrays: Sequence[Any], value: Any) -> tuple[str, tuple[str, ...]]:
    """C of `value` (after `cse`) with CasADi's calling convention, and the functions that run in a call."""
    function = casadi.Function(name, list(arrays), [casadi.cse(casadi.densify(value))])
    generator = casadi.CodeGenerator(f"{name}_file", {"with_header": False})
    generator.add(function)
    # the name of the file stands before all of them: f0 does the work, and is a function of its own where it is long
    helpers = (f"{name}_file_{helper}" for helper in ("f0", "sq", "sign", "fmin", "fmax"))
    return generator.dump(), (name, *helpers)


def array_adaptor(entry: str, name: str) -> str:
    """C that gives a CasADi function the signature of all kernels."""
    arrays = "const REAL *q, const REAL *qd, const REAL *x, const REAL *p, REAL *y"
    return (
        f"int {name}(const REAL **, REAL **, long long *, REAL *, int);\n"
        f"int {entry}({arrays});\n"
        f"int {entry}({arrays})\n"
        "{\n"
        "    const REAL *arguments[4] = {q, qd, x, p};\n"
        "    REAL *results[1] = {y};\n"
        f"    return {name}(arguments, results, 0, 0, 0);\n"
        "}\n"
    )
