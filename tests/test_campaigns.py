"""Campaigns: a changed kernel, a changed campaign, a removed record are noticed, and a sample is run again."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from campaign_member import Member
from campaign_members import all_members, counted, figures
from campaigns import SAMPLED, inputs_hash, read_record, run_and_record, run_changed

ROOT = Path(__file__).resolve().parent.parent
COUNT = "open('runs.txt', 'a').write('{0} ')"


def member(name: str, **changed: Any) -> Member:
    def result(root: Path) -> str:
        return (root / "result.txt").read_text()

    command = ("python", "-c", COUNT.format(name))
    checksums = (f"generated/{name}/files.sha256",)
    made = Member("weighing", name, (command,), ("code",), ("scales",), result, checksums=checksums)
    return replace(made, **changed)


@pytest.fixture
def root(tmp_path: Path) -> Path:
    for name in ("a", "b"):
        (tmp_path / f"generated/{name}").mkdir(parents=True)
        (tmp_path / f"generated/{name}/files.sha256").write_text("1234  c/x.c\n")
    (tmp_path / "code").mkdir()
    (tmp_path / "code/weigh.py").write_text("1\n")
    (tmp_path / "tests").mkdir()
    (tmp_path / "result.txt").write_text("heavy")
    return tmp_path


def version(_: str) -> str:
    return "scales 1"


def ran(root: Path) -> list[str]:
    path = root / "runs.txt"
    names = sorted(path.read_text().split()) if path.exists() else []
    path.unlink(missing_ok=True)
    return names


NOT_SAMPLED = SAMPLED - 1
MARK = "campaign"


def test_what_was_recorded_is_not_run_again(root: Path) -> None:
    members = [member("a"), member("b")]
    assert run_changed(root, members, NOT_SAMPLED, version) == 0
    assert ran(root) == ["a", "b"]  # nothing is recorded yet
    assert run_and_record(root, members, version) == 0
    assert ran(root) == ["a", "b"]
    (root / "code/__pycache__").mkdir()
    (root / "code/__pycache__/weigh.pyc").write_bytes(b"made by Python")
    assert run_changed(root, members, NOT_SAMPLED, version) == 0
    assert ran(root) == []


def test_what_has_changed_is_run_and_recorded(root: Path) -> None:
    members = [member("a"), member("b")]
    run_and_record(root, members, version)
    ran(root)
    (root / "generated/b/files.sha256").write_text("1235  c/x.c\n")
    assert run_and_record(root, members, version, changed=True) == 0
    assert ran(root) == ["b"]
    assert run_changed(root, members, NOT_SAMPLED, version) == 0
    assert ran(root) == []
    assert run_and_record(root, members, version, changed=True) == 0
    assert ran(root) == []


def test_every_change_is_noticed(root: Path) -> None:
    members = [member("a"), member("b")]
    run_and_record(root, members, version)
    ran(root)

    (root / "generated/b/files.sha256").write_text("1235  c/x.c\n")  # one byte of a kernel
    assert run_changed(root, members, NOT_SAMPLED, version) == 0
    assert ran(root) == ["b"]
    (root / "generated/b/files.sha256").write_text("1234  c/x.c\n5678  report/x.pdf\n")  # no campaign reads it
    assert run_changed(root, members, NOT_SAMPLED, version) == 0
    assert ran(root) == []

    (root / "code/weigh.py").write_text("2\n")
    run_changed(root, members, NOT_SAMPLED, version)
    assert ran(root) == ["a", "b"]
    (root / "code/weigh.py").rename(root / "code/moved.py")
    (root / "code/moved.py").write_text("1\n")
    run_changed(root, members, NOT_SAMPLED, version)
    assert ran(root) == ["a", "b"]
    (root / "code/moved.py").rename(root / "code/weigh.py")

    run_changed(root, members, NOT_SAMPLED, lambda _: "scales 2")
    assert ran(root) == ["a", "b"]
    run_changed(root, [member("a", environment=(("STRIDE", "1"),)), member("b")], NOT_SAMPLED, version)
    assert ran(root) == ["a"]

    record = read_record(root)
    del record["weighing"]["a"]
    (root / "tests/campaigns.json").write_text(json.dumps(record))
    run_changed(root, members, NOT_SAMPLED, version)
    assert ran(root) == ["a"]
    (root / "tests/campaigns.json").unlink()
    run_changed(root, members, NOT_SAMPLED, version)
    assert ran(root) == ["a", "b"]


def test_the_sample_goes_round_and_must_give_the_same(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    members = [member("a"), member("b", alone=True)]
    run_and_record(root, members, version)
    ran(root)
    seen = []
    for count in range(100, 100 + SAMPLED):
        assert run_changed(root, members, count, version) == 0
        seen += ran(root)
    assert seen == ["a", "b"] or seen == ["b", "a"]
    (root / "result.txt").write_text("light")
    capsys.readouterr()
    assert run_changed(root, members, 0, version) == 1
    assert 'recorded: "heavy"\nnow: "light"' in capsys.readouterr().out


def test_a_failure_ends_in_1_and_is_not_recorded(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    broken = member("b", commands=(("python", "-c", "print('too light'); raise SystemExit(3)"),))
    assert run_and_record(root, [member("a"), broken], version) == 1
    assert list(read_record(root)["weighing"]) == ["a"]
    assert "too light" in capsys.readouterr().out
    assert run_changed(root, [member("a"), broken], NOT_SAMPLED, version) == 1


def test_each_model_is_in_the_campaigns_and_all_that_they_read_exists() -> None:
    members = all_members(ROOT)
    assert len({(one.campaign, one.name) for one in members}) == len(members)
    models = {path.stem for path in (ROOT / "models").glob("*.yaml")}
    for campaign in ("firmware", "proof"):
        assert models <= {one.name for one in members if one.campaign == campaign}
    assert models <= {one.name for one in members if one.campaign in ("stress", "mechanisms")}
    assert [path for one in members for path in one.files if not (ROOT / path).exists()] == []
    tests = ((path, path.relative_to(ROOT / "tests")) for path in (ROOT / "tests").rglob("test_*.py"))
    marks = re.compile(rf"mark\.{MARK}\b|\bsparing\(")
    marked = {f"tests/{there.parts[0]}" for path, there in tests if marks.search(path.read_text("utf-8"))}
    assert marked == {one.commands[0][-3] for one in members if one.campaign == "tests"}
    record = read_record(ROOT)
    known = {(campaign, name) for campaign, recorded in record.items() for name in recorded}
    assert known <= {(one.campaign, one.name) for one in members}, "run `make campaigns`"


def test_what_a_campaign_looks_at_is_in_its_hash() -> None:
    """The packages of Python, what its code imports, helpers of tests; and no more than that."""
    files = {(one.campaign, one.name): one.files for one in all_members(ROOT)}
    assert [name for name, paths in files.items() if "requirements.lock" not in paths] == []
    stress = {*files["stress", "skate"]}
    assert stress >= {"symgen/generation/runnable.py", "symgen/validity/descent.py", "symgen/paths/printed.py"}
    assert stress.isdisjoint({"symgen/symbolic/scalar.py", "symgen/methods/table.py", "symgen/report/compose.py"})
    assert "symgen/verify" in files["mechanisms", "five_bar"]
    assert not any(path.startswith("symgen/verify") for path in files["proof", "five_bar"])
    for folder, helper in (("backends", "handmade"), ("ir", "laws_harness"), ("growth", "linkages")):
        assert {"tests/conftest.py", f"tests/{helper}.py"} <= {*files["tests", folder]}
    assert {"tests/kernel_growth.py", "generated/delta/files.sha256"} <= {*files["tests", "test_generated"]}
    assert "tests/mechanisms/robots.lock" in files["zoo", "same_draws"]


def test_a_changed_package_makes_every_campaign_due(root: Path) -> None:
    (root / "packages.lock").write_text("casadi==3.6.7\n")
    locked = member("a", files=("packages.lock",))
    before = inputs_hash(root, locked, version)
    (root / "packages.lock").write_text("casadi==3.7.2\n")
    assert inputs_hash(root, locked, version) != before


def test_a_benchmark_keeps_what_repeats_from_run_to_run() -> None:
    def row(generator: str, form: str, chosen: bool, nanoseconds: float) -> dict[str, Any]:
        repeating = {"scalar": "float32", "instructions": 90.5, "operations": {"add": 3, "mul": 4}, "beyond": 0}
        return {"generator": generator, "form": form, "chosen": chosen, "nanoseconds": nanoseconds, **repeating}

    def measured(nanoseconds: float) -> dict[str, Any]:
        rows = [
            row("symgen", "minor, portable", True, nanoseconds),
            row("symgen", "minor, libm", True, nanoseconds),
            row("symgen", "kkt, portable", False, nanoseconds),
            row("CasADi", "native", False, nanoseconds),
        ]
        return {"comparisons": [{"quantity": "inverse_dynamics", "measured": rows}]}

    assert counted(measured(3.5)) == counted(measured(4.1)) == [["inverse_dynamics", "float32", 90.5, 7, 0]]


def test_figures_that_tests_note_are_kept(tmp_path: Path) -> None:
    noting = "def test_of_weights(record_property):\n    record_property('largest', '1.25')\n"
    (tmp_path / "test_weights.py").write_text(noting)
    command = (sys.executable, "-m", "pytest", "-q", "--junitxml=noted.xml", "-o", "junit_family=xunit1")
    subprocess.run(command, cwd=tmp_path, check=True, capture_output=True)
    assert figures(tmp_path / "noted.xml") == {"test_of_weights": {"largest": "1.25"}}
