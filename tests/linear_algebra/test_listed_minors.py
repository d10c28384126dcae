"""Minors of B are listed where they count less than reflections, and where they are many nobody waits for them."""

from __future__ import annotations

from linkages import cranks_on_one_coupler

from symgen.model.load import load_text
from symgen.quantities.select import derive_quantities
from symgen.runtime.effort import done


def test_two_hundred_minors_of_rows_that_depend_on_each_other_count_less_than_reflections() -> None:
    """Five cranks under one coupler: eight rows of rank 5, of which reflections choose at each configuration."""
    (choice,) = derive_quantities(load_text(cranks_on_one_coupler(5), "cranks.yaml"), ["singularity"]).choices
    costs = dict(choice.costs)
    assert costs[choice.title] < 0.9 * costs["householder"]


def test_hundreds_of_minors_of_two_long_rows_are_not_listed_to_be_counted() -> None:
    """Reflections of two rows are short whatever their length: minors of 26 columns take four times the work."""
    names = [f"q{j}" for j in range(26)]
    one, other = (
        " + ".join(f"{('cos', 'sin')[(i + j) % 2]}({i + 1}*{names[j - i]})*{names[j]}_dot" for j in range(26))
        for i in (0, 1)
    )
    text = f"""
model: two_long_rows
coordinates: {{{", ".join(f"{name}: {{unit: rad}}" for name in names)}}}
kinetic_energy: {" + ".join(f"{j + 1}*{name}_dot**2" for j, name in enumerate(names))}
constraints: {{nonholonomic: {{one: {one}, other: {other}}}}}
inputs: {{{", ".join(f"u{j}: {{acts_on: {{{name}: 1}}}}" for j, name in enumerate(names[2:]))}}}
"""
    model = load_text(text, "two_long_rows.yaml")
    before = done()
    (choice,) = derive_quantities(model, ["singularity"]).choices
    assert done() - before < 4_000_000
    assert dict(choice.costs)[choice.title] < 3_000
