"""Verification end to end on a small model: what it accepts, what it rejects, and what it says."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from dataclasses import replace

import pytest
import shipped
from textbook_mechanisms import build

from symgen.backends.c.plain import emit_c
from symgen.backends.python.module import emit_python
from symgen.ir.kernel import Argument, Kernel
from symgen.lowering.schedule import schedule
from symgen.quantities.select import derive_quantities
from symgen.verify import run
from symgen.verify.certificate import Certificate
from symgen.verify.run import verify
from symgen.verify.running.compile import find_compiler
from symgen.verify.running.sources import generated_sources

QUANTITIES = ("nullspace_projector", "constraint_jacobian", "inverse_dynamics", "forward_dynamics")
STATES = 8
NAME = "skate"
FORCE = [Kernel("potential_force", (Argument("q", 1),), (), (), (), (1,))]


def certificate(edit: Callable[[str], str] = str, python: Callable[[str], str] = str, c: bool = True) -> Certificate:
    """Verify four quantities of the skate after an edit of the C source or of the Python source."""
    c_sources, python_source = generated_sources(shipped.model(NAME), shipped.sources(NAME))
    assert python_source is not None
    kernels = [kernel for kernel in shipped.programs(NAME)["float64"].kernels if kernel.name in QUANTITIES]
    edited = {scalar: replace(source, source=edit(source.source)) for scalar, source in c_sources.items()}
    return verify(shipped.model(NAME), kernels, edited if c else {}, python(python_source), STATES)


@pytest.fixture(scope="module")
def good(tool: Callable[[str], str]) -> Certificate:
    tool("cc")
    return certificate()


@pytest.mark.toolchain
def test_correct_files_pass_on_every_target(good: Certificate) -> None:
    assert good.failures == ()
    assert good.passed
    kinds = ("", " batch", " prepared", " sines given")
    c = tuple(f"C {scalar}{kind}" for scalar in ("float64", "float32") for kind in kinds)
    assert good.targets == (*c, "Python float64")
    assert {record.quantity for record in good.errors} == set(QUANTITIES)
    many = [record.quantity for record in good.errors if record.target == "C float64 batch"]
    assert many == ["inverse_dynamics", "forward_dynamics"]
    assert all(record.states == STATES and 0 <= record.median <= record.largest <= 16 for record in good.errors)
    assert 0 < good.worst("C float32").largest_relative < 1e-5


@pytest.mark.toolchain
def test_kernels_that_are_given_sines_are_verified(tool: Callable[[str], str]) -> None:
    tool("cc")
    c_sources, _ = generated_sources(shipped.model(NAME), shipped.sources(NAME))
    kernels = [kernel for kernel in shipped.programs(NAME)["float64"].kernels if kernel.name in QUANTITIES]
    swapped = {
        scalar: replace(
            source,
            companions=tuple((name, text.replace("= sc->sin_", "= -sc->sin_")) for name, text in source.companions),
        )
        for scalar, source in c_sources.items()
    }
    failures = verify(shipped.model(NAME), kernels, swapped, None, STATES).failures
    assert failures
    assert all("sines given" in failure for failure in failures)


@pytest.mark.toolchain
def test_certificate_is_json_with_versions_hashes_laws_and_conditions(good: Certificate) -> None:
    data = json.loads(json.dumps(good.to_json(), allow_nan=False))
    assert data["passed"] is True
    assert {"symgen", "python", "compiler"} <= data["versions"].keys()
    assert {"model", "c/skate.c", "c/skate_f.h", "python/skate.py"} <= data["hashes"].keys()
    assert all(re.fullmatch("[0-9a-f]{64}", value) for value in data["hashes"].values())
    laws = {record["name"] for record in data["invariants"]}
    assert {"N N = N", "N' = N", "B N = 0", "power balance"} <= laws
    assert len(data["conditions"]) == 2
    assert data["ranks"] == {"constraints": 1, "geometric constraints": 0, "degree of actuation": 2}


def flipped(name: str) -> Callable[[str], str]:
    """Flips the first sum after the head of a function."""

    def edit(source: str) -> str:
        head = re.search(rf"_{name}(_f)?\([^;{{]*{{", source)
        assert head is not None
        tail = re.sub(r"(\w) \+ (\w)", r"\1 - \2", source[head.end() :], count=1)
        return source[: head.end()] + tail

    return edit


@pytest.mark.toolchain
def test_one_wrong_sign_in_c_is_found_in_both_types(good: Certificate) -> None:
    assert good.passed
    failed = certificate(flipped("inverse_dynamics"))
    assert not failed.passed
    text = "\n".join(failed.failures)
    assert "C float64, inverse_dynamics: error" in text
    assert "C float32, inverse_dynamics: error" in text
    assert "Python" not in text


def test_one_wrong_sign_in_python_is_found_without_a_compiler(monkeypatch: pytest.MonkeyPatch) -> None:
    def edit(source: str) -> str:
        head = source.index("def inverse_dynamics(")
        return source[:head] + re.sub(r"(\w) \+ (\w)", r"\1 - \2", source[head:], count=1)

    monkeypatch.setattr(run, "find_compiler", lambda: None)
    failed = certificate(python=edit)
    assert [note for note in failed.notes if "no C compiler was found" in note]
    assert any(failure.startswith("Python float64, inverse_dynamics: error") for failure in failed.failures)
    assert failed.targets == ("Python float64",)


@pytest.mark.toolchain
def test_a_refused_regular_state_is_a_failure(tool: Callable[[str], str]) -> None:
    tool("cc")

    def edit(source: str) -> str:
        return re.sub(r"(skate_nullspace_projector(_f)?\([^;{]*\{)", r"\1 return SKATE_CONSTRAINT_RANK;", source)

    failed = certificate(edit)
    assert any(
        re.match(r"C float64, nullspace_projector: status 2 at 8 of 8 regular states", f) for f in failed.failures
    )


@pytest.mark.toolchain
def test_c_that_does_not_compile_is_a_failure_with_the_compilers_words(tool: Callable[[str], str]) -> None:
    tool("cc")
    failed = certificate(lambda source: source + "\nnonsense")
    assert any("C float64 does not compile" in failure and "nonsense" in failure for failure in failed.failures)
    assert failed.targets == ("Python float64",)


def test_without_a_compiler_on_the_machine_none_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")
    monkeypatch.delenv("CC", raising=False)
    assert find_compiler() is None


def test_constraints_that_nothing_satisfies_are_said_so() -> None:
    model = build("nowhere", "x y", "x_dot**2/2 + y_dot**2/2", geometric=("x**2 + y**2 + 1",))
    failed = verify(model, [], {}, "")
    assert not failed.passed
    assert re.search(r"no configuration .* was found; give a start under `configuration`", failed.failures[0])


def test_too_few_states_are_said_so_and_are_a_failure() -> None:
    failed = verify(build("bad", "x", "x_dot**2", "sqrt(-1 - x**2)"), FORCE, {}, "")
    assert not failed.passed
    assert "only 0 regular configurations" in failed.failures[0]


@pytest.mark.toolchain
def test_a_model_without_inputs_parameters_and_constraints_passes(tool: Callable[[str], str]) -> None:
    tool("cc")
    model = build("bare", "x y", "x_dot**2 + (2 + cos(x))*y_dot**2", "x*y")
    derivations = derive_quantities(model, ("all",))
    programs = schedule(derivations.mechanics, derivations.quantities, shipped.SCALARS)
    files = emit_python(model, programs["float64"])
    for program in programs.values():
        files |= emit_c(model, program)
    verification = verify(model, programs["float64"].kernels, *generated_sources(model, files), STATES)
    assert verification.failures == ()
    assert {"forward_dynamics", "energy"} <= {record.quantity for record in verification.errors}
