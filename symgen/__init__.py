"""symgen: verified, globally valid inverse dynamics of constrained mechanical systems.

`symgen.load("model.yaml")` reads a model, `symgen.Model("cart")` begins one; `.derive()`, `.generate()`, `.compile()`
and `.simulate()` make of it what the command does.  docs/python.md has examples.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from symgen.diagnostics import ModelError
    from symgen.generation.results import WrongUseError
    from symgen.notebook.model_file import ModelFile as Model
    from symgen.notebook.model_file import load
    from symgen.notebook.quantities import derive
    from symgen.notebook.results import RejectedError
    from symgen.simulate.simulation import NotSimulatedError

__all__ = [
    "Model",
    "ModelError",
    "NotSimulatedError",
    "RejectedError",
    "WrongUseError",
    "__version__",
    "derive",
    "load",
]
__version__ = "0.1.0"
# Where they are: importing symgen must stay cheap, and the command line never needs SymPy and CasADi for C alone.
_PLACES = {
    "Model": ("notebook.model_file", "ModelFile"),
    "ModelError": ("diagnostics", "ModelError"),
    "NotSimulatedError": ("simulate.simulation", "NotSimulatedError"),
    "RejectedError": ("notebook.results", "RejectedError"),
    "WrongUseError": ("generation.results", "WrongUseError"),
    "derive": ("notebook.quantities", "derive"),
    "load": ("notebook.model_file", "load"),
}


def __getattr__(name: str) -> Any:
    if name in _PLACES:
        module, there = _PLACES[name]
        return getattr(import_module(f"symgen.{module}"), there)
    raise AttributeError(f"module 'symgen' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
