"""Every stored case ends as it must: found by the zoo, made small, mended since."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from symgen.laboratory.zoo.cases import read_case
from symgen.laboratory.zoo.run import run_command
from symgen.laboratory.zoo.verdict import NOTICED, VERIFIED, verdict_of
from symgen.laboratory.zoo.witness.witness import Witness

CASES = sorted((Path(__file__).parent / "cases").glob("*.yaml"))
# Each is a whole run and its witness; this one takes the least.
FIRST = "parameter_named_memcpy"


@pytest.mark.slow
@pytest.mark.parametrize(
    "path",
    [pytest.param(path, id=path.stem, marks=() if path.stem == FIRST else pytest.mark.campaign) for path in CASES],
)
def test_a_case_ends_as_it_must(path: Path, tmp_path: Path, tool: Callable[[str], str]) -> None:
    tool("gcc")
    case = read_case(path)
    model = tmp_path / "zoo.yaml"
    model.write_text(case.model)
    run = run_command(model, tmp_path / "out", case.options)
    ending = verdict_of(run)
    assert case.expected == {NOTICED: VERIFIED}.get(ending.ending, ending.ending), f"{ending}\n{run.err}"
    if ending.ending in (VERIFIED, NOTICED):
        checked = Witness(case.model, case.start).check(tmp_path / "out" / "zoo", count=6)
        assert checked.findings == ()
