"""`symgen bench` from the command line: files, table, missing tools."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from shipped import ROOT

from symgen.cli.main import main
from symgen.laboratory.bench import batch, build, callgrind, command, run
from symgen.laboratory.bench.candidate import CCandidate, CUnit
from symgen.laboratory.bench.peers import roster
from symgen.laboratory.bench.peers.engines.casadi_engine import CasadiEngine
from symgen.laboratory.bench.reporting import charts

SKATE = str(ROOT / "models" / "skate.yaml")


@pytest.fixture(autouse=True)
def few_states(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(batch, "STREAMED", 128)
    monkeypatch.setattr(batch, "CACHED", 64)
    monkeypatch.setattr(batch, "PASSES", 1)


@pytest.fixture
def gcc(tool: Callable[[str], str]) -> str:
    return tool("gcc")


@pytest.mark.toolchain
@pytest.mark.slow
@pytest.mark.usefixtures("gcc")
@pytest.mark.bench
def test_files_and_table(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(run, "PASSES", 3)
    monkeypatch.setattr(run, "MAIN", ("inverse_dynamics",))
    monkeypatch.setattr(run, "MATRICES", ("nullspace_projector",))
    monkeypatch.setattr(run, "SCALARS", ("float64",))
    monkeypatch.setattr(charts, "SCALARS", ("float64",))
    monkeypatch.setattr(roster, "_engines", lambda: [CasadiEngine])
    assert main(["bench", SKATE, "--states", "8", "--out", str(tmp_path)]) == 0
    printed = capsys.readouterr()
    assert "CasADi native" in printed.out
    assert (tmp_path / "skate" / "bench.svg").read_text(encoding="utf-8").startswith("<?xml")
    data = json.loads((tmp_path / "skate" / "bench.json").read_text(encoding="utf-8"))
    comparison, projector = data["comparisons"]
    assert comparison["states"] == 8
    assert {row["generator"] for row in projector["measured"]} == {"symgen", "CasADi SSA"}
    assert projector["many_states"] == []
    rows = {(row["generator"], row["form"], row["scalar"]): row for row in comparison["measured"]}
    assert {row["form"] for row in comparison["many_states"]} > {"batch", "compile()"}
    chosen = next(row for row in comparison["measured"] if row["chosen"] and row["scalar"] == "float64")
    native = rows["CasADi", "native", "float64"]
    assert chosen["errors"]["largest"] < 1e-12
    assert chosen["operations"]["sincos"] == 1
    if callgrind.find_valgrind():
        assert chosen["instructions"] < native["instructions"] < 400
    else:
        assert native["instructions"] is None
        assert "valgrind" in printed.err


def test_without_gcc_it_is_wrong_use(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(run, "find_gcc", lambda: None)
    assert main(["bench", SKATE, "--out", str(tmp_path)]) == 2
    assert "no gcc" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


@pytest.mark.bench
@pytest.mark.toolchain
@pytest.mark.usefixtures("gcc")
def test_without_valgrind_instructions_are_left_out(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(run, "find_valgrind", lambda: None)
    monkeypatch.setattr(run, "PASSES", 3)
    monkeypatch.setattr(run, "MAIN", ("multipliers",))
    monkeypatch.setattr(run, "MATRICES", ())
    monkeypatch.setattr(build, "FLAGS", ("-O0", *build.FLAGS[1:]))
    monkeypatch.setattr(command, "time_against_error", lambda _: "")
    assert main(["bench", SKATE, "--states", "8", "--quiet", "--out", str(tmp_path)]) == 0
    assert "no valgrind" in capsys.readouterr().err
    data = json.loads((tmp_path / "skate" / "bench.json").read_text(encoding="utf-8"))
    assert all(row["instructions"] is None for row in data["comparisons"][0]["measured"])


@pytest.mark.toolchain
@pytest.mark.usefixtures("gcc")
def test_a_candidate_that_does_not_compile_is_named(tmp_path: Path) -> None:
    broken = CCandidate("SymPy", "lean", "float64", "entry", (CUnit("int entry(void) { return x; }\n"),), ("entry",))
    with pytest.raises(build.BuildError, match="SymPy lean"):
        build.compile_candidate(tmp_path / "entry", broken)
