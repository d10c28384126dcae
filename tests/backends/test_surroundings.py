"""What stands before the kernels of a C file: the macro of rare conditions, and the library's pair at once."""

from __future__ import annotations

import ctypes
import math
import re
import subprocess
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import handmade
import pytest
import shipped

from symgen.backends.c.bodies.finite import rests
from symgen.backends.c.given_sines import emit_c_sc
from symgen.backends.c.plain import emit_c
from symgen.backends.c.prepared import emit_c_prepared
from symgen.ir.kernel import Program, Scalar
from symgen.ir.library_trig import with_library_trig


def only(name: str, scalar: Scalar, quantity: str) -> Program:
    program = shipped.programs(name)[scalar]
    return replace(program, kernels=tuple(kernel for kernel in program.kernels if kernel.name == quantity))


def texts(name: str, program: Program) -> list[str]:
    model = shipped.model(name)
    made = [emit_c(model, program), emit_c_prepared(model, program), emit_c_sc(model, program)]
    return [str(text) for files in made for path, text in files.items() if path.endswith(".c")]


@pytest.mark.parametrize("name", shipped.SWEPT)
def test_each_regular_way_out_is_marked_rare_and_each_macro_is_defined_where_it_is_used(name: str) -> None:
    for program in (shipped.programs(name)["float32"], with_library_trig(shipped.programs(name)["float64"])):
        for text in texts(name, program):
            used = set(re.findall(r"\b(\w+_RARELY(?:_F)?)\(", text)) - set(re.findall(r"#define (\w+)", text))
            assert not used
            # four blanks: on the way of a regular state, but for functions that only a failure calls
            regular = re.sub(r"\nstatic \w+_APART(_F)? .*?\n}\n", "", text, flags=re.DOTALL)
            assert not re.search(r"\n    if \((?!\w+_RARELY(_F)?\()", regular)


def test_files_without_tests_have_no_macro() -> None:
    program = handmade.Program("float64", None, (handmade.constant(),))
    assert "RARELY" not in emit_c(handmade.model(), program)["c/toy.c"]


def test_one_half_alone_is_one_function() -> None:
    halves = 0
    for name in shipped.SWEPT:
        text = texts(name, with_library_trig(shipped.programs(name)["float64"]))[0]
        for body in text[text.index("_default_params(void)") :].split("\n}\n"):
            for angle in re.findall(r" = (?:sin|cos)\((\w+)\);", body):
                halves += 1
                assert f"_libm({angle}," not in body
            for _, sine, cosine in re.findall(r"_libm\((\w+), &(\w+), &(\w+)\);", body):
                assert len(re.findall(rf"\b{sine}\b", body)) > 2
                assert len(re.findall(rf"\b{cosine}\b", body)) > 2
    assert halves > 0


def test_portable_files_know_nothing_of_the_library_pair() -> None:
    for scalar in shipped.SCALARS:
        assert "_libm" not in "".join(texts("front_car", shipped.programs("front_car")[scalar]))


@pytest.mark.parametrize("compiler", ["gcc", "clang"])
def test_both_halves_have_the_bits_of_sine_and_cosine(
    tool: Callable[[str], str], tmp_path: Path, compiler: str
) -> None:
    """With the GNU library and as if there were another."""
    model, program = shipped.model("rear_car"), with_library_trig(only("rear_car", "float64", "inverse_dynamics"))
    for path, text in emit_c(model, program).items():
        (tmp_path / Path(path).name).write_text(text, encoding="utf-8")
    stem = model.c_name
    results = []
    for kind, flags in (("gnu", ()), ("other", ("-D__UCLIBC__",))):
        target = tmp_path / f"{kind}.so"
        command = [tool(compiler), "-O2", "-std=c99", "-Wall", "-Wextra", "-Werror", "-fPIC", "-shared", *flags]
        subprocess.run([*command, "-o", str(target), str(tmp_path / f"{stem}.c"), "-lm"], check=True)
        library = ctypes.CDLL(str(target))
        defaults = getattr(library, f"{model.name}_default_params")
        fields = [(p.name, ctypes.c_double) for p in model.parameters]
        structure = type("Params", (ctypes.Structure,), {"_fields_": fields})
        defaults.restype = structure
        parameters, u = defaults(), (ctypes.c_double * model.m)()
        for angle in (0.3, -2.0, 1e7):
            q, qd, qdd = ((ctypes.c_double * model.n)(1.0, 2.0, angle, angle / 3) for _ in range(3))
            status = getattr(library, f"{model.name}_inverse_dynamics")(q, qd, qdd, ctypes.byref(parameters), u)
            results.append((kind, status, [value.hex() for value in u]))
    gnu = [entry[1:] for entry in results if entry[0] == "gnu"]
    assert gnu == [entry[1:] for entry in results if entry[0] == "other"]
    assert {status for status, _ in gnu} == {0}


def test_terms_of_the_test_are_zero_for_finite_results_only() -> None:
    for count in range(1, 8):
        names = [f"y{k}" for k in range(count)]
        for place in range(-1, count):
            for bad in (math.inf, -math.inf, math.nan):
                point = {name: (bad if k == place else 1e300 * (-1) ** k) for k, name in enumerate(names)}
                total = sum(product(term, point) for term in rests(names))
                assert math.isnan(total) == (place >= 0)
                assert place >= 0 or total == 0


def product(term: str, point: dict[str, float]) -> float:
    """The value of `(x - x) * y * z` or `x - x`."""
    first, *others = term.split(" * ")
    left, right = first.strip("()").split(" - ")
    value = point[left] - point[right]
    for name in others:
        value *= point[name]
    return value
