"""A process in which constants have other values: they are exchanged where their modules are read.

So every name that takes a constant over has the other value, as do numbers that are computed from it and defaults of
arguments.  Nothing else of symgen is imported before.
"""

from __future__ import annotations

import ast
import json
import sys
from collections.abc import Callable, Mapping, Sequence
from importlib import import_module
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from types import CodeType
from typing import Any

from symgen.laboratory.bench.tuning.tuned import named_number
from symgen.laboratory.bench.tuning.varied import Key, Varied

HALF, DOUBLE = "half", "double"
FACTORS: Mapping[str, Callable[[Any], Any]] = {
    HALF: lambda value: value // 2 if isinstance(value, int) else value / 2,
    DOUBLE: lambda value: value * 2,
}
_EXCHANGE = "_exchanged_constant"
Exchange = Callable[[str, Any], Any]


class _Loader(SourceFileLoader):
    """Reads a module with its constants exchanged, whatever was compiled before."""

    def __init__(self, name: str, path: str, exchange: Exchange) -> None:
        super().__init__(name, path)
        self._exchange = exchange

    def get_code(self, fullname: str) -> CodeType:
        """The module with every constant `X = 3` as `X = exchange("module.X", 3)`."""
        path = self.get_filename(fullname)
        tree = ast.parse(self.get_data(path), path)
        for statement in tree.body:
            if isinstance(statement, ast.Assign) and (named := named_number(statement)):
                name, value = named
                key = ast.Constant(f"{fullname}.{name}")
                exchanged = ast.Call(ast.Name(_EXCHANGE, ast.Load()), [key, value], [])
                statement.value = ast.copy_location(exchanged, value)
        return compile(ast.fix_missing_locations(tree), path, "exec", dont_inherit=True)

    def exec_module(self, module: Any) -> None:
        """Runs it, with the exchange at hand."""
        setattr(module, _EXCHANGE, self._exchange)
        super().exec_module(module)


class _Finder(MetaPathFinder):
    def __init__(self, modules: Sequence[str], exchange: Exchange) -> None:
        self._modules, self._exchange = frozenset(modules), exchange

    def find_spec(self, fullname: str, path: Any, target: Any = None) -> ModuleSpec | None:
        """Modules of the constants that are exchanged; others are found as ever."""
        if fullname not in self._modules or (spec := PathFinder.find_spec(fullname, path, target)) is None:
            return None
        spec.loader = _Loader(fullname, str(spec.origin), self._exchange)
        return spec


def exchange(modules: Sequence[str], by: Exchange) -> None:
    """From now on, constants of these modules become what `by` makes of them."""
    if early := [name for name in modules if name in sys.modules]:
        raise RuntimeError(f"imported too early: {', '.join(early)}")
    sys.meta_path.insert(0, _Finder(modules, by))


def watching(noticed: set[Key]) -> Exchange:
    """Leaves every constant as it is, and notices where half or twice of it would decide otherwise."""

    def by(key: str, value: Any) -> Any:
        return Varied(value, {(key, name): factor(value) for name, factor in FACTORS.items()}, noticed)

    return by


def changing(changed: str, how: str) -> Exchange:
    """Half or twice one constant."""
    return lambda key, value: FACTORS[how](value) if key == changed else value


def main() -> None:
    """What is to be done comes as JSON, and what came of it goes: see `symgen.laboratory.bench.tuning.constants`."""
    task = json.load(sys.stdin)
    noticed: set[Key] = set()
    if modules := task["modules"]:
        exchange(modules, changing(*task["changed"]) if task["changed"] else watching(noticed))
    derived = import_module("symgen.laboratory.bench.tuning.derived")
    json.dump({path: derived.derived(path, most, noticed) for path, most in task["models"].items()}, sys.stdout)


if __name__ == "__main__":
    main()
