"""What cannot be a gain is told with its place, and what to do."""

from __future__ import annotations

import pytest
from gain_machines import MACHINES_BY_CURRENTS

from symgen.diagnostics import ModelError
from symgen.model.load import load_text

# Without units of gains, which would contradict some of the changes.
ARM_TEXT = MACHINES_BY_CURRENTS["arm"].text.replace(", unit: N*m/A", "").replace(", unit: A", "")
SECOND = "u_b: {acts_on: {b: k_2}}"
ELBOW = "elbow: {mass: m_2,"


def mistake_of(change: tuple[str, str], identify: str) -> tuple[str, str, str]:
    """Message, remedy and what stands at the place, where there is one mistake."""
    before, after = change
    assert before in ARM_TEXT
    text = ARM_TEXT.replace(before, after) + f"identify: {identify}\n"
    with pytest.raises(ModelError) as caught:
        load_text(text, "arm.yaml")
    (mistake,) = caught.value.mistakes
    span = mistake.span
    assert span is not None
    return mistake.message, mistake.remedy, text.splitlines()[span.line - 1][span.column - 1 : span.end_column - 1]


@pytest.mark.parametrize(
    ("change", "gains", "message", "remedy"),
    [
        (("", ""), "k_3", "`k_3` under `gains` of `identify` is no parameter", "did you mean `k_"),
        ((SECOND, "u_b: {joint: b}"), "k_2", "the gain `k_2` is in no input", "such as `acts_on: {a: k_2}`"),
        (("", ""), "w", "the gain `w` is in no input", "write it as a factor of what an input acts by"),
        ((SECOND, "u_b: {acts_on: {b: k_1}}"), "k_1", "is a factor of several inputs: `u_a`, `u_b`", "of its own"),
        ((SECOND, "u_b: {acts_on: {b: k_2**2}}"), "k_2", "is no mere factor of `u_b`", "write it once in each product"),
        ((SECOND, "u_b: {acts_on: {b: k_2 + 1}}"), "k_2", "is no mere factor of `u_b`", "acts_on: {x: k_2*cos(b)}"),
        ((SECOND, 'u_b: {acts_on: {b: k_2, a: "1"}}'), "k_2", "is no mere factor of `u_b`", "in nothing else"),
        ((SECOND, "u_b: {acts_on: {b: cos(k_2)}}"), "k_2", "is no mere factor of `u_b`", "write it once"),
        ((ELBOW, "elbow: {mass: m_2*k_2,"), "k_2", "the gain `k_2` stands in `bodies` or `rotor_inertias`", "name"),
        (("viscous: d_2", "viscous: d_2*k_2"), "k_2", "the gain `k_2` stands in forces or friction, too", "by itself"),
        (("stiffness: k,", "stiffness: k_2,"), "k_2", "the gain `k_2` stands in the energies or springs, too", "name"),
        (("at: [l, 0, 0]", "at: [k_2, 0, 0]"), "k_2", "stands in frames, points or constraints, too", "name the gain"),
        (("k_2: {value: 0.35}", "k_2: {value: k_1/2}"), "k_2", "follows from other parameters", "as a number"),
        (("k_2: {value: 0.35}", "k_2: {value: 0}"), "k_2", "the gain `k_2` is 0", "that the data sheet says"),
        ((SECOND, "u_b: {acts_on: {b: k_2*w}}"), "k_2, w", "the gain `w` stands in forces or friction, too", "name"),
        ((SECOND, "u_b: {acts_on: {b: k_2}}"), "k_2, k_2", "the gain `k_2` stands twice", "name it once"),
    ],
)  # fmt: skip
def test_what_is_no_gain(change: tuple[str, str], gains: str, message: str, remedy: str) -> None:
    said, done, there = mistake_of(change, f"{{gains: [{gains}]}}")
    assert message in said
    assert remedy in done
    assert there in gains


def test_two_gains_of_one_input() -> None:
    change = (SECOND, "u_b: {acts_on: {b: k_2*n}}"), "{gains: [k_2, n]}"
    text = ARM_TEXT.replace("gravity:", "  n: {value: 50}\ngravity:").replace(*change[0])
    with pytest.raises(ModelError) as caught:
        load_text(f"{text}identify: {change[1]}\n", "arm.yaml")
    (mistake,) = caught.value.mistakes
    assert "`k_2` and `n` are both factors of `u_b`: only their product shows" in mistake.message
    assert "leave out the one that is known" in mistake.remedy


@pytest.mark.parametrize("key", ["fixed", "geometry"])
def test_a_gain_that_is_known(key: str) -> None:
    said, done, there = mistake_of(("", ""), f"{{{key}: [k_2], gains: [k_2]}}")
    assert "`k_2` is a gain that is estimated, and is taken for known" in said
    assert "one of the lists" in done
    assert there == "k_2"


@pytest.mark.parametrize(
    "action",
    [
        "acts_on: {b: k_2*g, a: k_2*cos(b)/2}",
        "point: tip, direction: [0, k_2, 0], axes: elbow",
        "acts_on: {b: -k_2}",
        "acts_on: {b: n*cos(a)}",
    ],
)
def test_factors_by_any_way(action: str) -> None:
    """Several coefficients, a direction, a definition, a parameter that follows."""
    text = ARM_TEXT.replace(SECOND, f"u_b: {{{action}}}").replace(
        "gravity:", "  n: {value: 2*k_2}\ndefinitions:\n  g: sin(b) + 2\ngravity:"
    )
    text = text.replace("springs:", "points:\n  tip: {frame: elbow, at: [0.3, 0, 0]}\nsprings:")
    model = load_text(f"{text}identify: {{gains: [k_2]}}\n", "arm.yaml")
    assert model.identify is not None
    assert model.identify.gains == ("k_2",)
