"""The pieces of `symgen target`: the files of the driver, comparison, and the command without tools."""

from __future__ import annotations

import math
import struct
from dataclasses import replace
from pathlib import Path

import pytest
from shipped import model, programs

from symgen.cli.main import main
from symgen.ir.kernel import Scalar
from symgen.laboratory.target.compare import BOUND, compare
from symgen.laboratory.target.cores import BY_NAME, CORES, LEVELS, Compiler, Core
from symgen.laboratory.target.driver import Results, RunRecord, driver_source, pack_states, unpack_results
from symgen.laboratory.target.entries import Entries, plain_entries, with_companions
from symgen.laboratory.target.selection import ALL, Share, beyond_pairs, selected, selection, share, small_kernels
from symgen.laboratory.target.vectors import perturbed, vectors_of
from symgen.model.load import load_text
from symgen.verify.reference.reference import Reference, State


def _entries() -> Entries:
    program = programs("front_car")["float32"]
    few = replace(program, kernels=tuple(k for k in program.kernels if k.name in ("inverse_dynamics", "energy")))
    return plain_entries(model("front_car"), few)


def _results(u: float, states: int = 2, status: int = 0) -> Results:
    record = RunRecord(status, struct.pack("<2f", u, 1.0))
    return Results(dict.fromkeys(("inverse_dynamics", "energy"), (record,) * states), {})


def test_missing_tools_are_named_with_their_packages(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "cart.yaml"
    path.write_text("model: cart\ncoordinates: {x: {unit: m}}\nkinetic_energy: x_dot**2\n")
    monkeypatch.setenv("PATH", str(tmp_path))
    assert main(["target", str(path), "--cpu", "cortex-m4f", "--cpu", "rv32imac", "--out", str(tmp_path)]) == 2
    errors = capsys.readouterr().err
    packages = ("gcc-arm-none-eabi", "libnewlib-arm-none-eabi", "qemu-system-arm", "gcc-riscv64-unknown-elf",
                "picolibc-riscv64-unknown-elf", "qemu-system-misc")
    assert all(package in errors for package in packages)
    assert "apt-get install" in errors
    assert not (tmp_path / "cart").exists()


def test_unknown_cores_are_refused_with_the_known_ones(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit, match="2"):
        main(["target", "models/skate.yaml", "--cpu", "z80"])
    assert "cortex-m4f" in capsys.readouterr().err


CART = """
model: cart
coordinates: {x: {}, a: {unit: rad}}
parameters: {m: {value: 8}}
kinetic_energy: m*x_dot**2 + a_dot**2
inputs: {push: {acts_on: {x: 1}}}
"""
STATE = State((0.0, 2.0), (3.0, 4.0), (5.0, 6.0), (7.0,), (8.0,))


def test_states_are_packed_row_by_row() -> None:
    data = pack_states([STATE, STATE], "float32", load_text(CART, "cart.yaml"))
    count, *row = struct.unpack("<I21f", data[:88])
    assert len(data) == 4 + 2 * 84
    assert (count, row[:7]) == (2, [0, *map(float, range(2, 8))])
    assert row[16:] == pytest.approx([8, 0, 1, math.sin(2), math.cos(2)])


def test_what_is_measured_the_task_weights_and_a_direction_stand_before_parameters() -> None:
    given = load_text(CART + "measured: [x, a]\ntask: {tip: x + sin(a), x: x, turn: 2*a}\n", "cart.yaml")
    data = pack_states([replace(STATE, task=(9.0, 10.0, 11.0))], "float64", given)
    assert len(data) == 4 + 8 * (7 + 6 + 9 + 3 + 6 + 1 + 4)
    _, *row = struct.unpack("<I36d", data)
    measured, task, weights = [3 / 1024, 2 + 4 / 1024, 3, 4, 5, 6], [9, 10, 11, 3, 4, 3, 5, 6, 5], [7, 5, 6]
    # the direction of a second derivative by q, q_dot and q_ddot is (q_dot, q_ddot, q)
    direction = [3, 4, 5, 6, 0, 2]
    assert row[6:32] == [7, *measured, *task, *weights, *direction, 8]


def test_results_are_read_back_and_short_files_refused() -> None:
    entries = _entries()
    rows = [struct.pack("<I2f", 0, *values) for values in ((1.0, 2.0), (3.0, 4.0))] * 2
    data = b"".join(rows) + struct.pack("<2I", 24, 32)
    results = unpack_results(data, entries, 2)
    names = [entry.name for entry in entries.functions]
    assert [results.records[name][1].outputs for name in names] == [rows[0][4:], rows[1][4:]]
    assert [results.stack[name] for name in names] == [24, 32]
    with pytest.raises(ValueError, match="instead of"):
        unpack_results(data[:-1], entries, 2)


def test_one_bit_or_one_status_is_a_difference() -> None:
    entries = _entries()
    units = {entry.name: (1e-7, 1e-7) for entry in entries.functions}
    same = compare(entries, True, _results(1.0), _results(1.0), units, 2)
    assert same.different == 0
    assert not same.wrong
    next_float = struct.unpack("<f", struct.pack("<I", 0x3F800001))[0]
    for other in (_results(next_float), _results(1.0, status=1)):
        differences = compare(entries, True, _results(1.0), other, units, 2)
        assert differences.different == 4
        assert len(differences.wrong) == 2


def test_a_library_may_differ_within_the_bound_at_regular_states() -> None:
    entries = _entries()
    units = {entry.name: (1e-7, 1e-7) for entry in entries.functions}
    near, far = _results(1.0 + 0.5 * BOUND * 1e-7), _results(1.0 + 2 * BOUND * 1e-7)
    close = compare(entries, False, _results(1.0), near, units, 2)
    assert close.different == 4
    assert not close.wrong
    assert 0 < close.distance <= BOUND
    assert compare(entries, False, _results(1.0), far, units, 2).wrong
    assert not compare(entries, False, _results(1.0), far, units, 0).wrong
    assert compare(entries, False, _results(1.0), _results(1.0, status=4), units, 2).wrong


def test_vectors_are_many_seeded_and_hold_singular_ones() -> None:
    first, second = (vectors_of(Reference(model("skate"))) for _ in range(2))
    assert len(first.regular) == 256
    assert first.singular
    assert first.odd
    assert first.regular == second.regular
    assert len(perturbed(first.regular[:2], "float32")) == 12


def test_the_driver_calls_every_function_of_both_types() -> None:
    car = model("front_car")
    entries = {s: with_companions(car, plain_entries(car, p), p) for s, p in programs("front_car").items()}
    text = driver_source(car, entries)
    for kernel in programs("front_car")["float32"].kernels:
        assert f"front_car_{kernel.name}(" in text
        assert f"front_car_{kernel.name}_f(" in text
    assert "front_car_inverse_dynamics_prepared_f(row_float.q" in text
    assert "front_car_inverse_dynamics_sc(&sc_double" in text


def _core(name: str | None) -> Core | None:
    return None if name is None else BY_NAME[name]


def _built(core: Core | None, compiler: Compiler, level: str, part: Share, scalar: Scalar = "float64") -> set[str]:
    chosen = selected(selection(core, compiler, level, "portable", part), programs("rapkm_2rrr_rr"))
    return {kernel.name for kernel in chosen[scalar].kernels}


@pytest.mark.parametrize(
    ("core", "compiler", "level", "part", "float64"),
    [
        (None, "gcc", "-O2", ALL, "all"), (None, "gcc", "-O1", ALL, "small"),
        ("cortex-m7", "gcc", "-O2", ALL, "all"), ("cortex-m4f", "clang", "-O2", ALL, "all"),
        ("cortex-m4f", "gcc", "-Os", (0, 3), "all but the largest"), ("cortex-m4f", "gcc", "-O2", (0, 3), "small"),
        ("cortex-m4f", "gcc", "-O2", ALL, "all but the largest"),
        ("cortex-m4f", "gcc", "-O0", ALL, "all but the largest"),
        ("rv32imac", "clang", "-O3", (0, 3), "small"), ("rv32imac", "clang", "-O3", ALL, "all"),
    ],
)
def test_large_kernels_in_float64_are_built_where_that_is_quick(
    monkeypatch: pytest.MonkeyPatch, core: str | None, compiler: Compiler, level: str, part: Share, float64: str
) -> None:
    monkeypatch.setattr("symgen.laboratory.target.selection.MOST_IN_PAIRS", 1000)
    known = programs("rapkm_2rrr_rr")["float64"]
    beyond = {kernel.name for kernel in beyond_pairs(known)}
    everything = {kernel.name for kernel in known.kernels}
    assert beyond
    built = _built(_core(core), compiler, level, part)
    if float64 == "small":
        assert "inverse_dynamics" in built
        assert built < everything - beyond
    else:
        assert built == (everything if float64 == "all" else everything - beyond)
    single = _built(_core(core), compiler, level, part, "float32")
    assert (single == everything) == (float64 != "small")


def test_every_kernel_is_built_at_every_level_on_two_of_six_cores() -> None:
    everything = {kernel.name for kernel in small_kernels(programs("rapkm_2rrr_rr")["float32"]).kernels}
    builds = [(compiler, level) for compiler in ("gcc", "clang") for level in LEVELS]
    for number, (compiler, level) in enumerate(builds):
        parts = [
            _built(core, compiler, level, share(number, place, len(CORES)), "float32")
            for place, core in enumerate(CORES)
        ]
        assert all("inverse_dynamics" in part for part in parts)
        assert all(sum(name in part for part in parts) >= 2 for name in everything), (compiler, level)
    library = selection(CORES[0], "gcc", "-O2", "libm", share(0, 0, len(CORES)))
    assert "inverse_dynamics" in {kernel.name for kernel in selected(library, programs("skate"))["float32"].kernels}
    assert share(3, 0, 1) == share(4, 2, 3) == ALL  # a few cores take everything
