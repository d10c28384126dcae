"""Verification compiles at -O1; what users build at higher levels has the same bits, vector code included."""

from __future__ import annotations

from collections.abc import Callable

import pytest
import shipped

from symgen.verify.certificate import Certificate
from symgen.verify.run import verify
from symgen.verify.running import compile as compiling
from symgen.verify.running.sources import generated_sources

pytestmark = pytest.mark.toolchain
NAME, STATES = "skate", 8


def verified(flags: tuple[str, ...], monkeypatch: pytest.MonkeyPatch) -> Certificate:
    monkeypatch.setattr(compiling, "FLAGS", flags)
    model, files = shipped.model(NAME), shipped.sources(NAME)
    c_sources, _ = generated_sources(model, files)
    kernels = shipped.programs(NAME)["float64"].kernels
    return verify(model, kernels, c_sources, None, STATES)


def test_every_level_gives_the_same_errors(monkeypatch: pytest.MonkeyPatch, tool: Callable[[str], str]) -> None:
    tool("cc")
    usual = compiling.FLAGS
    assert "-O1" in usual
    first = verified(usual, monkeypatch)
    assert first.passed
    assert {record.target for record in first.errors} >= {"C float64", "C float32 batch", "C float64 prepared"}
    for level in ("-O2", "-O3"):
        other = verified(tuple(level if flag == "-O1" else flag for flag in usual), monkeypatch)
        assert (other.errors, other.invariants) == (first.errors, first.invariants)
        assert other.failures == ()
