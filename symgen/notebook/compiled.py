"""The quantities of a model as functions: verified, compiled, called from Python."""

from __future__ import annotations

import importlib.util
import tempfile
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path, PurePosixPath
from typing import Any

from symgen.generation.results import Options
from symgen.notebook.results import made

_PARTS = ("c", "python")


class CompiledModel:
    """The functions of the generated module, in C where there is a compiler, and its `Parameters`, `StateError`, ...

    `car.inverse_dynamics(q, qd, qdd)` takes arrays with any leading axes; `p=car.Parameters(m=3)` other parameters.
    A single state without result raises StateError; in an array of states it is NaN.
    """

    def __init__(self, name: str, quantities: Sequence[str], module: Any, functions: Any) -> None:
        self._name, self._module, self._functions = name, module, functions
        self.quantities = tuple(quantities)

    def __getattr__(self, name: str) -> Callable[..., Any]:
        if name.startswith("_"):
            raise AttributeError(name)
        for place in (self._functions, self._module):
            if (function := getattr(place, name, None)) is not None:
                made_of: Callable[..., Any] = function
                return made_of
        raise AttributeError(f"{self._name} was compiled with {', '.join(self.quantities)}, without {name}")

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *self.quantities, "Parameters", "PARAMETERS", "Status", "StateError"})

    def __repr__(self) -> str:
        import inspect

        arguments = {name: inspect.signature(getattr(self._module, name)).parameters for name in self.quantities}
        lines = [f"{name}({', '.join(given)}=PARAMETERS)" for name, given in arguments.items()]
        return "\n  ".join([f"{self._name}, compiled:", *lines])


def compiled_model(path: Path, outputs: Sequence[str] | None, methods: Mapping[str, str]) -> CompiledModel:
    """Makes and verifies the C in float64 and the Python of a model, builds and loads them."""
    wanted = None if outputs is None else tuple(outputs)
    result = made(path, Options(outputs=wanted, scalars=("float64",), parts=_PARTS, methods=dict(methods)))
    name = result.model.name
    with tempfile.TemporaryDirectory(prefix="symgen-") as folder:
        for file, content in result.files.items():
            target = Path(folder) / PurePosixPath(file)
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(content.encode() if isinstance(content, str) else content)
        (module_path,) = (Path(folder) / "python").glob("*.py")
        spec = importlib.util.spec_from_file_location(module_path.stem, module_path)
        assert spec is not None
        assert spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        functions = module.compile()
    return CompiledModel(name, [quantity for quantity, _ in result.summary.operations], module, functions)
