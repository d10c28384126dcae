"""SymForce: its C++ statements after its own common subexpressions, read as C."""

from __future__ import annotations

import re
from collections.abc import Sequence
from fractions import Fraction
from typing import Any, ClassVar

import symforce.symbolic as sf
from symforce.codegen import CppConfig, codegen_util
from symforce.values import Values

from symgen.laboratory.bench.peers.engines.engine import Engine, Inputs, Symbol

ARRAY_ENTRY = re.compile(r"\b(qdd|qd|q|u|p)_(\d+)\b")
SQUARE = re.compile(r"std::pow\((\w+), Scalar\(2\)\)")
_tool: Any = codegen_util


class SymforceEngine(Engine):
    """Scalars are SymEngine's, as SymForce hands them out."""

    tool: ClassVar[str] = "SymForce"

    def symbols(self, array: str, length: int) -> list[Symbol]:
        """One symbol an entry, named array_index."""
        return [sf.Symbol(f"{array}_{i}") for i in range(length)]

    def number(self, value: Fraction) -> Symbol:
        """An exact rational."""
        return sf.Rational(value.numerator, value.denominator)

    def pi(self) -> Symbol:
        """SymForce's exact π."""
        return sf.pi

    def power(self, base: Symbol, exponent: Fraction) -> Symbol:
        """base ** exponent, exact."""
        return base ** self.number(exponent)

    def call(self, function: str, arguments: Sequence[Symbol]) -> Symbol:
        """The function of SymForce with that name."""
        return getattr(sf, function)(*arguments)

    def derivative(self, value: Symbol, by: Symbol) -> Symbol:
        """∂value/∂by by SymEngine."""
        return value.diff(by)

    def is_zero(self, value: Symbol) -> bool:
        """Whether the value is the constant 0 as it stands."""
        return bool(value == 0)

    def name(self, value: Symbol) -> Symbol:
        """The value itself: SymForce finds what is common by itself."""
        return value

    def c_function(self, name: str, inputs: Inputs, outputs: Sequence[Symbol]) -> tuple[str, tuple[str, ...], bool]:
        """The statements of SymForce's C++ as the body of a C function of pointers."""
        third = "qdd" if "qdd" in inputs else "u"
        given = Values(**{str(symbol): symbol for symbols in inputs.values() for symbol in symbols})
        wanted = Values(**{f"y_{k}": output for k, output in enumerate(outputs)})
        code = _tool.print_code(
            inputs=given, outputs=wanted, sparse_mat_data={}, config=CppConfig(zero_initialization_sparsity_threshold=1)
        )
        named = [(str(symbol), term) for symbol, term in code.intermediate_terms]
        named += [(part, term) for output in code.dense_terms for part, term in output.terms]
        lines = [f"const REAL {symbol} = {_c(term)};" for symbol, term in named]
        lines += [*(f"y[{k}] = y_{k};" for k in range(len(outputs))), "return 0;"]
        head = f"int {name}(const REAL *q, const REAL *qd, const REAL *{third}, const REAL *p, REAL *y)"
        body = [f"    {line}" for line in lines]
        return "\n".join(["#include <math.h>", f"{head};", head, "{", *body, "}", ""]), (name,), False


def _c(term: str) -> str:
    """C from SymForce's C++; squares as the products that a C++ compiler makes of them."""
    term = SQUARE.sub(r"(\1 * \1)", term).replace("std::", "").replace("Scalar(", "(REAL)(")
    return ARRAY_ENTRY.sub(r"\1[\2]", term)
