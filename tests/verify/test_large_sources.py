"""Large sources are compiled as they stand, one after the other, and large modules are loaded function by function."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
import shipped

from symgen.verify.run import verify
from symgen.verify.running import compile as compiling
from symgen.verify.running import python_module
from symgen.verify.running.compile import Compilation, Compiler, CSource
from symgen.verify.running.sources import generated_sources

NAME, STATES = "skate", 8
SMALL = CSource("small", "int three(void);", '#include "small.h"\nint three(void) { return 3; }\n')
LARGE = CSource("large", "int three(void);", '#include "large.h"\nint three(void) { return 3; }\n' + "\n" * 2_000_000)


def test_only_what_is_large_is_not_optimised() -> None:
    gnu, other = Compiler(("gcc",), "gcc", gnu=True), Compiler(("clang",), "clang")
    assert "-O1" in gnu.flags(SMALL)
    assert not {"-O0", "--param"} & {*gnu.flags(SMALL)}
    assert {"-O0", "--param"} <= {*gnu.flags(LARGE)}
    assert "--param" not in other.flags(LARGE)
    assert gnu.flags(LARGE).index("-O0") > gnu.flags(LARGE).index("-O1")  # the last one counts


@pytest.mark.toolchain
def test_a_later_compiler_starts_when_it_is_asked(tool: Callable[[str], str], tmp_path: Path) -> None:
    tool("cc")
    compiler = compiling.find_compiler()
    assert compiler is not None
    waiting = Compilation(compiler, LARGE, tmp_path, later=True)
    waiting.cancel()
    assert not (tmp_path / "large.so").exists()
    assert waiting.library().three() == 3


@pytest.mark.campaign
@pytest.mark.toolchain
def test_the_certificate_is_the_same(monkeypatch: pytest.MonkeyPatch, tool: Callable[[str], str]) -> None:
    tool("cc")
    model, files = shipped.model(NAME), shipped.sources(NAME)
    kernels = shipped.programs(NAME)["float64"].kernels
    first = verify(model, kernels, *generated_sources(model, files), STATES)
    monkeypatch.setattr(compiling, "LARGE", 100)
    monkeypatch.setattr(python_module, "LARGE_MODULE", 100)
    assert verify(model, kernels, *generated_sources(model, files), STATES) == first
    assert first.passed
    assert "Python float64" in first.targets
