"""How runs are limited and judged, and how failing draws become small."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import pytest

from symgen.laboratory.zoo import run as running
from symgen.laboratory.zoo.cases import case_of, read_case
from symgen.laboratory.zoo.draws.describe import Description, Terms
from symgen.laboratory.zoo.draws.families import draw
from symgen.laboratory.zoo.run import CommandRun, run_command
from symgen.laboratory.zoo.shrink import frozen, shrink, substituted
from symgen.laboratory.zoo.verdict import NOTICED, REFUSED, VERIFIED, DrawVerdict, verdict_of

MISTAKE = """zoo.yaml:12:5: `a` of something in m
   12 | x: exp(a)
      |    ^^^
  remedy: divide by a length
"""
LEFT_OUT = """zoo.yaml:3:1: notice: `a` cannot move
zoo.yaml: energy is left out in float64 and float32: verification rejects every method
  factored: error 30 times
  remedy: give narrower `ranges`
"""
UNPLACED = "message without a place or remedy"
WITHOUT_REMEDY = MISTAKE.rpartition("  remedy")[0]
UNTRUE = MISTAKE.replace("`a` of something in m", "no configuration was found")
WITHHELD = "zoo.yaml: verification failed, nothing is written\n  C float64, G: error 20\n"


@pytest.mark.parametrize(
    ("run", "ending", "kind"),
    [
        (CommandRun(0, "", "zoo: reading\n", 1, 1), VERIFIED, ""),
        (CommandRun(0, "", "zoo.yaml: notice: one thing\n", 1, 1), NOTICED, ""),
        (CommandRun(1, "", MISTAKE, 1, 1), REFUSED, ""),
        (CommandRun(1, "", MISTAKE.replace(".yaml", ".urdf"), 1, 1), REFUSED, ""),
        (CommandRun(1, "", "zoo.yaml: no\n", 1, 1), "failed", UNPLACED),
        (CommandRun(1, "", WITHOUT_REMEDY, 1, 1), "failed", UNPLACED),
        (CommandRun(1, "", UNTRUE, 1, 1), "failed", "refused without reason"),
        (CommandRun(2, "", "symgen: internal error: x\n", 1, 1), "failed", "internal error"),
        (CommandRun(1, "", WITHHELD, 1, 1), "failed", "verification"),
        (CommandRun(1, "", LEFT_OUT, 1, 1), "failed", "left out"),
        (CommandRun(-9, "", "", 61, 1, "time"), "failed", "time"),
        (CommandRun(-11, "", "", 1, 1), "failed", "signal"),
    ],
)  # fmt: skip
def test_endings(run: CommandRun, ending: str, kind: str) -> None:
    verdict = verdict_of(run)
    assert (verdict.ending, verdict.kind) == (ending, kind)


def test_a_signature_knows_the_place_and_no_numbers() -> None:
    text = """Traceback (most recent call last):
  File "/here/symgen/pipeline.py", line 4, in generate
  File "/here/symgen/symbolic/evaluate.py", line 40, in run
KeyError: 'a_1 absolute'
symgen: internal error: this is a fault of symgen, not of the model.
"""
    assert verdict_of(CommandRun(2, "", text, 1, 1)).signature == "KeyError: `.` at run in symbolic/evaluate.py"


@pytest.fixture
def instead(monkeypatch: pytest.MonkeyPatch, tmp_path: Path):
    """Runs a script in place of the command."""

    def use(script: str) -> Path:
        program = tmp_path / "program.py"
        program.write_text(script)
        starter = tmp_path / "starter.sh"
        starter.write_text(f"#!/bin/sh\nexec {sys.executable} {program}\n")
        starter.chmod(0o755)
        monkeypatch.setattr(running.sys, "executable", str(starter))
        return tmp_path / "zoo.yaml"

    return use


@pytest.mark.campaign
def test_a_run_without_end_is_ended_with_its_children(instead, tmp_path: Path) -> None:
    child = "import subprocess, sys\nsubprocess.run([sys.executable, '-c', 'while True: pass'])\n"
    run = run_command(instead(child), tmp_path / "out", cpu=1)
    assert run.ended == "time"
    assert 1 <= run.cpu < 3


def test_a_run_that_takes_too_much_memory_is_ended(instead, tmp_path: Path) -> None:
    hungry = "import time\nblock = bytearray(150_000_000)\ntime.sleep(30)\n"
    run = run_command(instead(hungry), tmp_path / "out", megabytes=100)
    assert run.ended == "memory"
    assert run.megabytes > 100


@pytest.mark.campaign
def test_memory_before_a_fork_counts_once(instead, tmp_path: Path) -> None:
    forked = "import os, time\nblock = bytearray(b'1') * 60_000_000\nos.fork()\ntime.sleep(1)\n"
    run = run_command(instead(forked), tmp_path / "out", megabytes=100)
    assert run.ended == ""
    assert 50 < run.megabytes < 100


def test_shrinking_keeps_the_ending_and_little_else() -> None:
    description = next(
        each for each in (draw(4, k, "planar_energies") for k in range(100)) if len(each.blocks.get("inputs", ())) > 3
    )
    wanted = list(description.blocks["inputs"])[2]
    small = shrink(description, lambda candidate: wanted in candidate.blocks.get("inputs", {}), most=400)
    assert list(small.blocks["inputs"]) == [wanted]
    assert len(small.text) < len(description.text) / 2
    assert "constraints" not in small.blocks


def test_a_coordinate_that_is_frozen_leaves_every_text() -> None:
    blocks = {
        "model": "zoo",
        "coordinates": {"a": {}, "b": {}},
        "kinetic_energy": Terms(("a_dot**2", "ab*b_dot*a_dot", "cos(a)*b_dot**2")),
        "parameters": {"ab": "2"},
        "inputs": {"u": {"acts_on": {"a": "1"}}, "v": {"acts_on": {"a": "1", "b": "a"}}},
        "configuration": {"a": "-0.5", "b": "1"},
    }
    small = frozen(Description("", blocks, {"a": -0.5, "b": 1.0}), "a")
    assert small.blocks["kinetic_energy"].terms == ("0**2", "ab*b_dot*0", "cos((-0.5))*b_dot**2")
    assert small.blocks["inputs"] == {"v": {"acts_on": {"b": "(-0.5)"}}}
    assert small.blocks["configuration"] == {"b": "1"}
    assert small.start == {"b": 1.0}


def test_names_are_replaced_as_words() -> None:
    assert substituted("a + a_1 + a.x + b*a", "a", "-2") == "(-2) + a_1 + a.x + b*(-2)"


def test_a_stored_case_is_read_as_it_was(tmp_path: Path) -> None:
    verdict = DrawVerdict("failed", "internal error", "KeyError: `.` at run")
    alone = replace(draw(5, 1, "bennett"), options=("--scalar", "float32"))
    for description in (replace(alone, options=()), alone):
        case = case_of(description, verdict)
        (tmp_path / "case.yaml").write_text(case.text)
        assert case.options == description.options
        assert read_case(tmp_path / "case.yaml") == case
