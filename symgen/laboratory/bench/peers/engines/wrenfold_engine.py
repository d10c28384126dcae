"""wrenfold: its C++ is straight-line scalar code, which is read as C."""

from __future__ import annotations

import re
from collections.abc import Sequence
from fractions import Fraction
from typing import Any, ClassVar

from wrenfold import code_generation, enumerations, sym, type_info

from symgen.laboratory.bench.peers.engines.engine import Engine, Inputs, Symbol

REAL = enumerations.NumberSet.Real
_tool: Any = code_generation


class WrenfoldEngine(Engine):
    """Scalars are wrenfold expressions; it shares what is equal by itself."""

    tool: ClassVar[str] = "wrenfold"

    def symbols(self, array: str, length: int) -> list[Symbol]:
        """One real symbol an entry, named array_index."""
        return [sym.symbol(f"{array}_{i}", REAL) for i in range(length)]

    def number(self, value: Fraction) -> Symbol:
        """An exact rational."""
        return sym.rational(value.numerator, value.denominator)

    def pi(self) -> Symbol:
        """wrenfold's exact π."""
        return sym.pi

    def power(self, base: Symbol, exponent: Fraction) -> Symbol:
        """base ** exponent, exact."""
        return sym.pow(base, self.number(exponent))

    def call(self, function: str, arguments: Sequence[Symbol]) -> Symbol:
        """The function of wrenfold with that name."""
        return getattr(sym, function)(*arguments)

    def derivative(self, value: Symbol, by: Symbol) -> Symbol:
        """∂value/∂by by wrenfold."""
        return value.diff(by)

    def is_zero(self, value: Symbol) -> bool:
        """Whether the value is identical to the constant 0."""
        return bool(value.is_identical_to(sym.zero))

    def name(self, value: Symbol) -> Symbol:
        """The value itself: wrenfold shares it without a name."""
        return value

    def c_function(self, name: str, inputs: Inputs, outputs: Sequence[Symbol]) -> tuple[str, tuple[str, ...], bool]:
        """The statements of wrenfold's C++ as the body of a C function of pointers."""
        third = "qdd" if "qdd" in inputs else "u"
        text = _generated(name, inputs, outputs)
        body = text[text.index("{") + 1 : text.rindex("}")]
        body = body.replace("static_cast<Scalar>", "(REAL)").replace("std::", "").replace("Scalar", "REAL")
        body = body.replace("M_PI", "3.14159265358979323846")
        body = re.sub(r"\b(qdd|qd|q|u|p)_(\d+)\b", r"\1[\2]", re.sub(r"//.*", "", body))
        lines = [line.strip() for line in body.splitlines() if line.strip()]
        stores = [line for line in lines if re.match(r"y_\d+ =", line)]
        others = [line for line in lines if line not in stores]
        held = [f"const REAL {line}" for line in stores]
        written = [f"y[{k}] = y_{k};" for k in range(len(outputs))]
        head = f"int {name}(const REAL *q, const REAL *qd, const REAL *{third}, const REAL *p, REAL *y)"
        indented = [f"    {line}" for line in (*others, *held, *written, "return 0;")]
        return "\n".join(["#include <math.h>", f"{head};", head, "{", *indented, "}", ""]), (name,), False


def _generated(name: str, inputs: Inputs, outputs: Sequence[Any]) -> str:
    description = _tool.FunctionDescription(name)
    placeholders = []
    for array, symbols in inputs.items():
        for k, symbol in enumerate(symbols):
            kind = type_info.ScalarType(type_info.NumericType.Float)
            placeholders.append((symbol, description.add_input_argument(f"{array}_{k}", kind)))
    for k, output in enumerate(outputs):
        description.add_output_argument(f"y_{k}", False, sym.subs(output, placeholders))
    return str(_tool.CppGenerator().generate(_tool.transpile(description)))
