"""Rust: crates that cargo builds without a warning, with the bits and statuses of the interpreter and of the C."""

from __future__ import annotations

import random
import re
import struct
import subprocess
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import handmade
import numpy as np
import pytest
import rust_crates
import shipped
from test_same_bits import expected, states

from symgen.backends.c.plain import emit_c
from symgen.backends.locals import array_arguments
from symgen.backends.rust.crate import emit_crate
from symgen.backends.rust.module import MOST_BINDINGS, emit_rust
from symgen.backends.rust.reserved import crate_name
from symgen.backends.scalars import C_TYPE, SUFFIX
from symgen.generation.results import Options
from symgen.ir.interpret import Interpreter
from symgen.ir.kernel import Block, Check, Kernel, Load, Local, Program, Scalar, Status
from symgen.ir.library_trig import with_library_trig
from symgen.ir.pairs.wide import widened
from symgen.pipeline import generate

FORMAT = {"float64": "d", "float32": "f"}
LONGER = ("slider_crank", "rapkm_2rrr_rr")
# Functions of the library, each of one operand in its domain at 0.3.
ONE_OPERAND = ("tan", "asin", "acos", "atan", "exp", "log", "sinh", "cosh", "tanh")


def replayed(scalar: Scalar, kernels: list[Kernel], written: bytes, count: int) -> list[list[tuple[int, list[float]]]]:
    """What a program wrote, by kernel and state."""
    place, results = 0, []
    for kernel in kernels:
        of_states: list[tuple[int, list[float]]] = []
        for _ in range(count):
            status, place, values = written[place], place + 1, []
            if status == 0:
                form = f"<{len(kernel.outputs)}{FORMAT[scalar]}"
                values = list(struct.unpack_from(form, written, place))
                place += struct.calcsize(form)
            of_states.append((status, values))
        results.append(of_states)
    assert place == len(written)
    return results


def bits(values: list[float]) -> bytes:
    return np.asarray(values).tobytes()


@pytest.mark.toolchain
@pytest.mark.slow
@pytest.mark.parametrize("scalar", shipped.SCALARS)
@pytest.mark.parametrize("name", shipped.sparing(("front_car", *LONGER), LONGER))
def test_the_interpreters_bits_and_statuses(
    tool: Callable[[str], str], tmp_path: Path, name: str, scalar: Scalar
) -> None:
    program, drawn = shipped.short(name, scalar), states(name, scalar)
    kernels = list(program.kernels)
    made = rust_crates.crate(shipped.model(name), {scalar: program}, tmp_path)
    main = rust_crates.replaying(name, scalar, kernels, len(drawn))
    given = b"".join(
        struct.pack(f"<{argument.length}{FORMAT[scalar]}", *state[argument.name])
        for kernel in kernels
        for state in drawn
        for argument in array_arguments(kernel)
    )
    written = rust_crates.run(rust_crates.driver(made, name, main), tool("cargo"), given)
    for kernel, results in zip(kernels, replayed(scalar, kernels, written, len(drawn)), strict=True):
        for (status, values), (wanted, numbers) in zip(results, expected(name, kernel.name, scalar), strict=True):
            assert (status, bits(values)) == (wanted, bits([] if wanted else numbers)), kernel.name


IN_RUST = """
use {name}::{scalar} as kernels;

fn main() {{
    let p = kernels::Parameters::default();
    let (mut x, mut hash, mut valid) = (88172645463325252u64, 0xcbf29ce484222325u64, 0u32);
    for _ in 0..{count} {{
        let mut given = [0.0 as {kind}; {size}];
        for number in given.iter_mut() {{
            x ^= x << 13;
            x ^= x >> 7;
            x ^= x << 17;
            *number = ((x >> 11) as f64 / 9007199254740992.0 * 6.0 - 3.0) as {kind};
        }}
        if x % 16 == 0 {{
            given[0] *= 1e30;
        }}
        let (q, rest) = given.split_at({n});
        let (qd, last) = rest.split_at({n});
        let (q, qd, last) = (q.try_into().unwrap(), qd.try_into().unwrap(), last.try_into().unwrap());
        let mut add = |byte: u8| hash = (hash ^ u64::from(byte)).wrapping_mul(0x100000001b3);
        match kernels::{quantity}(q, qd, last, &p) {{
            Ok(y) => {{
                valid += 1;
                y.iter().flat_map(|number| number.to_le_bytes()).for_each(&mut add);
            }}
            Err(status) => add(status.code()),
        }}
    }}
    println!("{{hash:016x}} {{valid}}");
}}
"""
IN_C = """
#include "{header}"
#include <stdint.h>
#include <stdio.h>

int main(void) {{
    const {params} p = {defaults}();
    uint64_t x = 88172645463325252u, hash = 0xcbf29ce484222325u;
    unsigned valid = 0;
    for (long k = 0; k < {count}; ++k) {{
        {kind} given[{size}], y[{outputs}];
        for (int i = 0; i < {size}; ++i) {{
            x ^= x << 13;
            x ^= x >> 7;
            x ^= x << 17;
            given[i] = ({kind})((double)(x >> 11) / 9007199254740992.0 * 6.0 - 3.0);
        }}
        if (x % 16 == 0) {{
            given[0] *= ({kind})1e30;
        }}
        const int status = (int){function}(given, given + {n}, given + {twice}, &p, y);
        const unsigned char *bytes = (const unsigned char *)y, code = (unsigned char)status;
        valid += status == 0;
        for (unsigned i = 0; i < (status ? 1u : (unsigned)sizeof y); ++i) {{
            hash = (hash ^ (status ? code : bytes[i])) * 0x100000001b3u;
        }}
    }}
    printf("%016llx %u\\n", (unsigned long long)hash, valid);
    return 0;
}}
"""


@pytest.mark.campaign
@pytest.mark.toolchain
@pytest.mark.slow
@pytest.mark.parametrize("scalar", shipped.SCALARS)
def test_the_bits_of_the_c_at_a_million_states(tool: Callable[[str], str], tmp_path: Path, scalar: Scalar) -> None:
    """Angles within three radians, most of them off the constraints; one in sixteen is beyond all ranges."""
    name, quantity = "rapkm_2rrr_rr", "forward_dynamics"
    model, whole = shipped.model(name), shipped.programs(name)[scalar]
    (kernel,) = (kernel for kernel in whole.kernels if kernel.name == quantity)
    program, suffix = replace(whole, kernels=(kernel,)), SUFFIX[scalar]
    sizes = [argument.length for argument in array_arguments(kernel)]
    numbers = {"name": name, "quantity": quantity, "scalar": scalar, "count": 1_000_000, "n": model.n}
    numbers |= {"size": sum(sizes), "twice": 2 * model.n, "outputs": len(kernel.outputs)}

    made = rust_crates.crate(model, {scalar: program}, tmp_path)
    main = IN_RUST.format(kind={"float64": "f64", "float32": "f32"}[scalar], **numbers)
    rust = rust_crates.run(rust_crates.driver(made, name, main, ["std"]), tool("cargo"), release=True).decode()

    for path, text in emit_c(model, program).items():
        (tmp_path / Path(path).name).write_text(text)
    names = {"params": f"{name}_params{suffix}", "defaults": f"{name}_default_params{suffix}"}
    names |= {"header": f"{name}{suffix}.h", "function": f"{name}_{quantity}{suffix}", "kind": C_TYPE[scalar]}
    (tmp_path / "main.c").write_text(IN_C.format(**names, **numbers))
    flags = ["-std=c99", "-O2", "-o", str(tmp_path / "main")]
    sources = [str(tmp_path / "main.c"), str(tmp_path / f"{name}{suffix}.c")]
    subprocess.run([tool("gcc"), *flags, *sources, "-lm"], check=True)
    c = subprocess.run([tmp_path / "main"], capture_output=True, text=True, check=True).stdout
    assert rust == c
    assert 900_000 < int(c.split()[1]) < 950_000


def toy(operands: dict[str, tuple[str, ...]]) -> Kernel:
    """A kernel whose outputs are operations on x and theta."""
    statements = tuple(handmade.op(f"y_{name}", name, *given) for name, given in operands.items())  # type: ignore[arg-type]
    outputs = tuple(Local(f"y_{name}") for name in operands)
    of_arguments = (Load("x", "q", 0), Load("theta", "q", 1))
    return Kernel(
        "energy", (handmade.Argument("q", 2),), of_arguments, (Block(statements, ()),), outputs, (len(outputs),)
    )


@pytest.mark.toolchain
@pytest.mark.slow
@pytest.mark.parametrize("scalar", shipped.SCALARS)
def test_functions_of_the_library_and_choices(tool: Callable[[str], str], tmp_path: Path, scalar: Scalar) -> None:
    operations: dict[str, tuple[str, ...]] = dict.fromkeys(ONE_OPERAND, ("x",))
    operations |= {"atan2": ("x", "theta"), "min": ("x", "theta"), "max": ("x", "theta"), "copysign": ("x", "theta")}
    kernel = toy(operations)
    program = Program(scalar, None, (kernel,))
    made = rust_crates.crate(handmade.model(), {scalar: program}, tmp_path)
    assert "no_std" not in (made / "src/lib.rs").read_text()
    given = [float(np.dtype(scalar).type(x)) for x in (0.3, -0.7)]
    folder = rust_crates.driver(made, "toy", rust_crates.replaying("toy", scalar, [kernel], 1))
    written = rust_crates.run(folder, tool("cargo"), struct.pack(f"<2{FORMAT[scalar]}", *given))
    ((status, values),) = replayed(scalar, [kernel], written, 1)[0]
    wanted, numbers = Interpreter(None, scalar).run(kernel, {"q": given}, [1.0] * 4)
    assert (status, wanted) == (0, Status.OK)
    # the library of C rounds functions of float32 otherwise than those of double precision rounded
    assert values == pytest.approx(numbers, rel=4 * float(np.finfo(scalar).eps), abs=0.0)
    assert values[-3:] == numbers[-3:]


@pytest.mark.toolchain
@pytest.mark.slow
@pytest.mark.parametrize("scalar", shipped.SCALARS)
def test_square_roots_without_the_standard_library(tool: Callable[[str], str], tmp_path: Path, scalar: Scalar) -> None:
    """Every exponent, the smallest and largest numbers, squares, and the numbers beside these."""
    kernel, kind = toy({"sqrt": ("x",)}), np.dtype(scalar).type
    limits, dice = np.finfo(scalar), random.Random(3)
    numbers = [0.0, -0.0, limits.smallest_subnormal, limits.tiny, limits.max, 1.0, 2.0, 4.0, 9.0]
    numbers += [float(kind(2.0**power * dice.uniform(1, 2))) for power in range(limits.minexp - 20, limits.maxexp)]
    numbers += [float(kind(k * k)) for k in range(1, 4000, 7)]
    numbers += [float(np.nextafter(kind(x), kind(end))) for x in numbers for end in (0.0, limits.max)]
    numbers += [-1.0, float("inf"), float("nan")]
    made = rust_crates.crate(handmade.model(), {scalar: Program(scalar, None, (kernel,))}, tmp_path)
    assert 'cfg_attr(not(feature = "std"), no_std)' in (made / "src/lib.rs").read_text()
    folder = rust_crates.driver(made, "toy", rust_crates.replaying("toy", scalar, [kernel], len(numbers)))
    given = b"".join(struct.pack(f"<2{FORMAT[scalar]}", x, 0.0) for x in numbers)
    results = replayed(scalar, [kernel], rust_crates.run(folder, tool("cargo"), given), len(numbers))[0]
    for x, (status, values) in zip(numbers, results, strict=True):
        with np.errstate(invalid="ignore"):
            root = np.sqrt(kind(x))
        assert status == (0 if np.isfinite(root) else Status.NOT_FINITE)
        assert bits(values) == bits([float(root)] if status == 0 else []), x


@pytest.mark.campaign
@pytest.mark.toolchain
@pytest.mark.slow
def test_a_whole_model_without_a_complaint(tool: Callable[[str], str], tmp_path: Path) -> None:
    """Compiler, clippy and rustdoc, for every kernel in both types; some have thousands of statements."""
    programs = dict(shipped.programs("rear_car"))
    longest = max(shipped.programs("rapkm_2rrr_rr")["float64"].kernels, key=lambda one: len(one.statements))
    assert len(longest.statements) > 2 * MOST_BINDINGS
    pairs = widened(next(one for one in programs["float64"].kernels if one.name == "forward_dynamics"), "float64")
    made = rust_crates.crate(shipped.model("rear_car"), programs, tmp_path)
    rust_crates.cargo(tool("cargo"), "clippy", "--quiet", folder=made)
    rust_crates.cargo(tool("cargo"), "doc", "--quiet", folder=made)
    own = replace(programs["float64"], kernels=(pairs,))
    rust_crates.crate(shipped.model("rear_car"), {"float64": own}, tmp_path)
    rust_crates.cargo(tool("cargo"), "clippy", "--quiet", folder=made)
    # with the tables of debuggers, which take a stack as deep as bindings are nested
    long = replace(shipped.programs("rapkm_2rrr_rr")["float64"], kernels=(longest,))
    rust_crates.crate(shipped.model("rapkm_2rrr_rr"), {"float64": long}, tmp_path)
    rust_crates.cargo(tool("cargo"), "build", "--quiet", folder=made)


@pytest.mark.toolchain
@pytest.mark.slow
def test_statements_that_could_be_written_otherwise(tool: Callable[[str], str], tmp_path: Path) -> None:
    """As they come of numbers that are rounded to 1, -1 or 0 in a scalar type."""
    one, none = handmade.literal("1"), handmade.literal("0")
    statements = (
        handmade.op("a", "mul", handmade.literal("-1"), "x"),
        handmade.op("b", "mul", "a", one),
        handmade.op("c", "add", "b", none),
        handmade.op("d", "sub", "c", "c"),
        handmade.op("e", "div", "theta", "theta"),
        handmade.op("f", "neg", "d"),
        handmade.op("g", "neg", "f"),
        handmade.op("h", "mul", "e", handmade.literal("3.14159265358979323846")),
        handmade.op("k", "sub", none, "g"),
    )
    check = Check(Status.MASS_RANK, Local("h"), handmade.literal("-0.5"))
    outputs = tuple(map(Local, "bchk"))
    kernel = replace(toy({}), blocks=(Block(statements, (check,)),), outputs=outputs, shape=(2, 2))
    programs = {scalar: Program(scalar, None, (kernel,)) for scalar in shipped.SCALARS}
    made = rust_crates.crate(handmade.model(), programs, tmp_path)
    rust_crates.cargo(tool("cargo"), "clippy", "--quiet", folder=made)


AWKWARD = """
model: loop
description: "ends ``` a fence, [links], */ and <b>tags</b>"
parameters:
  type: {value: 2, unit: kg, description: "a [link](to) `code` *and* more"}
  fn: 1.5
  Ok: 0.5
  sincos: 0.25
  Parameters: 0.1
  match: 3
coordinates: {ref: {unit: m}, move: {unit: rad}}
kinetic_energy: type*ref_dot**2/2 + fn*move_dot**2/2 + Ok*sincos*Parameters*ref_dot*move_dot*cos(move)
potential_energy: match*ref*sin(move)
inputs: {u_1: {acts_on: {ref: 1}}, u_2: {acts_on: {move: 1}}}
outputs: all
"""


@pytest.mark.toolchain
@pytest.mark.slow
def test_names_that_rust_has_taken(tool: Callable[[str], str], tmp_path: Path) -> None:
    path = tmp_path / "loop.yaml"
    path.write_text(AWKWARD)
    files = generate(path, Options(parts=("rust",), verify=False), lambda _: None).files
    assert {name for name in files if name.startswith("rust/")} == {
        "rust/Cargo.toml",
        "rust/src/lib.rs",
        "rust/src/float64.rs",
        "rust/src/float32.rs",
    }
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(str(text), encoding="utf-8")
    assert 'name = "loop_model"' in (tmp_path / "rust/Cargo.toml").read_text()
    rust_crates.cargo(tool("cargo"), "clippy", "--quiet", folder=tmp_path / "rust")
    rust_crates.cargo(tool("cargo"), "doc", "--quiet", folder=tmp_path / "rust")


def test_crates_are_called_like_the_model_where_that_can_be() -> None:
    assert [crate_name(stem) for stem in ("rob", "type", "std")] == ["rob", "type_model", "std_model"]


def test_no_kernel_makes_no_crate() -> None:
    assert emit_crate(handmade.model(), [replace(handmade.program(), kernels=())]) == {}


def test_sines_of_the_library_need_the_standard_one() -> None:
    model, program = shipped.model("front_car"), with_library_trig(shipped.programs("front_car")["float64"])
    (text,) = emit_rust(model, program).values()
    assert "x.sin()" in text
    assert "no_std" not in emit_crate(model, [program])["rust/src/lib.rs"]


@pytest.mark.campaign
@pytest.mark.toolchain
@pytest.mark.slow
def test_the_page_says_what_its_program_prints(tool: Callable[[str], str], tmp_path: Path) -> None:
    page = (shipped.ROOT / "docs/rust.md").read_text(encoding="utf-8")
    (program,), (shown,) = (re.findall(rf"^```{kind}\n(.*?)^```$", page, re.M | re.S) for kind in ("rust", "text"))
    for name, text in shipped.made("front_car", "rust").files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(str(text), encoding="utf-8")
    folder = rust_crates.driver(tmp_path / "rust", "front_car", program)
    rust_crates.cargo(tool("cargo"), "clippy", "--quiet", folder=folder)
    assert rust_crates.run(folder, tool("cargo")).decode() == shown
