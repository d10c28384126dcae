"""The generated Python loads any way that Python has: by file, by text, from an archive, under another name."""

from __future__ import annotations

import importlib.util
import os
import pickle
import runpy
import subprocess
import sys
import zipfile
import zipimport
from collections.abc import Callable, Mapping
from pathlib import Path
from types import ModuleType
from typing import Any

import handmade
import pytest
from generated_python import load_generated

from symgen.backends.c.batch import emit_c_batch
from symgen.backends.c.plain import emit_c
from symgen.backends.python.module import emit_python

STATE = [1.0, 0.3]


@pytest.fixture
def path(tmp_path: Path) -> Path:
    model, program = handmade.model(), handmade.program()
    for name, text in (emit_c(model, program) | emit_c_batch(model, program) | emit_python(model, program)).items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    return tmp_path / "python/toy.py"


def by_file(path: Path) -> Mapping[str, Any]:
    spec = importlib.util.spec_from_file_location("not_registered", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return vars(module)


def by_text(path: Path) -> Mapping[str, Any]:
    names: dict[str, Any] = {}
    exec(path.read_text(), names)
    return names


def by_text_with_a_name(path: Path) -> Mapping[str, Any]:
    module = ModuleType("no.such.package.toy")
    exec(compile(path.read_text(), "<text>", "exec"), module.__dict__)
    return vars(module)


def by_runpy(path: Path) -> Mapping[str, Any]:
    return runpy.run_path(str(path))


def by_archive(path: Path) -> Mapping[str, Any]:
    archive = path.parent / "models.zip"
    with zipfile.ZipFile(archive, "w") as made:
        made.write(path, "python/renamed.py")
    spec = zipimport.zipimporter(f"{archive}/python").find_spec("renamed")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return vars(module)


def as_a_copy(path: Path) -> Mapping[str, Any]:
    copy = path.with_name("lambda.py")
    copy.write_text(path.read_text())
    return by_file(copy)


WAYS = (by_file, by_text, by_text_with_a_name, by_runpy, by_archive, as_a_copy)
BESIDE_C = (by_file, by_runpy, as_a_copy)


@pytest.mark.parametrize("way", WAYS)
def test_it_loads(way: Callable[[Path], Mapping[str, Any]], path: Path, tool: Callable[[str], str]) -> None:
    registered = dict(sys.modules)
    names = way(path)
    expected = load_generated(path).inverse_dynamics(STATE, STATE, STATE)
    assert names["inverse_dynamics"](STATE, STATE, STATE).tobytes() == expected.tobytes()
    assert names["Parameters"](L=2.0).L == 2.0
    with pytest.raises(names["StateError"], match="ACTUATION_RANK"):
        names["inverse_dynamics"]([1e-5, 0.3], STATE, STATE)
    assert {name for name in sys.modules if "toy" in name} <= registered.keys() | {"generated_toy"}
    tool("cc")
    if way in BESIDE_C:
        compiled = names["compile"]().inverse_dynamics(STATE, STATE, STATE)
        assert compiled.tobytes() == expected.tobytes()
    else:
        with pytest.raises(FileNotFoundError, match=r"no C beside|not loaded from a file"):
            names["compile"]()


def test_it_is_imported_in_another_process(path: Path) -> None:
    process = subprocess.run(
        [sys.executable, "-W", "error", "-c", "import toy; print(toy.PARAMETERS.L, toy.StateError.__module__)"],
        env={**os.environ, "PYTHONPATH": str(path.parent)}, capture_output=True, text=True, check=True,
    )
    assert process.stdout == "2.6 toy\n"


def test_errors_pass_between_processes(path: Path) -> None:
    module = load_generated(path)
    sent = pickle.loads(pickle.dumps(module.StateError("inverse_dynamics", module.Status.NOT_FINITE)))
    assert (sent.quantity, sent.status) == ("inverse_dynamics", module.Status.NOT_FINITE)
    assert str(sent) == "inverse_dynamics: NOT_FINITE"


COMPILERS = {
    "makes nothing": ("exit 0\n", "makes no library"),
    "makes no library": ('while [ "$1" != -o ]; do shift; done; echo odd > "$2"\n', "makes no library"),
    "prints other bytes": ("printf '\\377\\376'\nprintf '\\377\\376 no' >&2\nexit 1\n", "failed"),
    "hangs": ("sleep 30\n", "did not end"),
}


@pytest.mark.parametrize("case", COMPILERS)
def test_an_odd_compiler_is_told_and_spoils_no_cache(
    case: str, path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    body, message = COMPILERS[case]
    odd = tmp_path / "oddcc"
    odd.write_text(f'#!/bin/sh\ncase "$*" in *-dM*) {"true" if case.startswith("makes") else body.splitlines()[0]} '
                   f";; *) {body} ;; esac\n")
    odd.chmod(0o755)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setenv("CC", str(odd))
    module = load_generated(path)
    monkeypatch.setattr(module, "_LONGEST_COMPILATION", 0.5)
    with pytest.raises(RuntimeError, match=message):
        module.compile()
    assert not list((tmp_path / "cache").rglob("*.so"))
    assert not list((tmp_path / "cache").rglob("*.tmp"))


def test_a_damaged_cache_is_built_again(
    path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, tool: Callable[[str], str]
) -> None:
    tool("cc")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    module = load_generated(path)
    folder = tmp_path / "cache/symgen"
    module.compile()
    (built,) = folder.iterdir()
    built.unlink()
    built.write_bytes(b"")
    module.compile().inverse_dynamics(STATE, STATE, STATE)
    assert built.stat().st_size > 0
