"""What passes are worth: counted with one left out, on a page that names those there are."""

from __future__ import annotations

from pathlib import Path

import shipped

from symgen.laboratory.bench.tuning.passes import counted, page
from symgen.symbolic.passes import grouping

PAGE = Path(__file__).parents[2] / "docs/passes.md"


def test_a_pass_that_is_left_out_is_missed_where_it_works_and_is_back_afterwards() -> None:
    before = grouping.STEPS, grouping.BEGINNINGS
    counts = counted(shipped.model("double_pendulum"), ("inverse_dynamics",))
    assert before == (grouping.STEPS, grouping.BEGINNINGS)
    weights = {name: cost["inverse_dynamics"] for name, cost in counts.without.items()}
    felt = weights[grouping.COMMON_FACTORS], weights[grouping.SHARED_PARTS]
    assert min(felt) > counts.whole["inverse_dynamics"]
    assert list(weights) == list(grouping.PASSES)


def test_the_page_is_of_the_passes_there_are() -> None:
    row = counted(shipped.model("skate"), ("inverse_dynamics", "forward_dynamics"))
    rolling = counted(shipped.model("double_pendulum"), ("inverse_dynamics",))
    chain = counted(shipped.model("slider_crank"), ("inverse_dynamics",))
    made = [line for line in page([row, rolling, chain], [row]).splitlines() if line.startswith(("| ", "- **"))]
    kept = [line for line in PAGE.read_text(encoding="utf-8").splitlines() if line.startswith(("| ", "- **"))]
    assert [line.split(" | ")[0] for line in made] == [line.split(" | ")[0] for line in kept]
