"""What of a model's files is compiled and imported to be run."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import PurePosixPath

from symgen.backends.backend import backend
from symgen.backends.scalars import SUFFIX
from symgen.ir.kernel import Scalar
from symgen.model.model import Model
from symgen.verify.running.compile import CSource


def generated_sources(model: Model, files: Mapping[str, str | bytes]) -> tuple[dict[Scalar, CSource], str | None]:
    """C sources by scalar type, and the Python source, among the files of a model (paths relative to its folder)."""
    texts = {path: content if isinstance(content, str) else content.decode() for path, content in files.items()}
    made = backend("c")
    c_sources = {}
    for scalar in SUFFIX:
        plain, *others = (made.paths(model, scalar, variant.ending) for variant in made.variants)
        if all(path in texts for path in plain):
            header, source = (texts[path] for path in plain)
            companions = ((_name(path), texts[path]) for paths in others for path in paths if path in texts)
            c_sources[scalar] = CSource(PurePosixPath(plain[0]).stem, header, source, tuple(companions))
    (module,) = backend("python").paths(model, "float64")
    return c_sources, texts.get(module)


def _name(path: str) -> str:
    return PurePosixPath(path).name
