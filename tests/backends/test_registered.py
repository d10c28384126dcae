"""Every registered backend is a folder with the modules of the protocol, and model files keep off its keywords."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path

import handmade
import pytest

import symgen.backends
from symgen.backends.backend import Backend, backend
from symgen.backends.statements import Statements
from symgen.cli.arguments import parts
from symgen.diagnostics import ModelError
from symgen.model.expressions.names import RESERVED
from symgen.model.load import load_model
from symgen.naming import c_name
from symgen.registered import BACKENDS, USUAL, words_of

FOLDER = Path(symgen.backends.__file__).parent
MODULES = ("backend", "reserved", "statements")
KEYWORDS = sorted({word for name in BACKENDS for word in words_of(name).keywords})


def is_printer(one: object) -> bool:
    return isinstance(one, type) and issubclass(one, Statements) and one is not Statements


def test_every_folder_is_registered_and_every_backend_has_its_folder() -> None:
    assert {path.name for path in FOLDER.iterdir() if (path / "__init__.py").exists()} == set(BACKENDS)
    assert set(USUAL) <= set(BACKENDS)
    assert len(set(BACKENDS)) == len(BACKENDS)


@pytest.mark.parametrize("name", BACKENDS)
def test_has_the_modules_of_the_protocol(name: str) -> None:
    modules = {module: import_module(f"symgen.backends.{name}.{module}") for module in MODULES}
    made = backend(name)
    assert isinstance(made, Backend)
    assert (made.name, made.verified_as in USUAL) == (name, True)
    (printer,) = (one for one in vars(modules["statements"]).values() if is_printer(one))
    # how it spells each kind of statement is its own, the walk over them is not
    assert not printer.__abstractmethods__
    assert not {"operand", "statement", "expression"} & set(vars(printer))


@pytest.mark.parametrize("name", BACKENDS)
def test_prints_its_files_into_its_folder_and_can_be_asked_for(name: str) -> None:
    made = backend(name)
    model, program = handmade.model(), handmade.program()
    texts = {variant.ending: variant.emit(model, program) for variant in made.variants}
    assert len(texts) == len(made.variants)
    assert texts[""]
    assert all(path.startswith(f"{name}/") for files in texts.values() for path in files)
    for ending, files in texts.items():
        assert not files or tuple(files) == made.paths(model, program.scalar, ending)
    beside = {} if made.around is None else made.around(model, [program])
    assert all(path.startswith(f"{name}/") for path in beside)
    assert not beside.keys() & {path for files in texts.values() for path in files}
    assert parts(name) == (name,)


@pytest.mark.parametrize("word", KEYWORDS)
def test_keywords_are_refused_in_model_files(word: str, tmp_path: Path) -> None:
    path = tmp_path / "model.yaml"
    path.write_text(
        f'model: one\ncoordinates: {{x: {{}}}}\nparameters: {{"{word}": 2}}\nkinetic_energy: x_dot**2\n'
        "inputs: {u_1: {acts_on: {x: 1}}}\n"
    )
    with pytest.raises(ModelError) as refused:
        load_model(path)
    (mistake,) = refused.value.mistakes
    # told by another language where that has the word as well
    assert mistake.message == f"`{word}` is reserved: {RESERVED[word]}"


@pytest.mark.parametrize("name", BACKENDS)
def test_files_hide_nothing_of_its_language(name: str) -> None:
    assert all(c_name(word) == f"{word}_model" for word in words_of(name).hiding)
    assert all(c_name(f"Rob_{word.upper()}") == f"Rob_{word.upper()}_model" for word in words_of(name).endings)
