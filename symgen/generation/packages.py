"""Packages that only some work needs: which of them are there, and what installs the others.

The way from model to verified C and Python needs none of them.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from importlib.util import find_spec

from symgen.diagnostics import Notice
from symgen.generation.results import Options, WrongUseError
from symgen.model.model import Model

# The extra of symgen that brings each.
EXTRA_OF = {
    "sympy": "report",
    "typst": "report",
    "matplotlib": "report",
    "casadi": "casadi",
    "scipy": "simulate",
    "dask": "study",
    "distributed": "study",
    "xarray": "study",
    "zarr": "study",
}
# What the report needs, and charts along `paths` beside it.
_OF_THE_REPORT, _OF_CHARTS = ("sympy", "typst"), ("casadi", "scipy", "matplotlib")


def without_report(model: Model, options: Options) -> tuple[Options, tuple[Notice, ...]]:
    """The options without a report that lacks packages, and what is told of it; WrongUseError where it is asked for."""
    needed = (*_OF_THE_REPORT, *(_OF_CHARTS if model.paths else ()))
    if "report" not in options.parts or not (lacks := [one for one in needed if find_spec(one) is None]):
        return options, ()
    if not options.usual:
        raise WrongUseError(to_install(lacks, "the report"))
    parts = tuple(part for part in options.parts if part != "report")
    return replace(options, parts=parts), (Notice(f"the report is left out: {to_install(lacks, 'it')}"),)


def to_install(modules: Iterable[str], purpose: str) -> str:
    """That something needs packages which are not installed, and the command that installs them."""
    *others, last = modules
    extras = ",".join(sorted({EXTRA_OF[name] for name in (*others, last)}))
    names, verb = (f"{', '.join(others)} and {last}", "are") if others else (last, "is")
    return f"{purpose} needs {names}, which {verb} not installed: pip install 'symgen[{extras}]'"
