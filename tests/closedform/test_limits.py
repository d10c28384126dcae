"""Closed forms that grow without end are given up after counted work, whatever asks for them."""

from __future__ import annotations

from pathlib import Path

import pytest

from symgen.closedform.algebra.fourier import fourier_series
from symgen.closedform.algebra.limits import LIMIT_OF_THE_REST, WORK_LIMIT, TooLargeError, WorkCounter
from symgen.closedform.algebra.translate import Translator
from symgen.closedform.forms import derive_closed_forms
from symgen.model.expressions.expression import Binary, Call, Expression, Name
from symgen.model.load import load_model

LINKS = 9


def test_what_has_no_limit_of_its_own_has_that_of_the_model() -> None:
    work = WorkCounter()
    work.spend(LIMIT_OF_THE_REST // 2)
    with work.limited("a matrix"):
        work.spend(WORK_LIMIT)
    work.spend(LIMIT_OF_THE_REST // 2)
    with pytest.raises(TooLargeError, match="rest on needs more than"):
        work.spend(1)


def test_what_has_a_limit_is_held_to_it_whatever_was_done_before() -> None:
    work = WorkCounter()
    work.spend(LIMIT_OF_THE_REST)
    with pytest.raises(TooLargeError, match="a matrix needs more than"), work.limited("a matrix"):
        work.spend(WORK_LIMIT + 1)


def test_products_of_many_sines_are_not_spread_into_their_waves() -> None:
    names = [f"a_{k}" for k in range(30)]
    product: Expression = Call("sin", (Name(names[0]),))
    for name in names[1:]:
        product = Binary("*", product, Call("sin", (Name(name),)))
    translated = Translator(names, names, {}, [product], [])
    # 2^30 of them
    with pytest.raises(TooLargeError):
        fourier_series(translated.ring, translated.value(product).numerator)


def test_a_rod_across_a_long_chain_has_no_null_space_in_print(tmp_path: Path) -> None:
    # the rod's length is a root, and the polynomial under it has a term for each pair of links
    angles = [f"a_{k}" for k in range(1, LINKS + 1)]
    x, y = (" + ".join(f"l*{wave}({angle})" for angle in angles) for wave in ("cos", "sin"))
    path = tmp_path / "crane.yaml"
    path.write_text(
        f"""
model: crane
coordinates: {{{", ".join(f"{angle}: {{}}" for angle in angles)}}}
parameters: {{l: {{value: 0.7}}, rod: {{value: 1}}}}
kinetic_energy: {" + ".join(f"{angle}_dot**2" for angle in angles)}
constraints:
  geometric:
    across: sqrt(({x} - 0.3)**2 + ({y} - 0.1)**2) - rod
    level: {y} - 0.2
configuration: {{{", ".join(f"{angle}: {0.5 * k - 1}" for k, angle in enumerate(angles))}}}
""",
        encoding="utf-8",
    )
    closed = derive_closed_forms(load_model(path))
    assert closed.null_space is None


SPATIAL = """
model: wedged
parameters: {g: {value: 9.81}, l: {value: 0.37}, rod: {value: 0.52}}
gravity: [0, "-g", 0]
joints:
  j_1: {type: cylindrical, axis: z, rotation: [[x, 0.3]], child: link, coordinates: [s_1, a_1]}
  j_2: {type: cylindrical, at: [0.75, -0.35, -0.75], axis: x, coordinates: [s_2, a_2]}
  j_3: {type: revolute, parent: link, at: [0, 0, 0.75], axis: y, rotation: [[y, 1.1]], coordinate: a_3}
  j_4: {type: revolute, parent: j_3, at: [0, 0, l], axis: x, child: tool, coordinate: a_4}
bodies:
  link: {mass: 6.9, inertia: {xx: 0.1, yy: 0.05, zz: 0.05}}
  tool: {mass: 2.4, com: [0, 0.1, 0], inertia: {xx: 0.08, yy: 0.05, zz: 0.05}}
points:
  tip: {frame: j_2, at: [0, 0.6, 0]}
  anchor: {frame: link, at: [1.17, 0.45, -1.09]}
  end: {frame: tool, at: [0, 0.25, 0]}
  pin: {frame: j_2, at: [-1.07, 1.03, 1.53]}
loops:
  first: {type: distance, between: [tip, anchor], length: rod}
  second: {type: distance, between: [end, pin], length: rod}
"""


@pytest.mark.campaign
def test_minors_of_many_pages_are_not_printed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # rods in space, behind oblique axes: few minors, each of them pages long
    path = tmp_path / "wedged.yaml"
    path.write_text(SPATIAL, encoding="utf-8")
    projector = derive_closed_forms(load_model(path)).forms["nullspace_projector"]
    printed = sum(len(str(meaning)) for _, meaning in projector.intermediates)
    assert printed < 100_000
    monkeypatch.setattr("symgen.closedform.structured.LONGEST_MINORS", 10)
    model = load_model(Path(__file__).resolve().parents[2] / "models" / "five_bar.yaml")
    projector = derive_closed_forms(model).forms["nullspace_projector"]
    assert projector.matrix is None
    assert "symbols and operations" in projector.note
