"""What a backend is: a folder of this package with three modules, registered by its name in `symgen/registered.py`.

    reserved    WORDS: what names must not be because of the language
    statements  how it spells the statements and checks of the IR, on the walk of `symgen/backends/statements.py`
    backend     BACKEND: what is made of finished kernels, when, and of which scalar types

Nothing else knows of it; its templates lie in the folder of its name in `templates/`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from importlib import import_module
from typing import TypeAlias

from symgen.backends.scalars import file_stem
from symgen.ir.kernel import Program, Scalar
from symgen.model.model import Model
from symgen.records import dataclass

Emit: TypeAlias = Callable[[Model, Program], dict[str, str]]
Around: TypeAlias = Callable[[Model, Sequence[Program]], dict[str, str]]
Lacks: TypeAlias = Callable[[Model, frozenset[str]], Iterable[str]]


@dataclass(frozen=True, slots=True)
class Variant:
    """What prints some files of a program, or none where it has no kernel for them.

    `ending` stands in their names behind that of the model; the kernels for one state, which come first, have none.
    """

    emit: Emit
    ending: str = ""


@dataclass(frozen=True, slots=True)
class Backend:
    """One language; `language` is what progress calls it.

    Each of `variants` prints a file for each of `extensions`, by `paths`.  They are made of the program of each scalar
    type that is asked for, or of the one in float64 alone.  `verified_as` names the backend whose files are run for its
    own: another one where the same kernels are judged by those.  Files lie in `folder` (empty: that of the name), and
    `stem` is what they are called before the dot.  What is made once of all programs stands `around` them.  `lacks`
    tells from the quantities that are made what these files cannot do without others.
    """

    name: str
    language: str
    variants: tuple[Variant, ...]
    extensions: tuple[str, ...]
    verified_as: str
    of_each_scalar: bool = True
    folder: str = ""
    stem: Callable[[str, Scalar, str], str] = file_stem
    around: Around | None = None
    lacks: Lacks | None = None

    def paths(self, model: Model, scalar: Scalar, ending: str = "") -> tuple[str, ...]:
        """Where the files of a variant are, under the folder of a model, in the order of extensions."""
        stem = self.stem(model.c_name, scalar, ending)
        return tuple(f"{self.folder or self.name}/{stem}{extension}" for extension in self.extensions)

    def programs(self, programs: Mapping[Scalar, Program], scalars: tuple[Scalar, ...]) -> list[Program]:
        """Those that files are made of."""
        if not self.of_each_scalar:
            return [programs["float64"]]
        return [program for scalar in scalars if (program := programs[scalar]).kernels]


def backend(name: str) -> Backend:
    """The backend of a name."""
    loaded = import_module(f"symgen.backends.{name}.backend").BACKEND
    assert isinstance(loaded, Backend)
    return loaded
