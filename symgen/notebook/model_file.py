"""A model file in Python: read, or built word by word, and everything that is made of it."""

from __future__ import annotations

import copy
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from html import escape
from inspect import Parameter, Signature
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from symgen.diagnostics import ModelError
from symgen.model.expressions.names import did_you_mean
from symgen.model.load import DESCRIPTIONS, load_model, load_text
from symgen.model.urdf.looks import named_meshes
from symgen.notebook.language import Block, as_block, as_blocks, as_yaml
from symgen.notebook.words import BlockWord, block_words

if TYPE_CHECKING:
    from symgen.generation.results import Trig
    from symgen.ir.kernel import Scalar
    from symgen.model.model import Model
    from symgen.notebook.compiled import CompiledModel
    from symgen.notebook.motions import SimulatedModel
    from symgen.notebook.quantities import NotebookModel
    from symgen.notebook.results import GeneratedModel

_WORDS = block_words()
Source: TypeAlias = "str | Path | Mapping[str, Any]"


class ModelFile:
    """The blocks of a model file, in the order of the file; `symgen.Model` is its name outside.

    Every word of the language is a method that puts its block, or an entry of it, into the file and returns the model:
    `Model("cart").coordinate("x", unit="m").kinetic_energy("m/2*x_dot**2")`.  An entry of the same name is replaced.
    Values are texts, numbers or SymPy expressions.  Mistakes are told when something is made of the model, all at
    once, with their places in `text`.
    """

    def __init__(self, name: str, blocks: Mapping[str, Any] | None = None) -> None:
        self._blocks: dict[str, Any] = {"model": name}
        self._path: Path | None = None
        self._text: str | None = None
        for block, value in (blocks or {}).items():
            if block != "model":
                self._blocks[block] = as_block(value)

    @classmethod
    def of(cls, text: str, path: Path | None = None) -> ModelFile:
        """The model file with this text, which has been read without mistakes."""
        blocks = as_blocks(text)
        model_file = cls(str(blocks["model"]))
        model_file._blocks, model_file._path, model_file._text = dict(blocks), path, text
        return model_file

    # the words are methods of the class, set below
    def __getattr__(self, word: str) -> Callable[..., ModelFile]:
        remedy = did_you_mean(word, _WORDS, f"its words are {', '.join(_WORDS)}")
        raise AttributeError(f"a model has no {word!r}; {remedy}")

    def _put(self, word: BlockWord, *given: Any, **keywords: Any) -> ModelFile:
        *outer, last = word.block
        place = self._blocks
        for name in outer:
            place = place.setdefault(name, {})
        place[last] = as_block(word.filled(place.get(last), *given, **keywords))
        self._text = None
        return self

    def copy(self) -> ModelFile:
        """Another model with the same blocks, which may be changed."""
        return copy.deepcopy(self)

    @property
    def name(self) -> str:
        """The model's name: that of its files and functions."""
        return str(self._blocks["model"])

    @property
    def blocks(self) -> dict[str, Block]:
        """The blocks of the file by name, in texts."""
        return copy.deepcopy(self._blocks)

    @property
    def text(self) -> str:
        """The model file, as it was read or as it is written; comments are lost with the first change."""
        return as_yaml(self._blocks) if self._text is None else self._text

    def save(self, path: str | Path) -> Path:
        """Writes the model file."""
        Path(path).write_text(self.text, encoding="utf-8")
        return Path(path)

    @property
    def resolved(self) -> Model:
        """The model as the derivation reads it; ModelError with every mistake."""
        with self._file() as path:
            return load_model(path)

    def drawing(self) -> str | None:
        """SVG: the machine where its start leads; None without frames and points."""
        from symgen.drawing.svg import drawing

        return drawing(self.resolved)

    def derive(self) -> NotebookModel:
        """Its quantities as SymPy matrices and CasADi functions; ModelError with every mistake."""
        from symgen.notebook.quantities import NotebookModel

        return NotebookModel(self.resolved)

    def generate(
        self,
        out: str | Path = "generated",
        outputs: Sequence[str] | None = None,
        parts: Sequence[str] | None = None,
        scalars: Sequence[Scalar] = ("float64", "float32"),
        methods: Mapping[str, str] | None = None,
        trig: Trig = "portable",
        verify: bool = True,
    ) -> GeneratedModel:
        """Derives, verifies and writes `out`/<name>/, as the command `symgen` does.

        `outputs` are quantities (default: those of the file), `parts` of c, python, report and so on (default: what the
        command makes), `methods` by quantity.  Raises ModelError for mistakes in the model, WrongUseError for names of
        nothing, RejectedError where verification fails: nothing is written then.
        """
        from symgen.generation.results import PARTS, Options
        from symgen.notebook.results import generated_model

        options = Options(
            outputs=None if outputs is None else tuple(outputs),
            scalars=tuple(scalars),
            parts=PARTS if parts is None else tuple(parts),
            usual=parts is None,
            methods=dict(methods or {}),
            trig=trig,
            verify=verify,
            measured=Path(out),
        )
        with self._file() as path:
            return generated_model(path, Path(out), options)

    def compile(self, outputs: Sequence[str] | None = None, methods: Mapping[str, str] | None = None) -> CompiledModel:
        """Functions of its quantities, for states and arrays of them: verified, compiled C, or else NumPy.

        Raises what `generate` raises.
        """
        from symgen.notebook.compiled import compiled_model

        with self._file() as path:
            return compiled_model(path, outputs, methods or {})

    def simulate(
        self,
        duration: float | None = None,
        frames: int | None = None,
        start: Mapping[str, float] | None = None,
        inputs: Mapping[str, float] | None = None,
    ) -> SimulatedModel:
        """Its motion from a consistent start under constant inputs, by verified kernels, as `symgen simulate` has it.

        `duration` in seconds and `frames` a second; coordinates and rates at the `start` and `inputs` by name.  Raises
        ModelError, WrongUseError for unknown names, NotSimulatedError where there is no motion.
        """
        from symgen.notebook.motions import simulated_model

        with self._file() as path:
            return simulated_model(path, duration, frames, start or {}, inputs or {})

    @contextmanager
    def _file(self) -> Iterator[Path]:
        """The path of a file with this text, and of what lies beside it; mistakes name the file that was read, or the
        model."""
        with tempfile.TemporaryDirectory(prefix="symgen-") as folder:
            path = Path(folder) / "model.yaml"
            path.write_text(self.text, encoding="utf-8")
            self._bring_robot(Path(folder))
            try:
                yield path
            except ModelError as error:
                raise ModelError(str(self._path or self.name), error.text, error.mistakes, error.texts) from None

    def _bring_robot(self, folder: Path) -> None:
        """The robot description and its meshes lie beside the file, as they do beside the one that was read."""
        described = next((block for key in DESCRIPTIONS if (block := self._blocks.get(key))), None)
        named = described.get("file") if isinstance(described, dict) else described
        if not named:
            return
        beside = (self._path.parent if self._path is not None else Path()) / named
        if beside.is_file() and ".." not in Path(named).parts and not Path(named).is_absolute():
            (folder / named).parent.mkdir(parents=True, exist_ok=True)
            (folder / named).write_bytes(beside.read_bytes())
            meshes = named_meshes(beside.read_text(encoding="utf-8", errors="replace"), beside.parent)
            for name, mesh in meshes.items():
                there = (folder / named).parent / name
                there.parent.mkdir(parents=True, exist_ok=True)
                there.write_bytes(mesh.read_bytes())

    def __repr__(self) -> str:
        counts = (f"{len(value)} {block}" for block, value in self._blocks.items() if isinstance(value, dict) and value)
        return f"<model {self.name}: {', '.join(counts)}>"

    def _repr_html_(self) -> str:
        text = f"<pre>{escape(self.text)}</pre>"
        try:
            return f"{self.drawing() or ''}{text}"
        except ModelError as error:  # a model that is being built
            return f"{text}<pre>{escape(str(error))}</pre>"


def _method(word: BlockWord) -> Callable[..., ModelFile]:
    def put(self: ModelFile, *given: Any, **keywords: Any) -> ModelFile:
        return self._put(word, *given, **keywords)

    put.__name__, put.__qualname__, put.__doc__ = word.word, f"{ModelFile.__qualname__}.{word.word}", word.doc
    itself = Parameter("self", Parameter.POSITIONAL_ONLY)
    put.__signature__ = Signature([itself, *word.signature.parameters.values()])  # type: ignore[attr-defined]
    return put


for _block_word in _WORDS.values():
    setattr(ModelFile, _block_word.word, _method(_block_word))


def load(source: Source) -> ModelFile:
    """The model in a file (its path), in a text (with line breaks), or in blocks by name.

    Raises ModelError with every mistake, OSError where there is no such file.
    """
    if isinstance(source, Mapping):
        source = ModelFile(str(source.get("model", "")), source).text
    if isinstance(source, str) and "\n" in source:
        load_text(source, "the model")
        return ModelFile.of(source)
    path = Path(source)
    load_model(path)
    return ModelFile.of(path.read_bytes().decode("utf-8-sig"), path)
