"""Long chains: methods that cannot be the cheapest are not built, u and accelerations grow linearly, digits stay."""

from __future__ import annotations

from pathlib import Path

import pytest
from chains import chain

from symgen.generation.draft import draft_of
from symgen.generation.results import Options
from symgen.model.load import load_model
from symgen.pipeline import generate
from symgen.quantities.candidates import ABSOLUTE, ARTICULATED
from symgen.quantities.select import Selection, derive_quantities
from symgen.symbolic.traverse import topological
from symgen.verify.expected import Expected
from symgen.verify.sampling.searched import WorstStateSearch


def derived(links: int, folder: Path, *outputs: str) -> Selection:
    path = folder / f"chain{links}.yaml"
    path.write_text(chain(links), encoding="utf-8")
    return derive_quantities(load_model(path), outputs)


@pytest.mark.mechanisms
def test_u_grows_linearly(tmp_path: Path) -> None:
    weights = []
    for links in (8, 16, 32):
        choice = derived(links, tmp_path, "inverse_dynamics").method_of_u
        assert choice is not None
        assert [name for name, _ in choice.costs] == ["elimination"]
        weights += [weight for _, weight in choice.costs]
    assert weights[2] - weights[1] == pytest.approx(2 * (weights[1] - weights[0]), rel=0.05)


@pytest.mark.mechanisms
def test_accelerations_grow_linearly(tmp_path: Path) -> None:
    weights = []
    for links in (8, 12, 16):
        selection = derived(links, tmp_path, "forward_dynamics", "multipliers")
        assert [choice.title for choice in selection.choices] == [ARTICULATED, ARTICULATED]
        weights.append([weight for choice in selection.choices for _, weight in choice.costs])
    for few, more, many in zip(*weights, strict=True):
        assert many - more == pytest.approx(more - few, rel=0.05)


def test_energies_written_out_are_derived_in_absolute_angles(tmp_path: Path) -> None:
    path = tmp_path / "chain6.yaml"
    path.write_text(chain(6).replace("gravity:", "kinetic_energy: J*a_1_dot**2/2\ngravity:"), encoding="utf-8")
    selection = derive_quantities(load_model(path), ("forward_dynamics", "multipliers"))
    assert [choice.title for choice in selection.choices] == [ABSOLUTE, ABSOLUTE]
    known = {c.name for c in selection.mechanics.model.coordinates}
    for quantity in selection.quantities:
        guards = [guard.denominator for guard in quantity.guards]
        symbols = {str(x.payload) for x in topological([*quantity.outputs, *guards]) if x.op == "symbol"}
        assert known <= symbols
        assert not [name for name in symbols if "absolute" in name]


@pytest.mark.mechanisms
def test_the_size_of_long_code_is_told(tmp_path: Path) -> None:
    def notices(links: int, *parts: str) -> list[str]:
        path = tmp_path / f"chain{links}.yaml"
        path.write_text(chain(links), encoding="utf-8")
        options = Options(parts=parts, scalars=("float64",), verify=False)
        return [notice.message for notice in generate(path, options, lambda _: None).notices]

    assert notices(4, "c") == []
    assert notices(32, "python") == []
    (message,) = notices(32, "c")
    assert notices(32, "package") == [message]
    assert "kB of machine code on a Cortex-M4" in message
    assert "inverse_dynamics 1" in message


@pytest.mark.mechanisms  # 400 states of a chain of 24 links, with the reference at the worst
def test_links_that_turn_quickly_beside_a_tip_that_hardly_pulls(tmp_path: Path) -> None:
    """Centripetal accelerations gathered from the root, and taken off again, cost 11 units at one state."""
    path = tmp_path / "chain24.yaml"
    path.write_text(chain(24), encoding="utf-8")
    draft = draft_of(load_model(path), ["multipliers"], Options())
    assert draft.choice("multipliers").title == ARTICULATED
    search = WorstStateSearch(Expected(draft.model, ["multipliers"], 8, lambda _: None))
    kernel = draft.kernels("multipliers")["float64"]
    search.look(kernel.name, "its method", lambda: kernel)
    assert search.largest(kernel, draft.programs["float64"].sincos, "float64") < 8
