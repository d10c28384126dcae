"""Packages that only some work needs: which of them are there, and what installs the others.

The way from model to verified C and Python needs none of them.
"""

from __future__ import annotations

from collections.abc import Iterable
from importlib.util import find_spec

from symgen.model.model import Model

# The extra of symgen that brings each.
EXTRA_OF = {
    "sympy": "report",
    "typst": "report",
    "matplotlib": "report",
    "casadi": "casadi",
    "scipy": "simulate",
}
_OF_THE_REPORT, _OF_CHARTS = ("sympy", "typst"), ("casadi", "scipy", "matplotlib")


def lacking(modules: Iterable[str]) -> tuple[str, ...]:
    """Those that are not installed."""
    return tuple(module for module in modules if find_spec(module) is None)


def lacking_for_report(model: Model) -> tuple[str, ...]:
    """What the report of a model needs and is not installed; charts along `paths` need more."""
    return lacking((*_OF_THE_REPORT, *(_OF_CHARTS if model.paths else ())))


def to_install(modules: Iterable[str], purpose: str) -> str:
    """That something needs packages which are not installed, and the command that installs them."""
    *others, last = modules
    extras = ",".join(sorted({EXTRA_OF[name] for name in (*others, last)}))
    names, verb = (f"{', '.join(others)} and {last}", "are") if others else (last, "is")
    return f"{purpose} needs {names}, which {verb} not installed: pip install 'symgen[{extras}]'"
