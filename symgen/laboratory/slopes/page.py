"""The page docs/stress/derivatives.md and its chart, from errors of derivatives along families of states."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from symgen.ir.kernel import UNIT_ROUNDOFF
from symgen.laboratory.slopes.errors import DerivativeErrors
from symgen.laboratory.stress.reporting.axes import logarithmic, power
from symgen.laboratory.stress.reporting.charts import DECIMALS, LOOKS, NOTHING
from symgen.laboratory.stress.series import SYMGEN
from symgen.paths.drawing import svg

SHOWN = (1.0, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12)
HEAD = """# Derivatives where choices fail

Written by `make stress-derivatives` for {model}. Towards each parameter singularity (d from 1 to 1e-12, see
[numerical stability](README.md)) the derivatives of u by q, q̇ and q̈ of the generated kernel are held against 50 digits,
beside those of the paper's formulas with the choice that fails there: (9) with fixed coordinates and (28) with fixed
inputs, differentiated by CasADi in double precision. Off the constraints each of them is another function of q, q̇ and
q̈. Along changes that constraints allow, X, they have the same derivatives; the errors are those of J X, relative to it,
the largest of two states.

![Relative error of J X against the distance d, towards {label} = 0.](derivatives.svg)

*Towards {label} = 0. No results are drawn at the top.*
"""


def derivatives_page(model: str, results: Mapping[str, Sequence[DerivativeErrors]]) -> tuple[str, str]:
    """The Markdown text, and the chart (SVG) of the family where symgen is nearest to rounding."""
    shown = min(results, key=lambda label: max(e for _, e in _of(results[label], SYMGEN).errors))
    lines = [HEAD.format(model=model, label=shown)]
    lines += ["|  |  |" + "".join(f" d = 10{power(d) if d < 1 else '⁰'} |" for d in SHOWN)]
    lines += ["| --- | --- |" + " --- |" * len(SHOWN)]
    for label, methods in results.items():
        for one in methods:
            cells = (f"{_at(one, d):.0e}".replace("inf", "none") for d in SHOWN)
            lines.append(f"| {label} = 0 | {one.method} | {' | '.join(cells)} |")
    return "\n".join(lines) + "\n", _chart(shown, results[shown])


def _of(methods: Sequence[DerivativeErrors], name: str) -> DerivativeErrors:
    return next(one for one in methods if one.method == name)


def _at(one: DerivativeErrors, distance: float) -> float:
    return min(one.errors, key=lambda error: abs(math.log(error[0] / distance)))[1]


def _chart(label: str, methods: Sequence[DerivativeErrors]) -> str:
    eps = float(UNIT_ROUNDOFF["float64"])

    def draw(figure: Any) -> None:
        panel = figure.subplots()
        for one in methods:
            colour, line, marker = LOOKS[one.method]
            heights = [min(error, 1e9 * NOTHING) for _, error in one.errors]
            panel.plot(
                [d for d, _ in one.errors], heights, label=one.method, color=colour, linestyle=line, marker=marker,
                markersize=2.6, linewidth=1.2,
            )  # fmt: skip
        panel.axhline(eps, color="#888888", linewidth=0.7, linestyle=(0, (2, 2)), zorder=0)
        logarithmic(panel.xaxis)
        logarithmic(panel.yaxis)
        panel.invert_xaxis()
        panel.set_title(f"towards {label} = 0, float64", fontsize=9, loc="left")
        panel.set_ylabel("relative error of J X")
        panel.set_xlabel("distance d from the singularity")
        panel.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), borderaxespad=0)

    return DECIMALS.sub(r"\1", svg(draw, height=3.2))
