"""What code is made of: the modules of this repository that it imports, directly or through others."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Sequence
from functools import cache
from pathlib import Path

# Where modules are looked for, beside the folder of the file that imports them.
ROOTS = ("", "tools", "tests")


def imported(root: Path, paths: Iterable[str], outside: Sequence[str] = ()) -> tuple[str, ...]:
    """The Python files below the paths and all that they import, without those below `outside`, relative to the root.

    What is imported for type checking alone does not count, nor does what is loaded by a name made at run time.
    """
    reached: set[Path] = set()
    waiting = [file for path in paths for file in _python(root / path)]
    barred = [root / path for path in outside]
    while waiting:
        file = waiting.pop()
        if file in reached or any(file.is_relative_to(path) for path in barred):
            continue
        reached.add(file)
        waiting += (source for name in _names(file.read_bytes()) for source in _files(root, file.parent, name))
    return tuple(sorted(file.relative_to(root).as_posix() for file in reached))


def _python(path: Path) -> list[Path]:
    return [path] if path.suffix == ".py" else sorted(path.rglob("*.py"))


@cache
def _names(source: bytes) -> tuple[str, ...]:
    """What a file imports: modules, and names in modules, which may be modules as well."""
    return tuple(dict.fromkeys(_imports(ast.parse(source))))


def _imports(node: ast.AST) -> Iterator[str]:
    match node:
        case ast.Import(names=names):
            yield from (one.name for one in names)
        case ast.ImportFrom(module=str(module), names=names, level=0):
            yield module
            yield from (f"{module}.{one.name}" for one in names)
        case ast.If(test=ast.Name(id="TYPE_CHECKING"), orelse=otherwise):
            for other in otherwise:
                yield from _imports(other)
        case _:
            for inner in ast.iter_child_nodes(node):
                yield from _imports(inner)


def _files(root: Path, beside: Path, name: str) -> Iterator[Path]:
    """The file of a module, and those of the packages it lies in, which an import runs as well."""
    for folder in (beside, *(root / place for place in ROOTS)):
        parts = name.split(".")
        module = folder.joinpath(*parts)
        file = module.with_suffix(".py") if module.with_suffix(".py").is_file() else module / "__init__.py"
        if file.is_file():
            packages = (folder.joinpath(*parts[:k], "__init__.py") for k in range(1, len(parts)))
            yield from (file, *filter(Path.is_file, packages))
            return
