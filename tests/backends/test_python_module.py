"""The NumPy module: shapes, statuses, the same bits as the C."""

from __future__ import annotations

import hashlib
import inspect
from collections.abc import Callable
from pathlib import Path
from types import ModuleType, SimpleNamespace

import handmade
import numpy as np
import pytest
from generated_python import load_generated

import symgen
from symgen.backends.c.batch import emit_c_batch
from symgen.backends.c.plain import emit_c
from symgen.backends.python.module import emit_python
from symgen.ir.kernel import Program
from symgen.model.model import Model

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def car() -> ModuleType:
    return load_generated(ROOT / "generated/front_car/python/front_car.py")


@pytest.fixture(scope="module")
def toy(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    return load(tmp_path_factory.mktemp("toy"), handmade.model(), handmade.program())


def load(folder: Path, model: Model, program: Program) -> ModuleType:
    files = emit_c(model, program) | emit_c_batch(model, program) | emit_python(model, program)
    for path, text in files.items():
        (folder / path).parent.mkdir(exist_ok=True)
        (folder / path).write_text(text)
    return load_generated(next((folder / "python").glob("*.py")))


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


def test_without_a_compiler_numpy_does_the_work(
    toy: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setenv("CC", "no-such-compiler")
    with pytest.warns(RuntimeWarning, match="no-such-compiler.*NumPy"):
        compiled = toy.compile()
    assert compiled.inverse_dynamics is toy.inverse_dynamics
    assert not [*tmp_path.iterdir()]


def test_without_the_c_compile_names_the_missing_file(
    toy: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(toy, "__file__", str(tmp_path / "python" / "toy.py"))
    with pytest.raises(FileNotFoundError, match=r"c/toy\.h"):
        toy.compile()


def test_compiled_functions_are_those_of_the_module(toy: ModuleType, tool: Callable[[str], str]) -> None:
    """Shapes, broadcasting, chunks, parameters that are arrays, quantities without a batch kernel, mistakes."""
    tool("cc")
    compiled = toy.compile()
    many = states(2, toy._CHUNK // 2 + 3)
    cases = [(many, many[0], many[0, 0]), (many.T.copy().T, many, many), (many[:0], many[:0], many[:0])]
    for q, qd, qdd in cases:
        ours, theirs = (functions.inverse_dynamics(q, qd, qdd) for functions in (toy, compiled))
        assert theirs.shape == ours.shape
        assert theirs.tobytes() == ours.tobytes()
    swept = toy.Parameters(L=np.linspace(1.0, 2.0, len(many[0])))
    wanted = toy.inverse_dynamics(many, many, many, swept)
    assert compiled.inverse_dynamics(many, many, many, p=swept).tobytes() == wanted.tobytes()
    other = SimpleNamespace(**vars(toy.PARAMETERS))
    for other.L in (1.5, 1.25):  # the same object with other contents
        wanted = toy.inverse_dynamics(many, many, many, other)
        assert compiled.inverse_dynamics(many, many, many, other).tobytes() == wanted.tobytes()
    assert compiled.mass_matrix(many).tobytes() == toy.mass_matrix(many).tobytes()
    assert compiled.mass_matrix([0.1, 0.2]).tobytes() == toy.mass_matrix([0.1, 0.2]).tobytes()
    assert compiled.mass_matrix.__doc__ == toy.mass_matrix.__doc__
    for functions in (toy, compiled):
        with pytest.raises(ValueError, match=r"q has shape \(3,\), expected \(..., 2\)"):
            functions.inverse_dynamics([1.0, 2.0, 3.0], [0, 0], [0, 0])
        with pytest.raises(ValueError, match=r"leading axes .*: q has shape \(3, 2\), qd has shape \(4, 2\)"):
            functions.inverse_dynamics(np.zeros((3, 2)), np.zeros((4, 2)), np.zeros(2))
        with pytest.raises(TypeError, match=r"missing a required argument|required positional argument"):
            functions.inverse_dynamics([1.0, 2.0])


def test_library_sine_and_cosine(tmp_path: Path) -> None:
    module = load(tmp_path, handmade.model(), handmade.program(own_sincos=False))
    assert module.mass_matrix([0.0, 0.5])[0, 1] == 2.6 * np.sin(0.5)


def test_a_module_says_what_it_is_made_of(car: ModuleType) -> None:
    text = (ROOT / "models/front_car.yaml").read_bytes()
    assert hashlib.sha256(text).hexdigest() == car.MODEL_SHA256
    assert car.__version__ == symgen.__version__
    signature = inspect.signature(car.inverse_dynamics)
    assert [parameter.annotation for parameter in signature.parameters.values()] == [*["ArrayLike"] * 3, "Parameters"]
    assert car.inverse_dynamics.__doc__.startswith("u: the smallest inputs")


def test_parameters_are_numbers_or_arrays_of_them(car: ModuleType) -> None:
    assert car.Parameters(L=3, m_1=np.float32(2), m_2=[1.0, 2.0], Theta_1=np.ones(2)).L == 3
    for wrong in ("2", None, 1j, [None]):
        with pytest.raises(TypeError, match=r"the parameter m_1 is .*, neither a number nor an array of numbers"):
            car.Parameters(m_1=wrong)


def test_a_parameter_that_is_not_finite_is_named(car: ModuleType) -> None:
    for wrong in (float("nan"), np.float64("inf"), np.array(-np.inf)):
        with pytest.raises(ValueError, match=r"^the parameter m_1 is .*(nan|inf).*, no finite number$"):
            car.Parameters(m_1=wrong)
    # of many states those get NaN whose parameter is none
    masses = car.Parameters(m_1=[1100.0, np.nan])
    moving = [0.0, 0.0, 0.3, 0.2]
    assert np.isnan(car.inverse_dynamics(moving, moving, moving, masses)).any(axis=1).tolist() == [False, True]


def test_what_is_no_parameters_is_told(car: ModuleType, tool: Callable[[str], str]) -> None:
    tool("cc")
    moving = [0.0, 0.0, 0.3, 0.2]
    for functions in (car, car.compile()):
        for wrong, said in (
            ({"L": 2.4}, r"^p is of type dict, which has no L: give Parameters\(\*\*p\) of this module$"),
            ((2.4, 1100.0), r"^p is of type tuple, which has no L: give Parameters\(\.\.\.\) of this module$"),
            (None, r"^p is of type NoneType, which has no L"),
            (SimpleNamespace(L=2.4), r"^p is of type SimpleNamespace, which has no m_1"),
        ):
            for states in (moving, [moving, moving]):
                with pytest.raises(TypeError, match=said):
                    functions.inverse_dynamics(states, moving, moving, wrong)


def test_parameters_have_leading_axes_as_states_have(car: ModuleType, tool: Callable[[str], str]) -> None:
    """One state with many parameters gives as many results; axes that do not go together are named."""
    tool("cc")
    moving = [0.0, 0.0, 0.3, 0.2]
    lengths = np.linspace(2.0, 3.0, 5)
    wanted = np.array([car.inverse_dynamics(moving, moving, moving, car.Parameters(L=length)) for length in lengths])
    grid = car.Parameters(L=lengths, m_1=[[1100.0], [1200.0]])
    for functions in (car, car.compile()):
        swept = functions.inverse_dynamics(moving, moving, moving, car.Parameters(L=lengths))
        assert swept.tobytes() == wanted.tobytes()
        assert functions.inverse_dynamics(moving, moving, moving, grid).shape == (2, 5, 2)
        assert functions.inverse_dynamics(moving, moving, moving, grid)[0].tobytes() == wanted.tobytes()
        with pytest.raises(ValueError, match=r"^leading axes .*: q has shape \(3, 4\), .*, L has shape \(5,\)$"):
            functions.inverse_dynamics([moving] * 3, moving, moving, car.Parameters(L=lengths))
        with pytest.raises(ValueError, match=r"L has shape \(5,\), m_1 has shape \(2,\)$"):
            functions.inverse_dynamics(moving, moving, moving, car.Parameters(L=lengths, m_1=[1.0, 2.0]))


def test_what_is_no_state_is_told(car: ModuleType) -> None:
    moving = [0.0, 0.0, 0.3, 0.2]
    for wrong in ({"x": 1.0}, None, "0123", [moving, [0.0]]):
        with pytest.raises((TypeError, ValueError), match=r"^qd (is .*, no array of states of 4 numbers|has shape)"):
            car.inverse_dynamics(moving, wrong, moving)
    with pytest.raises(TypeError, match=r"^the parameter L is .*, neither a number nor an array of numbers$"):
        car.Parameters(L=[[1.0], [1.0, 2.0]])
