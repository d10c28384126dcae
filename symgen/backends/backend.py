"""What a backend is: a folder of this package with three modules, registered by its name in `symgen/registered.py`.

    reserved    WORDS: what names must not be because of the language
    statements  how it spells the statements and checks of the IR, on the walk of `symgen/backends/statements.py`
    backend     BACKEND: what is made of finished kernels, when, and of which scalar types

Nothing else knows of it; its templates lie in the folder of its name in `templates/`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib import import_module
from typing import TypeAlias

from symgen.ir.kernel import Program, Scalar
from symgen.model.model import Model
from symgen.records import dataclass

Emit: TypeAlias = Callable[[Model, Program], dict[str, str]]


@dataclass(frozen=True, slots=True)
class Backend:
    """One language; `language` is what progress calls it.

    Each of `variants` prints some files of a program, by paths under the folder `name`, or none where it has no kernel
    for them.  They are made of the programs of `scalars`, as far as these are asked for, or of the one program there is
    for `None`, in float64.  `verified_as` names the backend whose files are run for its own: another one where the
    same kernels are judged by those.
    """

    name: str
    language: str
    variants: tuple[Emit, ...]
    verified_as: str
    of_each_scalar: bool = True

    def programs(self, programs: Mapping[Scalar, Program], scalars: tuple[Scalar, ...]) -> list[Program]:
        """Those that files are made of."""
        if not self.of_each_scalar:
            return [programs["float64"]]
        return [program for scalar in scalars if (program := programs[scalar]).kernels]


def backend(name: str) -> Backend:
    """The backend of a name."""
    found = import_module(f"symgen.backends.{name}.backend").BACKEND
    assert isinstance(found, Backend)
    return found
