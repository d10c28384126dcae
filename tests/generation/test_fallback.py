"""What verification rejects takes another method, or is left out alone: wrong ones on purpose, and real ones."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from shipped import ROOT

from symgen.backends.c import backend
from symgen.cli import main as cli
from symgen.diagnostics import SymgenBug
from symgen.generation.acceptance import fallback, tried_methods
from symgen.generation.acceptance.fallback import NARROW
from symgen.generation.results import Options, Result
from symgen.ir import kernel as kernels
from symgen.ir.kernel import Status
from symgen.linear_algebra.guards import Guard
from symgen.methods.forward_dynamics.motion import Motion
from symgen.methods.method import Candidate
from symgen.methods.quantity import Quantity
from symgen.methods.selection import Methods
from symgen.pipeline import generate
from symgen.quantities import alternatives, candidates, everything
from symgen.quantities.alternatives import Alternative
from symgen.symbolic.graph import Graph
from symgen.symbolic.scalar import Scalar
from symgen.verify.certificate import LeftOut
from symgen.verify.margins import far_parameters
from symgen.verify.reference.reference import State
from symgen.verify.running import compile as compiling
from symgen.verify.sampling import searched
from symgen.verify.sampling.searched import JUDGED
from symgen.verify.sampling.settling import Settling
from symgen.verify.sampling.states import Sample

# A pin on a crank moves a slider in a bent slot: one row, one degree of freedom, and nothing to be substituted.
YOKE = """
model: yoke
coordinates:
  a: {unit: rad, description: crank}
  x: {unit: m, description: slider}
parameters:
  r: {value: 0.3, unit: m, range: [0.2, 0.4]}
  J: {value: 0.02, unit: kg*m**2}
  m: {value: 1.5, unit: kg, range: [1, 2]}
  k: {value: 40, unit: N/m}
  b: {value: 2, unit: m, description: how straight the slot is}
kinetic_energy: J/2*a_dot**2 + m/2*x_dot**2
potential_energy: k/2*x**2
constraints:
  geometric: {slot: x + x**3/b**2 - r*cos(a)}
inputs:
  torque: {unit: N*m, acts_on: {a: 1}}
configuration: {a: 0.8, x: 0.2}
outputs: [forward_dynamics, multipliers]
"""
OFF = 1 + Fraction(1, 2**16)  # beyond the tolerance in either scalar type
FAST = Options(parts=("c", "python"), states=8)
QUICKLY = ("--only", "c,python", "--states", "8")


@pytest.fixture
def whole(tmp_path: Path) -> Path:
    """The file, of which every variant of its C is made."""
    path = tmp_path / "yoke.yaml"
    path.write_text(YOKE, encoding="utf-8")
    return path


@pytest.fixture
def yoke(whole: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The file, of which the C for one state is made: the variants pass and fail with it (test_batch_verification)."""
    monkeypatch.setattr(backend, "BACKEND", replace(backend.BACKEND, variants=backend.BACKEND.variants[:1]))
    return whole


@pytest.fixture(autouse=True)
def compiler(tool: Callable[[str], str], monkeypatch: pytest.MonkeyPatch) -> None:
    """Bits are the same at every level (test_levels), and a run compiles several times."""
    tool("cc")
    monkeypatch.setattr(compiling, "FLAGS", (*compiling.FLAGS, *compiling.PLAIN))


@pytest.fixture(scope="module")
def usual(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """What derivation.json tells where nothing is spoilt."""
    path = tmp_path_factory.mktemp("usual") / "yoke.yaml"
    path.write_text(YOKE, encoding="utf-8")
    return derived(made(path))


def made(path: Path, options: Options = FAST) -> Result:
    return generate(path, options, lambda _: None)


def derived(result: Result) -> Any:
    return json.loads(result.files["derivation.json"])


def off(values: Sequence[Scalar]) -> tuple[Scalar, ...]:
    return tuple(value * value.graph.const(OFF) for value in values)


def spoil_choice(
    monkeypatch: pytest.MonkeyPatch,
    spoilt: Callable[[Motion], Motion],
    quantity: str = "multipliers",
) -> None:
    """λ of every method that selection may take by itself."""
    derived_from = candidates.derived_from

    def worse(entry: Any, along: Any, outputs: Any, guards: Any) -> Quantity:
        if entry.name != quantity:
            return derived_from(entry, along, outputs, guards)
        motion = spoilt(Motion((), outputs, guards(along)))
        return derived_from(entry, along, motion.multipliers, lambda _: motion.guards)

    monkeypatch.setattr(candidates, "derived_from", worse)


def wrong(motion: Motion) -> Motion:
    """λ that is another function."""
    return replace(motion, multipliers=off(motion.multipliers))


def cancelling(motion: Motion) -> Motion:
    """λ that loses digits."""
    return replace(motion, multipliers=tuple(lossy(value, Fraction(2**21)) for value in motion.multipliers))


def narrow(motion: Motion) -> Motion:
    """λ that takes a good half of what is allowed, where the crank turns little."""
    return replace(motion, multipliers=tuple(lossy(value, Fraction(4)) for value in motion.multipliers))


def edgy(motion: Motion) -> Motion:
    """λ that loses digits where the crank is nearly turned around, and little elsewhere."""
    return replace(motion, multipliers=tuple(lossy(value, Fraction(1, 4)) for value in motion.multipliers))


def edging(motion: Motion) -> Motion:
    """The same, less: a good half of what is allowed is lost there."""
    return replace(motion, multipliers=tuple(lossy(value, Fraction(1, 8)) for value in motion.multipliers))


def losing_digits(motion: Motion) -> Motion:
    """λ that loses digits in roots, products and sums."""
    return losing(motion, 2**12)


def losing(motion: Motion, factor: int) -> Motion:
    """λ times 1 + factor (sqrt(3 r)^2 - 3 r)."""
    graph = motion.multipliers[0].graph
    r = graph.const(3) * graph.symbol("r")
    root = graph.raw("sqrt", (r,))
    nothing = graph.raw("sub", (graph.raw("mul", (root, root)), r))
    share = graph.raw("mul", (graph.const(factor), nothing))
    return replace(
        motion,
        multipliers=tuple(graph.raw("add", (value, graph.raw("mul", (value, share)))) for value in motion.multipliers),
    )


def lossy(value: Scalar, factor: Fraction) -> Scalar:
    """The value times 1 + factor (cosh^2 - sinh^2 - 1)."""
    graph = value.graph
    one = graph.const(Fraction(-1))
    cosh, sinh = (graph.raw(name, (graph.symbol("a"),), None) for name in ("cosh", "sinh"))
    squares = graph.raw("mul", (cosh, cosh), None), graph.raw("mul", (sinh, sinh), None)
    nothing = graph.raw("add", (graph.raw("add", (squares[0], one), None), graph.raw("neg", squares[1:], None)), None)
    share = graph.raw("mul", (graph.const(factor), nothing), None)
    return graph.raw("add", (value, graph.raw("mul", (value, share), None)), None)


def refused(graph: Graph, size: Fraction) -> Guard:
    """A denominator that is small beside its scale."""
    return Guard(Status.MASS_RANK, graph.symbol("J") * graph.const(size), 1, scale=graph.symbol("m"))


def refusing(motion: Motion) -> Motion:
    """λ with a denominator that every state takes for zero."""
    tiny = refused(motion.multipliers[0].graph, Fraction(1, 2**80))
    return replace(motion, guards=(*motion.guards, tiny))


def refusing_float32(motion: Motion) -> Motion:
    """λ with a denominator that is beyond float32."""
    small = refused(motion.multipliers[0].graph, Fraction(1, 2**20))
    return replace(motion, guards=(*motion.guards, small))


def spoil_named(monkeypatch: pytest.MonkeyPatch, spoilt: Callable[[Motion], Motion]) -> None:
    """λ of every method that can be asked for by name."""
    candidate = Methods.candidate

    def worse(methods: Methods, quantity: str, name: str) -> Candidate | str:
        original = candidate(methods, quantity, name)
        if quantity != "multipliers" or isinstance(original, str):
            return original
        motion = spoilt(Motion((), original.derived.outputs, original.derived.guards))
        return replace(original, derived=replace(original.derived, outputs=motion.multipliers, guards=motion.guards))

    monkeypatch.setattr(Methods, "candidate", worse)


@pytest.mark.parametrize(
    ("spoilt", "why"),
    [
        (cancelling, "error .* is allowed"),
        (refusing, "status 5 at 8 of 8"),
        pytest.param(refusing_float32, r"status 5 at 8 of 8 .*\(float32\)", marks=pytest.mark.campaign),
    ],
)
def test_what_is_rejected_takes_the_next_method(
    yoke: Path, usual: Any, monkeypatch: pytest.MonkeyPatch, spoilt: Callable[[Motion], Motion], why: str
) -> None:
    assert "rejected" not in usual
    spoil_choice(monkeypatch, spoilt)
    result = made(yoke)
    assert result.failures == ()
    assert result.left_out == ()
    rejected, *_ = derived(result)["rejected"]
    assert rejected["quantity"] == "multipliers"
    assert re.search(why, rejected["why"])
    taken = derived(result)["kernels"]["multipliers"]["method"]
    assert derived(result)["method_of_multipliers"]["name"] == taken
    assert any(n.message.startswith(f"multipliers takes {taken}: verification speaks against") for n in result.notices)
    kernels, before = derived(result)["kernels"], usual["kernels"]
    assert all(kernels[name] == before[name] for name in before if name != "multipliers")
    assert result.certificate is not None
    assert result.certificate["passed"]
    largest = [e["largest"] for e in result.certificate["errors"] if e["quantity"] == "multipliers"]
    assert largest
    assert max(largest) <= 16


def test_wrong_algebra_is_an_internal_error_that_names_the_method(yoke: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with monkeypatch.context() as spoilt:
        spoil_choice(spoilt, wrong)
        with pytest.raises(SymgenBug, match=r"multipliers by \w+.*: it differs from the reference by \S+ at state"):
            made(yoke)
    # so is that of a method which another one replaces
    spoil_choice(monkeypatch, cancelling)
    spoil_named(monkeypatch, wrong)
    with pytest.raises(SymgenBug, match=r"multipliers by \w+: it differs from the reference"):
        made(yoke)


@pytest.mark.campaign
def test_what_passes_narrowly_takes_one_with_half_of_its_error(yoke: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    yoke.write_text(YOKE + "ranges: {a: [0.7, 1]}\n", encoding="utf-8")
    spoil_choice(monkeypatch, narrow)
    result = made(yoke)
    (rejected,) = derived(result)["rejected"]
    assert "leaves no margin" in rejected["why"]
    assert result.certificate is not None
    assert result.certificate["passed"]
    assert max(e["largest"] for e in result.certificate["errors"] if e["quantity"] == "multipliers") <= 8
    # no other method is better: it stays
    spoil_named(monkeypatch, narrow)
    result = made(yoke)
    assert "rejected" not in derived(result)
    assert result.left_out == ()
    assert derived(result)["kernels"]["multipliers"]["method"] == "minor"
    assert result.certificate is not None
    assert result.certificate["passed"]


@pytest.mark.campaign
def test_a_loss_that_no_state_of_the_verification_meets_is_searched_for(
    yoke: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    spoil_choice(monkeypatch, edgy)
    result = made(yoke)
    (rejected,) = derived(result)["rejected"]
    assert re.fullmatch(r"error \S+ times d \+ eps \|y\*\| at a state searched for, .*", rejected["why"])
    assert result.left_out == ()
    # no method is better: each is tried with its errors, and none is taken that is wrong where it was looked
    spoil_named(monkeypatch, edgy)
    result = made(yoke)
    assert all("searched for" in one["why"] for one in derived(result)["rejected"])
    wide = derived(result)["kernels"].get("multipliers", {}).get("twice_the_digits")
    assert wide or [one.quantity for one in result.left_out] == ["multipliers"]
    assert made(yoke).files["derivation.json"] == result.files["derivation.json"]


def test_the_certificate_says_where_fewer_states_are_looked_at(yoke: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As of long kernels, where all of them would take minutes."""
    monkeypatch.setattr(searched, "NUMBERS", 10_000)
    monkeypatch.setattr(far_parameters, "MOST", 20_000)
    certificate = made(yoke).certificate
    assert certificate is not None
    by_search = {(one["quantity"], one["looked_for"]): one for one in certificate["searches"]}
    for looked_for in ("worst states", "bounds of parameters"):
        search = by_search["multipliers", looked_for]
        assert 0 < search["states"] < search["in_full"]


@pytest.mark.campaign
def test_a_long_alternative_has_its_numbers_grouped_once_its_worst_states_speak_for_it(
    yoke: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(alternatives, "LONG_ALTERNATIVE", 0)
    monkeypatch.setattr(tried_methods, "WIDENED", 0)
    regrouped: list[str] = []

    def noted(one: Alternative) -> Alternative:
        regrouped.append(one.choice.title)
        return alternatives.grouped(one)

    monkeypatch.setattr(fallback, "grouped", noted)
    spoil_choice(monkeypatch, edgy)
    result = made(yoke)
    assert result.left_out == ()
    assert regrouped == [derived(result)["kernels"]["multipliers"]["method"]]
    # every method passes at the states of the verification, and none where it is worst
    regrouped.clear()
    spoil_named(monkeypatch, edgy)
    (left_out,) = made(yoke).left_out
    assert left_out.quantity == "multipliers"
    assert regrouped == []


@pytest.mark.parametrize(
    ("factor", "wide"),
    [(30, ["float64"]), pytest.param(34, ["float64", "float32"], marks=pytest.mark.campaign)],
)
def test_types_that_need_nearly_all_take_twice_the_digits(
    yoke: Path, monkeypatch: pytest.MonkeyPatch, factor: int, wide: list[str]
) -> None:
    yoke.write_text(YOKE + "ranges: {a: [0.7, 1]}\n", encoding="utf-8")
    spoil_choice(monkeypatch, lambda motion: losing(motion, factor))
    spoil_named(monkeypatch, lambda motion: losing(motion, factor))
    result = made(yoke)
    (rejected,) = derived(result)["rejected"]
    assert float(re.findall(r"error (\S+) times", rejected["why"])[0]) > NARROW
    assert "leaves no margin" in rejected["why"]
    assert derived(result)["kernels"]["multipliers"]["twice_the_digits"] == wide
    assert result.certificate is not None
    assert result.certificate["passed"]
    errors = [e for e in result.certificate["errors"] if e["quantity"] == "multipliers"]
    assert max(e["largest"] for e in errors) <= NARROW
    assert max(e["largest"] for e in errors if any(scalar in e["target"] for scalar in wide)) <= 1


@pytest.mark.campaign
@pytest.mark.parametrize(("narrowest", "wide"), [(0.6, ["float64", "float32"]), (15.9, None)])
def test_so_does_any_quantity_of_which_next_to_nothing_is_left(
    yoke: Path, monkeypatch: pytest.MonkeyPatch, narrowest: float, wide: list[str] | None
) -> None:
    monkeypatch.setattr(fallback, "MARGIN", 0.6)
    monkeypatch.setattr(fallback, "NARROWEST", narrowest)
    yoke.write_text(re.sub("outputs: .*", "outputs: [admissible_acceleration]", YOKE), encoding="utf-8")
    kernel = derived(made(yoke))["kernels"]["admissible_acceleration"]
    assert kernel.get("twice_the_digits") == wide


@pytest.mark.campaign
def test_states_that_lead_nowhere_do_not_end_the_search(yoke: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    spoil_choice(monkeypatch, edgy)
    settled = Settling.sample
    asked: list[State] = []

    def rarely(self: Settling, state: State, admissible: bool, quantity: str) -> Sample | None:
        asked.append(state)
        return settled(self, state, admissible, quantity) if len(asked) > 2 * JUDGED else None

    monkeypatch.setattr(Settling, "sample", rarely)
    (rejected,) = derived(made(yoke))["rejected"]
    assert "at a state searched for" in rejected["why"]


@pytest.mark.campaign
def test_what_passes_narrowly_at_a_state_searched_for_leaves_no_margin(
    yoke: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    spoil_choice(monkeypatch, edging)
    result = made(yoke)
    (rejected,) = derived(result)["rejected"]
    assert "leaves no margin" in rejected["why"]
    # the states of the verification had nothing to say
    spoil_named(monkeypatch, edging)
    result = made(yoke)
    assert "rejected" not in derived(result)
    assert result.certificate is not None
    assert max(e["largest"] for e in result.certificate["errors"] if e["quantity"] == "multipliers") <= 8


@pytest.mark.campaign
def test_the_method_taken_is_the_one_that_counts_least_of_those_that_pass(
    yoke: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    spoil_choice(monkeypatch, cancelling)
    result = derived(made(yoke))
    assert [one["method"] for one in result["rejected"]] == ["minor along minors"]
    taken = result["kernels"]["multipliers"]
    alone = replace(FAST, outputs=("multipliers",))
    others = [
        derived(made(yoke, replace(alone, methods={"multipliers": name})))["kernels"]["multipliers"]["counted_cost"]
        for name in ("schur_qr", "nullspace")
    ]
    assert min(cost for one in others for cost in one.values()) == min(taken["counted_cost"].values())


@pytest.mark.campaign
def test_what_no_method_passes_is_left_out_alone(
    whole: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    more = YOKE.replace("outputs: [", "outputs: [mass_matrix, inverse_dynamics, ")
    whole.write_text(more, encoding="utf-8")
    spoil_choice(monkeypatch, cancelling)
    spoil_named(monkeypatch, cancelling)
    out = tmp_path / "out"
    common = [str(whole), "--out", str(out), "--states", "8", "--quiet"]
    assert cli.main(common) == 1
    errors = capsys.readouterr().err
    assert "multipliers is left out" in errors
    assert "remedy: " in errors
    folder = out / "yoke"
    certificate = json.loads((folder / "certificate.json").read_bytes())
    assert not certificate["passed"]
    assert certificate["failures"] == []
    (left_out,) = certificate["left_out"]
    assert left_out["quantity"] == "multipliers"
    assert len(left_out["tried"]) > 1
    verified = {error["quantity"] for error in certificate["errors"]}
    assert verified == {"mass_matrix", "inverse_dynamics", "forward_dynamics"}
    derivation_json = json.loads((folder / "derivation.json").read_bytes())
    assert set(derivation_json["kernels"]) == verified
    assert "multipliers" in [one["quantity"] for one in derivation_json["absent"]]
    for path in ("c/yoke.h", "c/yoke_f.c", "package/src/yoke.h", "package/README.md"):
        text = (folder / path).read_text(encoding="utf-8")
        assert "forward_dynamics" in text
        assert "yoke_multipliers" not in text
    assert "multipliers" not in (folder / "package/README.md").read_text(encoding="utf-8")
    assert "def multipliers(" not in (folder / "python/yoke.py").read_text(encoding="utf-8")
    assert "erification rejects it" in " ".join((folder / "report/yoke.tex").read_text(encoding="utf-8").split())
    # without verification, what is on disk is compared with what verification led to
    assert cli.main([*common, "--check"]) == 0
    assert cli.main(["verify", *common]) == 1
    assert "the files on disk are not" not in capsys.readouterr().err


@pytest.mark.campaign
def test_float32_works_with_twice_the_digits_where_it_alone_is_rejected(
    yoke: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Its thresholds are sharp then: a state that is regular for float64 is regular."""
    spoil_choice(monkeypatch, refusing_float32)
    spoil_named(monkeypatch, refusing_float32)
    common = [str(yoke), "--out", str(tmp_path / "out"), *QUICKLY, "--quiet"]
    assert cli.main(common) == 0
    content = json.loads((tmp_path / "out/yoke/derivation.json").read_bytes())
    assert content["kernels"]["multipliers"]["twice_the_digits"] == ["float32"]
    assert cli.main([*common, "--check"]) == 0


@pytest.mark.parametrize("scalar", ["float32", pytest.param("float64", marks=pytest.mark.campaign)])
def test_a_scalar_type_that_is_asked_for_alone_takes_the_next_method_too(
    yoke: Path, monkeypatch: pytest.MonkeyPatch, scalar: kernels.Scalar
) -> None:
    spoil_choice(monkeypatch, edgy)
    result = generate(yoke, replace(FAST, parts=("c",), scalars=(scalar,)), lambda _: None)
    assert result.failures == ()
    assert "searched for" in derived(result)["rejected"][0]["why"]


@pytest.mark.campaign
def test_float64_stays_where_float32_alone_is_rejected(
    whole: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    spoil_choice(monkeypatch, refusing_float32)
    spoil_named(monkeypatch, refusing_float32)
    monkeypatch.setattr(tried_methods, "LONGEST_WIDENED", 20)
    common = [str(whole), "--out", str(tmp_path / "out"), "--states", "8", "--quiet"]
    assert cli.main(common) == 1
    errors = capsys.readouterr().err
    assert "multipliers is left out in float32: " in errors
    assert "`--scalar float64`" in errors
    folder = tmp_path / "out/yoke"
    certificate = json.loads((folder / "certificate.json").read_bytes())
    assert [one["scalars"] for one in certificate["left_out"]] == [["float32"]]
    verified = {(error["quantity"], error["target"]) for error in certificate["errors"]}
    assert ("multipliers", "C float64") in verified
    assert ("multipliers", "C float32") not in verified
    assert ("forward_dynamics", "C float32") in verified
    assert "yoke_multipliers(" in (folder / "c/yoke.h").read_text(encoding="utf-8")
    assert "yoke_multipliers" not in (folder / "c/yoke_f.h").read_text(encoding="utf-8")
    assert "multipliers" not in (folder / "proof/yoke_fuzz.c").read_text(encoding="utf-8")
    assert "def multipliers(" in (folder / "python/yoke.py").read_text(encoding="utf-8")
    assert "Not in float, " in (folder / "package/README.md").read_text(encoding="utf-8")
    assert cli.main([*common, "--check"]) == 0
    assert cli.main([*common, "--scalar", "float64", "--out", str(tmp_path / "one")]) == 0


@pytest.mark.campaign
def test_check_takes_over_the_method_that_verification_led_to(
    yoke: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    spoil_choice(monkeypatch, cancelling)
    common = [str(yoke), "--out", str(tmp_path / "out"), *QUICKLY, "--quiet"]
    assert cli.main(common) == 0
    assert cli.main([*common, "--check"]) == 0
    source = tmp_path / "out/yoke/c/yoke.c"
    source.write_text(source.read_text(encoding="utf-8").replace(" + ", " - ", 1), encoding="utf-8")
    assert cli.main([*common, "--check"]) == 1


@pytest.mark.campaign
def test_where_every_method_loses_digits_one_works_with_twice_as_many(
    yoke: Path, usual: Any, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    spoil_choice(monkeypatch, losing_digits)
    spoil_named(monkeypatch, losing_digits)
    common = [str(yoke), "--out", str(tmp_path / "out"), *QUICKLY]
    assert cli.main(common) == 0
    assert "with twice the digits in float64 and float32: verification speaks against" in capsys.readouterr().err
    folder = tmp_path / "out/yoke"
    content = json.loads((folder / "derivation.json").read_bytes())
    kernel = content["kernels"]["multipliers"]
    assert kernel["twice_the_digits"] == ["float64", "float32"]
    assert {one["quantity"] for one in content["rejected"]} == {"multipliers"}
    # nothing else pays for it
    assert {name: one for name, one in content["kernels"].items() if name != "multipliers"} == {
        name: one for name, one in usual["kernels"].items() if name != "multipliers"
    }
    certificate = json.loads((folder / "certificate.json").read_bytes())
    assert certificate["passed"]
    assert max(e["largest"] for e in certificate["errors"] if e["quantity"] == "multipliers") <= 8
    assert cli.main([*common, "--quiet", "--check"]) == 0


@pytest.mark.campaign
def test_more_digits_in_float32_alone_take_nothing_from_more_in_both(
    yoke: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Methods that pass in float64 may be beyond what is allowed at states that others were looked for at."""
    spoil_choice(monkeypatch, refusing_float32)
    spoil_named(monkeypatch, losing_digits)
    monkeypatch.setattr(tried_methods, "WIDENED", 1)
    widened = fallback.Fallback._with_pairs
    tried = []

    def failing(self: Any, draft: Any, one: Alternative, scalars: Any, wide: Any, expected: Any) -> Any:
        tried.append(wide)
        attempt = widened(self, draft, one, scalars, wide, expected)
        return replace(attempt, scalars=()) if wide == ("float32",) else attempt

    monkeypatch.setattr(fallback.Fallback, "_with_pairs", failing)
    result = made(yoke)
    assert derived(result)["kernels"]["multipliers"]["twice_the_digits"] == ["float64", "float32"]
    assert tried == [("float32",), ("float64", "float32")]


@pytest.mark.campaign
def test_kernels_that_are_too_long_stay_as_they_are(yoke: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    spoil_choice(monkeypatch, losing_digits)
    spoil_named(monkeypatch, losing_digits)
    monkeypatch.setattr(tried_methods, "LONGEST_WIDENED", 20)
    assert [one.quantity for one in made(yoke).left_out] == ["multipliers"]


@pytest.mark.parametrize(("longer", "digits_help"), [(True, True), (True, False), (False, True)])
@pytest.mark.campaign
def test_after_long_methods_twice_the_digits_are_tried_before_the_rest(
    longer: bool, digits_help: bool, yoke: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The rest of them comes where more digits are of no help, or where it counts less than what is rejected."""
    spoil_choice(monkeypatch, losing_digits)
    usual = derived(made(yoke))["kernels"]["multipliers"]
    monkeypatch.setattr(fallback, "LONG_TRIED", -1)
    if longer:
        counted = Alternative.cost.fget
        monkeypatch.setattr(Alternative, "cost", property(lambda one: counted(one) + 1000 * (one.known is not None)))
    if not digits_help:
        monkeypatch.setattr(tried_methods, "WIDENED", 0)
    kernel = derived(made(yoke))["kernels"]["multipliers"]
    assert "twice_the_digits" not in usual
    assert ("twice_the_digits" in kernel) is (longer and digits_help)
    assert (longer and digits_help) or kernel == usual


@pytest.mark.parametrize(("short", "digits_help"), [(False, True), (False, False), (True, True)])
@pytest.mark.campaign
def test_after_many_methods_of_a_model_long_quantities_begin_with_twice_the_digits(
    short: bool, digits_help: bool, yoke: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Other plain methods come where more digits are of no help; short quantities try them first in any case."""
    spoil_choice(monkeypatch, losing_digits)
    usual = derived(made(yoke))["kernels"]["multipliers"]
    monkeypatch.setattr(fallback, "TRIED_IN_ALL", -1)
    monkeypatch.setattr(fallback, "LONGEST_WEIGHED", 6_000 if short else 0)
    if not digits_help:
        monkeypatch.setattr(tried_methods, "WIDENED", 0)
    kernel = derived(made(yoke))["kernels"]["multipliers"]
    assert "twice_the_digits" not in usual
    assert ("twice_the_digits" in kernel) is (digits_help and not short)
    assert (digits_help and not short) or kernel == usual


@pytest.mark.campaign
def test_where_more_digits_of_one_method_do_not_help_float32_the_rest_is_tried(
    yoke: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A method that has float64 alone does not keep the others from being tried, long ones included."""
    spoil_choice(monkeypatch, refusing_float32)
    monkeypatch.setattr(fallback, "LONG_TRIED", -1)
    widened = fallback.Fallback._with_pairs
    tried = []

    def failing(self: Any, draft: Any, one: Alternative, scalars: Any, wide: Any, expected: Any) -> Any:
        tried.append(one.choice.title)
        return replace(widened(self, draft, one, scalars, wide, expected), scalars=("float64",))

    monkeypatch.setattr(fallback.Fallback, "_with_pairs", failing)
    result = made(yoke)
    assert result.left_out == ()
    # each once, and what has both types in the end is none of these
    assert tried
    assert len(set(tried)) == len(tried)
    assert "twice_the_digits" not in derived(result)["kernels"]["multipliers"]


@pytest.mark.parametrize("asked", [True, False])
@pytest.mark.campaign
def test_twice_the_digits_of_what_is_long_are_for_those_who_ask(
    asked: bool, yoke: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    spoil_choice(monkeypatch, losing_digits)
    spoil_named(monkeypatch, losing_digits)
    monkeypatch.setattr(everything, "WIDE_MAIN_OPERATIONS", 20)
    result = made(yoke, replace(FAST, outputs=("multipliers",) if asked else ("all",)))
    assert result.left_out == ()
    assert ("multipliers" in derived(result)["kernels"]) is asked
    notices = [one for one in result.notices if "`all` leaves it out, as it loses digits" in one.message]
    assert bool(notices) is not asked


@pytest.mark.parametrize("asked", [True, False])
@pytest.mark.campaign
def test_methods_of_what_nobody_asked_for_are_tried_so_many_times(
    asked: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """C~ of the car loses digits by the method that counts least, which verification finds."""
    name = "projected_coriolis_matrix"
    monkeypatch.setattr(fallback, "OPERATIONS_TRIED", -1)
    result = made(ROOT / "models" / "front_car.yaml", replace(FAST, outputs=(name,) if asked else ("all",)))
    assert result.left_out == ()
    assert (name in derived(result)["kernels"]) is asked
    why = f"methods of {everything.OPERATIONS_TRIED} operations were tried"
    messages = [one.message for one in result.notices if why in one.message]
    assert [name in message for message in messages] == ([] if asked else [True])


@pytest.mark.campaign
def test_what_all_leaves_out_is_no_longer_left_out_of_one_type(yoke: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    spoil_choice(monkeypatch, losing_digits)
    spoil_named(monkeypatch, losing_digits)
    monkeypatch.setattr(everything, "WIDE_MAIN_OPERATIONS", 20)
    replaced = fallback.Fallback._replaced

    def after_a_round(self: Any, draft: Any, quantity: str, *others: Any) -> Any:
        before = LeftOut(quantity, ("float32",), (), "")
        return replaced(self, replace(draft, left_out=(before,)), quantity, *others)

    monkeypatch.setattr(fallback.Fallback, "_replaced", after_a_round)
    assert made(yoke, replace(FAST, outputs=("all",))).left_out == ()


@pytest.mark.campaign
def test_a_method_that_was_asked_for_is_not_replaced(yoke: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    spoil_named(monkeypatch, cancelling)
    result = made(yoke, replace(FAST, methods={"multipliers": "kkt"}))
    (left_out,) = result.left_out
    assert left_out.quantity == "multipliers"
    assert [method for method, _ in left_out.tried] == ["kkt"]
    assert "--method multipliers=kkt" in left_out.remedy
    assert "forward_dynamics" in derived(result)["kernels"]


def test_nothing_is_written_where_nothing_passes(
    yoke: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    spoil_choice(monkeypatch, cancelling)
    spoil_named(monkeypatch, cancelling)
    out = tmp_path / "out"
    arguments = [str(yoke), "--out", str(out), "--outputs", "multipliers", "--only", "c", "--states", "8", "--quiet"]
    assert cli.main(arguments) == 1
    errors = capsys.readouterr().err
    assert "verification failed, nothing is written" in errors
    assert "multipliers is left out" in errors
    assert not (out / "yoke").exists()


# A drive of which only the slider weighs anything: G is nearly singular, the motion is not.
LIGHT = """
model: light_yoke
coordinates: {a: {unit: rad}, b: {unit: rad}, x: {unit: m, range: [-1, 1]}}
parameters:
  r: {value: 0.3, unit: m}
  l: {value: 0.7, unit: m}
  J: {value: 3e-10, unit: kg*m**2}
  m: {value: 2e-9, unit: kg}
  M: {value: 5, unit: kg}
kinetic_energy: J/2*a_dot**2 + m/2*(r**2*a_dot**2 + l*r*cos(a - b)*a_dot*b_dot + l**2/3*b_dot**2) + M/2*x_dot**2
constraints:
  geometric:
    along: r*cos(a) + l*cos(b) - x
    across: r*sin(a) + l*sin(b) - 0.1
inputs: {torque: {unit: N*m, acts_on: {a: 1}}}
configuration: {a: 0.6, b: -0.1, x: 0.9}
outputs: [inverse_dynamics, forward_dynamics, multipliers]
"""
# A bed lifted by two scissors of hinged plates at a right angle: rows of loops depend on each other.
LIFT = """
model: lift
joints:
  s_1: {type: revolute, axis: y, at: [0.2, 0, 0], coordinate: a_1}
  s_2: {type: revolute, parent: s_1, axis: y, at: [w, 0, 0], coordinate: a_2}
  bed: {type: revolute, parent: s_2, axis: y, at: [w, 0, 0], coordinate: a_3}
  f_1: {type: revolute, axis: x, at: [0, -0.15, 0], coordinate: b_1}
  f_2: {type: revolute, parent: f_1, axis: x, at: [0, -w, 0], coordinate: b_2}
frames:
  f_end: {parent: f_2, translation: [0, -w, 0]}
  f_bed: {parent: bed, translation: [-0.2, -0.15, 0]}
parameters:
  w: {value: 0.5, unit: m}
gravity: [0, 0, -9.81]
bodies:
  s_1: {mass: 3, com: [w/2, 0, 0], inertia: {xx: 0.01, yy: 0.06, zz: 0.06}}
  s_2: {mass: 3, com: [w/2, 0, 0], inertia: {xx: 0.01, yy: 0.06, zz: 0.06}}
  f_1: {mass: 2, com: [0, -w/2, 0], inertia: {xx: 0.04, yy: 0.01, zz: 0.04}}
  f_2: {mass: 2, com: [0, -w/2, 0], inertia: {xx: 0.04, yy: 0.01, zz: 0.04}}
  bed: {mass: 25, inertia: {xx: 1, yy: 1, zz: 2}}
loops:
  hinge: {type: revolute, between: [f_end, f_bed], axis: x}
inputs:
  motor: {unit: N*m, joint: a_1}
configuration: {a_1: -0.7, a_2: -1.7415926, a_3: 2.4415926, b_1: -0.7, b_2: -1.7415926}
outputs: [inverse_dynamics, forward_dynamics, multipliers]
"""


@pytest.mark.campaign
@pytest.mark.slow
@pytest.mark.parametrize("text", [LIGHT, LIFT], ids=["light_yoke", "lift"])
def test_real_machines_get_every_quantity(text: str, tmp_path: Path) -> None:
    path = tmp_path / "machine.yaml"
    path.write_text(text, encoding="utf-8")
    result = made(path, Options(parts=("c", "python")))
    assert result.failures == ()
    assert result.left_out == ()
    assert set(derived(result)["kernels"]) == {"inverse_dynamics", "forward_dynamics", "multipliers"}


@pytest.mark.campaign
def test_laws_that_a_number_with_few_digits_violates_too_do_not_keep_it_from_more_digits(
    yoke: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The accelerations that lose digits violate the constraints, too."""
    spoil_choice(monkeypatch, losing_digits, "forward_dynamics")
    monkeypatch.setattr(alternatives.Alternatives, "of", lambda *_: ())
    result = made(yoke)
    assert result.left_out == ()
    assert derived(result)["kernels"]["forward_dynamics"]["twice_the_digits"] == ["float64", "float32"]


@pytest.mark.campaign
def test_a_status_of_float32_does_not_keep_what_loses_digits_from_more_of_them(
    yoke: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The first choice is as good as another method there, which is judged in float64 first."""
    spoil_choice(monkeypatch, lambda motion: refusing_float32(losing_digits(motion)))
    monkeypatch.setattr(alternatives.Alternatives, "of", lambda *_: ())
    result = made(yoke)
    assert result.left_out == ()
    assert derived(result)["kernels"]["multipliers"]["twice_the_digits"] == ["float64", "float32"]
