"""symgen: verified, globally valid inverse dynamics of constrained mechanical systems.

`symgen.derive("model.yaml")` gives a model's quantities as SymPy matrices and CasADi functions, for notebooks.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from symgen.notebook import derive

__all__ = ["__version__", "derive"]
__version__ = "0.1.0"


def __getattr__(name: str) -> Any:
    # importing symgen must stay cheap: the command line never needs SymPy and CasADi for C alone
    if name == "derive":
        return import_module("symgen.notebook").derive
    raise AttributeError(f"module 'symgen' has no attribute {name!r}")
