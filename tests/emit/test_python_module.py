"""The NumPy module: shapes, statuses, the same bits as the C."""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import handmade
import numpy as np
import pytest

from symgen.emit.c import emit_c
from symgen.emit.python import emit_python


@pytest.fixture(scope="module")
def toy(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    return load(tmp_path_factory.mktemp("toy"), handmade.model(), handmade.program())


def load(folder: Path, model: object, program: object) -> ModuleType:
    for path, text in (emit_c(model, program) | emit_python(model, program)).items():  # type: ignore[arg-type]
        (folder / path).parent.mkdir(exist_ok=True)
        (folder / path).write_text(text)
    file = next((folder / "python").glob("*.py"))
    spec = importlib.util.spec_from_file_location("generated_toy", file)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["generated_toy"] = module
    spec.loader.exec_module(module)
    return module


def states(*axes: int) -> np.ndarray:
    return np.random.default_rng(7).normal(size=(*axes, 2))


def test_shapes_follow_leading_axes(toy: ModuleType) -> None:
    q = states(3, 5)
    assert toy.inverse_dynamics(q, q, q).shape == (3, 5, 2)
    assert toy.inverse_dynamics(q, q[0, 0], q[0]).shape == (3, 5, 2)
    assert toy.mass_matrix(q).shape == (3, 5, 2, 2)
    assert toy.control_matrix(q[0, 0]).tolist() == [[1.0, 0.0], [0.0, 1 / 3]]
    assert toy.inverse_dynamics(q[:0], q[:0], q[:0]).shape == (0, 5, 2)


def test_wrong_length_is_told(toy: ModuleType) -> None:
    with pytest.raises(ValueError, match=r"q has shape \(3,\), expected \(..., 2\)"):
        toy.mass_matrix([1.0, 2.0, 3.0])


@pytest.mark.parametrize(
    ("state", "status"),
    [
        ([1.0, 0.3], None),
        ([1e-5, 0.3], "ACTUATION_RANK"),  # x cos(theta) is too small, cos(theta) is not
        ([0.05, 1.41], "CONSTRAINT_RANK"),  # both are
        ([1.0, 101.0], "ANGLE_RANGE"),
        ([1.0, np.nan], "ANGLE_RANGE"),
        ([np.nan, 0.3], "ACTUATION_RANK"),
        ([np.inf, 0.3], "NOT_FINITE"),
    ],
)
def test_statuses(toy: ModuleType, tool: Callable[[str], str], state: list[float], status: str | None) -> None:
    tool("cc")
    for functions in (toy, toy.compile()):
        batch = functions.inverse_dynamics([state, [1.0, 0.3]], [0, 0], [0, 0])
        assert np.isfinite(batch[1]).all()
        if status is None:
            assert np.array_equal(functions.inverse_dynamics(state, [0, 0], [0, 0]), batch[0])
            continue
        assert np.isnan(batch[0]).all()
        with pytest.raises(toy.StateError) as caught:
            functions.inverse_dynamics(state, [0, 0], [0, 0])
        assert caught.value.status.name == status


def test_python_and_c_agree_bit_for_bit(toy: ModuleType, tool: Callable[[str], str]) -> None:
    tool("cc")
    compiled = toy.compile()
    q = states(500)
    q[:20, 0] = 0.0
    q[20:40] *= 1e3
    p = toy.Parameters(L=1 / 3, I=7)
    for name in ("inverse_dynamics", "mass_matrix", "control_matrix"):
        arguments = (q, q, q) if name == "inverse_dynamics" else (q,)
        ours, theirs = getattr(toy, name)(*arguments, p), getattr(compiled, name)(*arguments, p=p)
        assert ours.tobytes() == theirs.tobytes()
        assert np.isfinite(ours).any()


def test_parameters_are_frozen_and_exact(toy: ModuleType) -> None:
    assert toy.PARAMETERS.I == 0.26
    with pytest.raises(AttributeError):
        toy.PARAMETERS.L = 1.0


def test_compile_uses_the_cache_and_tells_failures(
    toy: ModuleType, tool: Callable[[str], str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    tool("cc")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    toy.compile()
    (built,) = (tmp_path / "symgen").iterdir()
    before = built.stat().st_mtime_ns
    toy.compile()
    assert [path.stat().st_mtime_ns for path in (tmp_path / "symgen").iterdir()] == [before]
    monkeypatch.setenv("CC", "cc --no-such-option")
    with pytest.raises(RuntimeError, match="no-such-option"):
        toy.compile()
    monkeypatch.setenv("CC", "no-such-compiler")
    with pytest.raises(FileNotFoundError, match="no-such-compiler"):
        toy.compile()


def test_library_sine_and_cosine(tmp_path: Path) -> None:
    module = load(tmp_path, handmade.model(), handmade.program(own_sincos=False))
    assert module.mass_matrix([0.0, 0.5])[0, 1] == 2.6 * np.sin(0.5)
