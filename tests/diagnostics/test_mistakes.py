"""Every mistake of the user with its full text: file, line, column, excerpt, remedy, all mistakes of a file at once."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest
from spoiled_models import GOOD, GROUPS

from symgen.diagnostics import Mistake, ModelError, SymgenBug
from symgen.generation.refusals import MORE_STATES, no_states
from symgen.model.load import load_text
from symgen.verify.certificate import Fault
from symgen.verify.run import blank_certificate

EXPECTED = Path(__file__).parent / "expected"


@cache
def refusal(text: str) -> ModelError:
    """What symgen says about a spoiled model; fails where it says nothing."""
    with pytest.raises(ModelError) as raised:
        load_text(text, "spoiled.yaml")
    return raised.value


def sections(group: str) -> dict[str, str]:
    """The expected texts of a group by case."""
    by_case: dict[str, str] = {}
    for section in (EXPECTED / f"{group}.txt").read_text(encoding="utf-8").split("== ")[1:]:
        name, _, text = section.partition("\n")
        by_case[name] = text
    return by_case


@pytest.mark.parametrize("group", GROUPS)
def test_mistakes_are_told_with_place_and_remedy(group: str) -> None:
    expected = sections(group)
    said = {name: refusal(text).render() + "\n" for name, text in GROUPS[group].items()}
    assert list(said) == list(expected)
    for name, text in said.items():
        assert text == expected[name], f"case {name} of {group}"


@pytest.mark.parametrize("group", GROUPS)
def test_every_mistake_has_a_place_and_a_remedy(group: str) -> None:
    for name, text in GROUPS[group].items():
        lines = text.count("\n") + 2
        for mistake in refusal(text).mistakes:
            assert mistake.remedy, name
            assert mistake.span is not None, name
            assert 1 <= mistake.span.line <= lines, name
            assert mistake.span.end_column > mistake.span.column >= 1, name


def test_the_unspoiled_model_has_no_mistakes() -> None:
    assert load_text(GOOD, "good.yaml").notices == ()


def test_harmless_descriptions_survive() -> None:
    description = r"*/ {{ x }} {% raw %} \n <script> %s $HOME ' \" & # ünïcödé"
    model = load_text(f"{GOOD}description: '{description.replace(chr(39), chr(39) * 2)}'\n", "m.yaml")
    assert model.description == description


def test_notices() -> None:
    text = f"""{GOOD}
definitions: {{b: x}}
outputs: [mass_matrix, multipliers, control_matrix, orthogonal_complement, constraint_residual, point_position]
constraints: {{}}
"""
    assert [notice.message for notice in load_text(text, "m.yaml").notices] == [
        "`multipliers` is not made: the model has no constraints",
        "`control_matrix` is not made: the model has no inputs",
        "`orthogonal_complement` is not made: the model names no `independent_velocities`",
        "`constraint_residual` is not made: the model has no geometric constraints",
        "`point_position` is not made: the model has no points",
        "the definition `b` is not used",
    ]


def test_rows_that_say_nothing_are_notices() -> None:
    text = f"{GOOD}constraints: {{geometric: {{c: sin(a)**2 + cos(a)**2 - 1}}, nonholonomic: {{d: 0*x_dot}}}}\n"
    assert [notice.message for notice in load_text(text, "m.yaml").notices] == [
        "the constraint `c` is zero for all configurations and says nothing",
        "the constraint `d` is zero for all motions and says nothing",
    ]


def test_a_file_that_is_not_text(tmp_path: Path) -> None:
    from symgen.model.load import load_model

    path = tmp_path / "m.yaml"
    path.write_bytes(b"model: m\ndescription: \xff\n")
    with pytest.raises(ModelError, match="the file is not text in UTF-8"):
        load_model(path)


def test_windows_line_ends_and_byte_order_mark(tmp_path: Path) -> None:
    from symgen.model.load import load_model

    path = tmp_path / "m.yaml"
    path.write_bytes(b"\xef\xbb\xbf" + GOOD.replace("\n", "\r\n").encode())
    assert load_model(path).name == "carriage"


def test_a_radius_that_is_a_number_has_the_unit_of_a_length() -> None:
    text = """\
model: hoop
coordinates: {x: {unit: m}, y: {unit: m}, heading: {unit: rad}, spin: {unit: rad}}
gravity: [0, 0, -9.81]
frames:
  fork: {translation: [x, y, RADIUS], rotation: [[z, heading]]}
  hoop: {parent: fork, rotation: [[y, spin]]}
bodies: {hoop: {mass: 3, inertia: {xx: 0.6, yy: 1.2, zz: 0.6}}}
rolling: {ground: {frame: hoop, radius: RADIUS}}
"""
    for radius in ("1", "2", "0.35", "1/4"):
        assert load_text(text.replace("RADIUS", radius), "hoop.yaml").r == 2


def test_a_quarter_may_be_a_length() -> None:
    """A user's 0.25 is as good a length as his 0.3; numbers that count are those of energies and of integers."""
    text = """\
model: pin
coordinates: {x: {unit: m}, a: {unit: rad}}
kinetic_energy: 3*x_dot**2 + 1/4*a_dot**2
constraints: {geometric: {pin: "x - 0.25*sin(a)"}}
configuration: {x: 0, a: 0}
"""
    assert load_text(text, "pin.yaml").r == 1


@pytest.mark.parametrize("remedy", ["", "  "])
def test_no_mistake_leaves_without_a_remedy(remedy: str) -> None:
    with pytest.raises(SymgenBug, match="no remedy for: the loop is open"):
        Mistake("the loop is open", remedy)


@pytest.mark.parametrize("what", ["nothing was found", "nothing was found; look further"])
def test_what_ends_a_verification_has_a_remedy(what: str) -> None:
    model = load_text(GOOD, "good.yaml")
    certificate = replace(blank_certificate(model, None, {}, None), faults=(Fault(f"{model.name}: {what}"),))
    mistake = no_states(model, certificate.faults[0].what)
    assert mistake.message == "nothing was found"
    assert mistake.remedy == ("look further" if ";" in what else MORE_STATES)
