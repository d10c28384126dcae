"""Models in Python: builder and model file are one language; what is made of them is what the command makes."""

from __future__ import annotations

import inspect
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import sympy

import symgen
from symgen.cli import main as cli
from symgen.generation.results import WrongUseError
from symgen.model.file.schema import MODEL
from symgen.model.load import load_model, load_text
from symgen.model.model import Model
from symgen.notebook import results
from symgen.notebook.language import as_block, as_blocks, as_yaml
from symgen.notebook.model_file import ModelFile, load
from symgen.notebook.words import block_words
from symgen.simulate.simulation import NotSimulatedError
from tests.shipped import ALL

ROOT = Path(__file__).parents[2]


def meaning(model: Model) -> str:
    """All of a model but the places in its file."""
    return re.sub(r"span=Span\([^)]*\)", "", repr(replace(model, text_hash="", notices=())))


def cart() -> ModelFile:
    """A cart with a pendulum, written with SymPy."""
    a, x_dot, a_dot, m_c, m_p, length, g = sympy.symbols("a x_dot a_dot m_c m_p l g")
    coupling = m_p * length * sympy.cos(a)
    return (
        symgen.Model("cart")
        .coordinate("x", unit="m", range=[-2, 2])
        .coordinate("a", unit="rad")
        .parameter("m_c", 3, unit="kg", range=(1, 10))
        .parameter("m_p", 0.5, unit="kg")
        .parameter("l", sympy.Rational(2, 5), unit="m")
        .parameter("g", 9.81, unit="m/s**2")
        .kinetic_energy((m_c + m_p) / 2 * x_dot**2 + coupling * x_dot * a_dot + m_p * length**2 / 2 * a_dot**2)
        .potential_energy(-g * coupling)
        .input("F", unit="N", acts_on={"x": 1})
        .outputs("inverse_dynamics", "forward_dynamics")
    )


@pytest.mark.parametrize("name", ALL)
def test_the_model_file_and_its_blocks_are_one_language(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Every shipped model comes back from its blocks as the same model."""
    path = ROOT / "models" / f"{name}.yaml"
    monkeypatch.chdir(path.parent)
    blocks = as_blocks(path.read_text(encoding="utf-8"))
    text = as_yaml({name: as_block(block) for name, block in blocks.items()})
    assert as_blocks(text) == blocks
    assert meaning(load_text(text, str(path))) == meaning(load_model(path))
    assert max(map(len, text.splitlines())) < 200


def test_every_block_has_a_word_and_every_word_its_keys() -> None:
    words = block_words()
    blocks = {word.block[0] for word in words.values()}
    assert blocks == {key.key for key in MODEL.fields} - {"model"}
    for name, word in words.items():
        method = getattr(ModelFile, name)
        assert set(inspect.signature(method).parameters) >= {"self", *(key.key for key in word.keys)}
        assert method.__name__ == name
        assert method.__doc__


def test_a_model_built_word_by_word_is_the_one_written_by_hand(tmp_path: Path) -> None:
    text = (ROOT / "models" / "rapkm_bodies.yaml").read_text(encoding="utf-8")
    words = {word.block: word for word in block_words().values()}
    built = symgen.Model("rapkm_bodies")
    for block, value in as_blocks(text).items():
        if block == "constraints":
            for kind, rows in value.items():
                getattr(built, kind)(**rows)
        elif block != "model":
            word = words[(block,)]
            put = getattr(built, word.word)
            if word.fills == "an entry":
                for name, entry in value.items():
                    put(name, **entry) if isinstance(entry, dict) else put(name, entry)
            elif word.fills in ("named values", "keys"):
                put(**value)
            else:
                put(value)
    assert meaning(built.resolved) == meaning(load_model(ROOT / "models" / "rapkm_bodies.yaml"))
    again = load(built.save(tmp_path / "again.yaml"))
    assert again.text == built.text
    assert meaning(again.resolved) == meaning(built.resolved)


def test_expressions_of_sympy_are_those_of_the_language() -> None:
    x, y = sympy.symbols("x y")
    t = sympy.Symbol("t")
    a = sympy.Function("a")(t)
    assert as_block(sympy.sqrt(x) / 2 - sympy.atan2(y, x) ** 2) == "sqrt(x)/2 - atan2(y, x)**2"
    assert as_block(sympy.Float(0.1) * x) == "0.1*x"
    assert as_block(sympy.Float(1.2345678901234567)) == "1.2345678901234567"
    assert as_block(sympy.E**2 * x) == "x*exp(2)"
    assert as_block(a.diff(t) ** 2 + sympy.sin(a) * a.diff(t, 2)) == "a_ddot*sin(a) + a_dot**2"
    assert as_block(sympy.Matrix([1, x, sympy.pi / 2])) == ["1", "x", "pi/2"]
    with pytest.raises(TypeError, match="no rate"):
        as_block(a.diff(t, 3))


def test_numbers_keep_their_digits_and_what_means_nothing_is_refused() -> None:
    assert as_block([0.1, np.float64(1e-3), np.arange(2), 3]) == ["0.1", "0.001", ["0", "1"], "3"]
    assert as_block({"a": 1 / 3}) == {"a": "0.3333333333333333"}
    for value in (True, None, 1j, object()):
        with pytest.raises(TypeError, match="nothing of a model file"):
            as_block(value)


def test_mistakes_of_words_name_what_was_meant() -> None:
    model = symgen.Model("m")
    with pytest.raises(TypeError, match="did you mean `parent`"):
        model.joint("j", "revolute", paren="base")
    with pytest.raises(TypeError, match="missing a required argument: 'type'"):
        model.joint("j")
    with pytest.raises(AttributeError, match="did you mean `coordinate`"):
        model.coordinat("x")
    with pytest.raises(TypeError, match="a name and a value"):
        model.definition("v")


def test_mistakes_of_a_built_model_stand_in_its_text() -> None:
    with pytest.raises(symgen.ModelError) as raised:
        cart().kinetic_energy("m_q*x_dot**2").input("T", acts_on={"b": 1}).derive()
    assert [mistake.remedy for mistake in raised.value.mistakes]
    assert "cart:10:17: unknown name `m_q` in the kinetic energy" in str(raised.value)
    assert "T: {acts_on: {b: 1}}" in str(raised.value)


def test_a_model_is_loaded_from_path_text_and_blocks(tmp_path: Path) -> None:
    path = ROOT / "models" / "skate.yaml"
    text = path.read_text(encoding="utf-8")
    of_path, of_text = load(path), load(text)
    assert of_path.text == of_text.text == text
    assert meaning(of_path.resolved) == meaning(of_text.resolved) == meaning(load(of_path.blocks).resolved)
    with pytest.raises(symgen.ModelError):
        load("model: m\ncoordinates: {x: {}}\n")
    with pytest.raises(symgen.ModelError):
        load({"coordinates": {"x": {}}})
    with pytest.raises(FileNotFoundError):
        load(tmp_path / "none.yaml")


def test_a_model_stays_as_it_was_read(tmp_path: Path) -> None:
    """What happens to its file afterwards is another model."""
    path = cart().save(tmp_path / "cart.yaml")
    model = load(path)
    path.write_text("model: broken\n")
    assert model.resolved.name == "cart"
    assert model.drawing() is None


def test_a_copy_may_be_changed() -> None:
    first = cart()
    other = first.copy().parameter("m_c", 4)
    assert (first.blocks["parameters"]["m_c"]["value"], other.blocks["parameters"]["m_c"]["value"]) == ("3", "4")
    assert first.blocks["parameters"]["m_c"]["range"] == ["1", "10"]


def test_a_robot_description_lies_beside_a_changed_model() -> None:
    model = load(ROOT / "models" / "five_bar.yaml").outputs("inverse_dynamics")
    assert model.resolved.outputs == ("inverse_dynamics",)


@pytest.mark.campaign
@pytest.mark.slow
@pytest.mark.toolchain
def test_generation_writes_what_the_command_writes(tmp_path: Path) -> None:
    made = cart().generate(tmp_path / "python", parts=("c", "python"))
    path = cart().save(tmp_path / "cart.yaml")
    assert cli.main([str(path), "--only", "c,python", "--out", str(tmp_path / "command"), "--quiet"]) == 0
    for file in made.files:
        other = tmp_path / "command" / "cart" / file.relative_to(made.folder)
        if file.name != "certificate.json":
            assert file.read_bytes() == other.read_bytes()
    assert made.certificate["passed"]
    assert made.operations["forward_dynamics"] < 60
    assert "forward_dynamics" in repr(made)
    assert "<pre>" in made._repr_html_()


@pytest.mark.slow
@pytest.mark.toolchain
def test_compiled_functions_are_the_equations_of_motion() -> None:
    """The equations of motion by SymPy from the same energies."""
    car = cart().compile()
    q, qd, qdd = np.array([0.3, 0.7]), np.array([0.2, -1.1]), np.array([0.4, 0.9])
    a, m_c, m_p, length, g = q[1], 3, 0.5, 0.4, 9.81
    force = (m_c + m_p) * qdd[0] + m_p * length * (np.cos(a) * qdd[1] - np.sin(a) * qd[1] ** 2)
    moment = m_p * length * (np.cos(a) * qdd[0] + length * qdd[1] + g * np.sin(a))
    accelerations = car.forward_dynamics(q, qd, [force])
    mass = car.Parameters(m_c=6)
    heavier = car.forward_dynamics(np.array([q, q]), np.array([qd, qd]), np.array([[force], [force]]), p=mass)
    coupling = m_p * length * np.cos(a)
    # what would hold the pendulum beside the force is not there
    rest = np.linalg.solve([[m_c + m_p, coupling], [coupling, m_p * length**2]], [0, moment])
    assert accelerations == pytest.approx(qdd - rest, rel=1e-13)
    assert heavier.shape == (2, 2)
    assert abs(heavier[0, 0]) < abs(accelerations[0])
    assert "forward_dynamics(q, qd, u, p=PARAMETERS)" in repr(car)
    with pytest.raises(AttributeError, match="compiled with inverse_dynamics, forward_dynamics, without multipliers"):
        _ = car.multipliers


@pytest.mark.slow
@pytest.mark.campaign
def test_a_motion_has_arrays_a_chart_and_an_animation() -> None:
    motion = cart().simulate(0.4, frames=20, start={"a": 1.0}, inputs={"F": 1.0})
    assert motion.q.shape == motion.rates.shape == (9, 2)
    assert motion["a"][0] == 1.0
    # what the force does is the energy that is gained
    gained = motion.energy.sum(axis=1) - motion.energy[0].sum()
    assert gained == pytest.approx(motion["x"] - motion["x"][0], abs=1e-8)
    assert motion._repr_html_().startswith("<div><svg")
    with pytest.raises(KeyError, match="'b' is none of x, a"):
        motion["b"]
    with pytest.raises(WrongUseError, match="cart: start: unknown name 'b'"):
        cart().simulate(start={"b": 1.0})


def test_verification_that_fails_is_an_exception(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    made = results.generate

    def failing(*given: object) -> object:
        return replace(made(*given), failures=("x is 20 units off",))

    monkeypatch.setattr(results, "generate", failing)
    with pytest.raises(symgen.RejectedError, match="20 units off"):
        cart().generate(tmp_path, parts=("python",))
    assert list(tmp_path.iterdir()) == []


def test_parts_and_methods_that_there_are_not(tmp_path: Path) -> None:
    with pytest.raises(WrongUseError, match="did you mean `python`"):
        cart().generate(tmp_path, parts=("pythn",))
    with pytest.raises(WrongUseError, match="no method 'minr' of inverse_dynamics; did you mean `minor`"):
        cart().generate(tmp_path, methods={"inverse_dynamics": "minr"})
    with pytest.raises(WrongUseError, match="no method 'minor' of energy; it has no methods"):
        cart().compile(methods={"energy": "minor"})


@pytest.mark.slow
@pytest.mark.campaign
def test_no_motion_from_a_singular_start() -> None:
    """A crank as long as its rod, with the slider at its centre."""
    crank = load(ROOT / "models" / "slider_crank.yaml").parameter("r", 0.3, unit="m").parameter("l", 0.3, unit="m")
    with pytest.raises(NotSimulatedError, match="no consistent start"):
        crank.simulate(0.1, start={"alpha": np.pi / 2, "beta": -np.pi / 2, "s": 0})
