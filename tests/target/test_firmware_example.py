"""The firmware of examples/ runs on an emulated Cortex-M4F; part of `make firmware`."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from shipped import ROOT

from symgen.laboratory.target.build import Workshop
from symgen.laboratory.target.cores import BY_NAME
from symgen.laboratory.target.emulator import addresses, build_counter, count_calls

EXAMPLE = ROOT / "examples" / "rapkm_firmware"


@pytest.fixture(scope="module")
def built(tool: Callable[[str], str], tmp_path_factory: pytest.TempPathFactory) -> Path:
    for name in ("make", "arm-none-eabi-gcc", "qemu-system-arm"):
        tool(name)
    folder = tmp_path_factory.mktemp("example")
    _make(folder, "all")
    return folder


def _make(folder: Path, goal: str) -> str:
    environment = {k: v for k, v in os.environ.items() if k not in ("MAKEFLAGS", "MAKELEVEL", "MFLAGS")}
    symgen = f"SYMGEN={sys.executable} -m symgen"
    command = ["make", "-s", "-C", str(EXAMPLE), symgen, f"BUILD={folder}", goal]
    process = subprocess.run(command, capture_output=True, text=True, env=environment, check=False)
    assert process.returncode == 0, process.stdout + process.stderr
    return process.stdout


@pytest.mark.firmware
def test_both_controllers_track_the_circle(built: Path) -> None:
    printed = _make(built, "run")
    assert printed.count("passed") == 2
    assert "failed" not in printed
    errors = [float(figure) for figure in re.findall(r"tracking error ([\d.]+) um", printed)]
    assert len(errors) == 2
    assert all(0 < error < 1000 for error in errors)
    # a lost measurement is bridged; limits are kept by giving up preload, or else by scaling: all paths are taken
    assert [int(figure) > 0 for figure in re.findall(r"limited in (\d+) steps", printed)] == [False, True]
    assert re.findall(r"largest torque ([\d.]+) N m", printed) == ["1.500", "1.500"]
    assert re.findall(r"held in (\d+) steps", printed) == ["5", "5"]
    assert "symmetric part" in printed


@pytest.mark.firmware
def test_the_firmware_counts_the_instructions_that_the_emulator_executes(built: Path) -> None:
    printed = _make(built, "run")
    printed_counts = [int(figure) for figure in re.findall(r"worst step (\d+) instructions", printed)]
    core = BY_NAME["cortex-m4f"]
    counter = build_counter(built)
    for worst, name in zip(printed_counts, ("computed_torque", "augmented_pd"), strict=True):
        image = built / f"{name}.elf"
        functions = addresses(Workshop(built, core), image, ["control_step"])
        counts = count_calls(core, image, counter, functions)["control_step"]
        assert len(counts) == 1200
        assert abs(max(counts) - worst) <= 0.02 * worst
