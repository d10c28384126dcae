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
