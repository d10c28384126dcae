"""SymPy: `diff`, `cse` over all named intermediates at once, `ccode`."""

from __future__ import annotations

import re
from collections.abc import Sequence
from fractions import Fraction
from typing import Any, ClassVar

import sympy
from sympy.printing.c import C99CodePrinter

from symgen.laboratory.bench.peers.engines.engine import Engine, Inputs, Symbol

LARGEST_PRODUCT = 8
ARRAY_ENTRY = re.compile(r"\b(qdd|qd|q|u|p)_(\d+)\b")


class SympyEngine(Engine):
    """Scalars are SymPy expressions; what `name` is told becomes a symbol of its own."""

    tool: ClassVar[str] = "SymPy"

    def __init__(self) -> None:
        self._named: list[tuple[Any, Any]] = []

    def symbols(self, array: str, length: int) -> list[Symbol]:
        """One real symbol an entry, named array_index."""
        return [sympy.Symbol(f"{array}_{i}", real=True) for i in range(length)]

    def number(self, value: Fraction) -> Symbol:
        """An exact rational."""
        return sympy.Rational(value.numerator, value.denominator)

    def pi(self) -> Symbol:
        """SymPy's exact π."""
        return sympy.pi

    def power(self, base: Symbol, exponent: Fraction) -> Symbol:
        """base ** exponent, exact."""
        return base ** self.number(exponent)

    def call(self, function: str, arguments: Sequence[Symbol]) -> Symbol:
        """The function of SymPy with that name."""
        return getattr(sympy, function)(*arguments)

    def derivative(self, value: Symbol, by: Symbol) -> Symbol:
        """∂value/∂by; what was named before counts as constant."""
        return sympy.diff(value, by)

    def is_zero(self, value: Symbol) -> bool:
        """Whether the value is the constant 0 as it stands."""
        return bool(value == 0)

    def name(self, value: Symbol) -> Symbol:
        """A symbol for the value, unless it is one already up to its sign."""
        if value.is_Atom or (-value).is_Atom:
            return value
        symbol = sympy.Symbol(f"n_{len(self._named)}", real=True)
        self._named.append((symbol, value))
        return symbol

    def c_function(self, name: str, inputs: Inputs, outputs: Sequence[Symbol]) -> tuple[str, tuple[str, ...], bool]:
        """C after one `cse` over the named values and the outputs, as a function of pointers."""
        third = "qdd" if "qdd" in inputs else "u"
        symbols = [symbol for symbol, _ in self._named]
        values = [*(value for _, value in self._named), *outputs]
        shared, reduced = sympy.cse(values, symbols=sympy.numbered_symbols("s_", real=True))
        definitions = dict(shared) | dict(zip(symbols, reduced, strict=False))
        results = reduced[len(symbols) :]
        printer = _Printer()
        lines = [
            f"    const REAL {symbol} = {_c(printer, definitions[symbol])};" for symbol in _order(definitions, results)
        ]
        lines += [f"    const REAL y_{k} = {_c(printer, result)};" for k, result in enumerate(results)]
        lines += [f"    y[{k}] = y_{k};" for k in range(len(results))]
        head = f"int {name}(const REAL *q, const REAL *qd, const REAL *{third}, const REAL *p, REAL *y)"
        source = "\n".join(["#include <math.h>", f"{head};", head, "{", *lines, "    return 0;", "}", ""])
        return source, (name,), False


class _Printer(C99CodePrinter):  # type: ignore[misc]  # SymPy has no types
    """Small integer powers as products: `pow` would be a call in every kernel."""

    def _print_Pi(self, _: Any) -> str:
        return "3.14159265358979323846"

    def _print_Pow(self, expr: Any) -> str:
        base, exponent = expr.base, expr.exp
        if exponent.is_Integer and 2 <= abs(exponent) <= LARGEST_PRODUCT:
            factor = f"({self._print(base)})"
            power = "*".join([factor] * abs(int(exponent)))
            return f"({power})" if exponent > 0 else f"(1.0/({power}))"
        return str(super()._print_Pow(expr))


def _c(printer: C99CodePrinter, value: Any) -> str:
    return ARRAY_ENTRY.sub(r"\1[\2]", printer.doprint(value))


def _order(definitions: dict[Any, Any], results: Sequence[Any]) -> list[Any]:
    """The symbols the results need, each after those its definition needs."""
    order: dict[Any, None] = {}

    def visit(symbol: Any) -> None:
        if symbol in definitions and symbol not in order:
            for needed in sorted(definitions[symbol].free_symbols, key=str):
                visit(needed)
            order[symbol] = None

    for result in results:
        for symbol in sorted(result.free_symbols, key=str):
            visit(symbol)
    return list(order)
