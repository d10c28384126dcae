"""MATLAB and Octave: functions that Octave builds and calls, with the bits and statuses of the interpreter."""

from __future__ import annotations

import re
import struct
import subprocess
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import handmade
import numpy as np
import pytest
import shipped
from test_same_bits import expected, states

from symgen.backends.locals import array_arguments
from symgen.backends.matlab.backend import BACKEND
from symgen.backends.matlab.functions import BLOCK, matlab_fields
from symgen.generation.results import Options
from symgen.ir.kernel import Program
from symgen.model.load import load_text
from symgen.model.model import Model
from symgen.pipeline import generate

LONGER = ("slider_crank", "rapkm_2rrr_rr")
NAMES = """\
model: until
coordinates: {x: {}, v_1: {}}
parameters: {methods: {value: 2}, properties: {value: 3, description: "100 % of 'it'"}, methods_: {value: 5}}
kinetic_energy: methods/2*x_dot**2 + properties/2*v_1_dot**2 + methods_*x_dot*v_1_dot/20
inputs: {u_1: {acts_on: {x: 1}}, u_2: {acts_on: {v_1: 1}}}
outputs: [mass_matrix]
"""
# What the block uses of Simulink's headers, as far as a compiler has to know.
SIMSTRUC = """\
#include <stddef.h>
typedef double real_T;
typedef int int_T;
typedef struct mxArray mxArray;
typedef struct SimStruct SimStruct;
#define INHERITED_SAMPLE_TIME -1.0
int mxIsStruct(const mxArray *one);
mxArray *mxGetField(const mxArray *one, size_t k, const char *name);
double mxGetScalar(const mxArray *one);
void ssSetNumSFcnParams(SimStruct *S, int_T count);
int_T ssGetNumSFcnParams(SimStruct *S);
int_T ssGetSFcnParamsCount(SimStruct *S);
int_T ssSetNumInputPorts(SimStruct *S, int_T count);
int_T ssSetNumOutputPorts(SimStruct *S, int_T count);
void ssSetInputPortWidth(SimStruct *S, int_T port, int_T width);
void ssSetInputPortDirectFeedThrough(SimStruct *S, int_T port, int_T through);
void ssSetInputPortRequiredContiguous(SimStruct *S, int_T port, int_T whole);
void ssSetOutputPortWidth(SimStruct *S, int_T port, int_T width);
void ssSetNumSampleTimes(SimStruct *S, int_T count);
void ssSetSampleTime(SimStruct *S, int_T k, real_T time);
void ssSetOffsetTime(SimStruct *S, int_T k, real_T time);
const mxArray *ssGetSFcnParam(SimStruct *S, int_T k);
const real_T *ssGetInputPortRealSignal(SimStruct *S, int_T port);
real_T *ssGetOutputPortRealSignal(SimStruct *S, int_T port);
"""
# Its last lines include what calls the functions above.
ENDING = """\
void simulink(SimStruct *S);
void simulink(SimStruct *S) {
    mdlInitializeSizes(S);
    mdlInitializeSampleTimes(S);
    mdlOutputs(S, 0);
    mdlTerminate(S);
}
"""


def written(model: Model, program: Program, folder: Path) -> Path:
    """The folder of a model's functions under `folder`."""
    assert BACKEND.around is not None
    files = BACKEND.around(model, [program])
    for variant in BACKEND.variants:
        files |= variant.emit(model, program)
    for path, text in files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text, encoding="utf-8")
    return folder / "matlab"


def octave(tool: Callable[[str], str], folder: Path, name: str, lines: Sequence[str]) -> str:
    """What Octave prints once it has built the functions of a model."""
    tool("mkoctfile")
    script = folder / "script.m"
    script.write_text("\n".join((f"addpath('{folder}');", f"build_{name}();", *lines, "")), encoding="utf-8")
    made = subprocess.run(
        [tool("octave-cli"), "--norc", "--no-gui", str(script)],
        cwd=folder, capture_output=True, text=True, check=False, timeout=600,
    )  # fmt: skip
    assert made.returncode == 0, made.stdout + made.stderr
    assert "warning" not in made.stderr
    return made.stdout


def caught(call: str) -> str:
    """A line that prints the identifier and the message of the error that a call is."""
    return f"try; {call}; disp('no error'); catch e; printf('%s|%s\\n', e.identifier, e.message); end"


@pytest.mark.toolchain
@pytest.mark.slow
@pytest.mark.parametrize("name", shipped.sparing(("front_car", *LONGER), LONGER))
def test_the_interpreters_bits_and_statuses(tool: Callable[[str], str], tmp_path: Path, name: str) -> None:
    """All states in one call, a column each."""
    program, drawn = shipped.short(name, "float64"), states(name, "float64")
    folder = written(shipped.model(name), program, tmp_path)
    lines, given = [f"in = fopen('{tmp_path}/in'); out = fopen('{tmp_path}/out', 'w');"], b""
    for kernel in program.kernels:
        names = [argument.name for argument in array_arguments(kernel)]
        for argument in array_arguments(kernel):
            lines.append(f"{argument.name} = fread(in, [{argument.length}, {len(drawn)}], 'double');")
            given += b"".join(struct.pack(f"<{argument.length}d", *state[argument.name]) for state in drawn)
        lines.append(f"[y, status] = {name}.{kernel.name}({', '.join(names)});")
        lines.append("fwrite(out, status, 'int32'); fwrite(out, y, 'double');")
    (tmp_path / "in").write_bytes(given)
    octave(tool, folder, name, [*lines, "fclose(out);"])
    results, place = (tmp_path / "out").read_bytes(), 0
    for kernel in program.kernels:
        # without arguments there is one state
        count = len(drawn) if array_arguments(kernel) else 1
        codes = np.frombuffer(results, "<i4", count, place)
        rows, columns = (*kernel.shape, 1)[:2]
        numbers = np.frombuffer(results, "<f8", rows * columns * count, place + codes.nbytes)
        place += codes.nbytes + numbers.nbytes
        by_state = numbers.reshape(count, columns, rows).swapaxes(1, 2).reshape(count, -1)
        known = expected(name, kernel.name, "float64")[:count]
        for status, made, (wanted, values) in zip(codes, by_state, known, strict=True):
            assert status == wanted, kernel.name
            assert np.isnan(made).all() if wanted else made.tobytes() == np.array(values).tobytes(), kernel.name
    assert place == len(results)


@pytest.mark.toolchain
def test_functions_that_are_not_compiled_say_so(tool: Callable[[str], str], tmp_path: Path) -> None:
    folder = written(handmade.model(), handmade.program(), tmp_path)
    call = f"addpath('{folder}'); {caught(f'toy.{handmade.program().kernels[0].name}(1, 2, 3)')}"
    command = [tool("octave-cli"), "--norc", "--no-gui", "--eval", call]
    made = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False, timeout=60)
    assert made.stdout == "toy:build|the functions of toy are not compiled yet: call build_toy() once\n", made.stderr


@pytest.mark.toolchain
@pytest.mark.slow
def test_mistakes_of_a_caller_are_named(tool: Callable[[str], str], tmp_path: Path) -> None:
    folder = written(shipped.model("front_car"), shipped.short("front_car", "float64"), tmp_path)
    calls = (
        "front_car.inverse_dynamics([q, q + [0; 0; 0; 1e9]], qd, qdd)",
        "front_car.inverse_dynamics(q(1:3), qd, qdd)",
        "front_car.inverse_dynamics([q, q], [qd, qd, qd], qdd)",
        "front_car.inverse_dynamics(single(q), qd, qdd)",
        "front_car.inverse_dynamics(q, qd, qdd, struct('L', 2))",
        "front_car.inverse_dynamics(q, qd, qdd, setfield(p, 'l', 2))",
        "front_car.inverse_dynamics(q, qd, qdd, setfield(p, 'L', [2, 3]))",
        "front_car.inverse_dynamics(q, qd, qdd, 2.6)",
        "front_car_mex('invers')",
    )
    state = "p = front_car.parameters(); q = [0; 0; 0.1; 0.3]; qd = [2; 0; 0.3; 0.1]; qdd = [0.5; 0.1; 0.2; 0.3];"
    agree = "disp(isequal(front_car.inverse_dynamics(q', qd, qdd), front_car.inverse_dynamics(q, qd, qdd, p)))"
    printed = octave(tool, folder, "front_car", [state, *map(caught, calls), agree]).splitlines()
    assert [line.partition("|")[0] for line in printed[:-1]] == [
        "front_car:ANGLE_RANGE",
        *["front_car:arguments"] * 3,
        *["front_car:parameters"] * 4,
        "front_car:usage",
    ]
    messages = [line.partition("|")[2].removeprefix("front_car_mex: ") for line in printed[:-1]]
    assert messages[0] == "inverse_dynamics at state 2: an angle is beyond the range of the sine and cosine"
    assert messages[1] == "q of inverse_dynamics has 4 rows, one column for each state; given are 3 x 1"
    assert messages[2] == "qd of inverse_dynamics has 3 states and those before it have 2"
    assert messages[3] == "q must be a matrix of real numbers (double)"
    assert messages[4] == "p has no m_1; start from front_car.parameters()"
    assert messages[5] == "there is no parameter l; front_car.parameters() has all"
    assert messages[6] == "p.L must be one real number"
    assert messages[7] == "p must be a struct, as front_car.parameters() gives it"
    # a row of numbers is one state
    assert printed[-1] == "1"


@pytest.mark.toolchain
@pytest.mark.slow
def test_words_of_the_language_are_names_of_a_model(tool: Callable[[str], str], tmp_path: Path) -> None:
    path = tmp_path / "until.yaml"
    path.write_text(NAMES, encoding="utf-8")
    assert matlab_fields(load_text(NAMES, "until.yaml")) == {
        "methods": "methods__",
        "properties": "properties_",
        "methods_": "methods_",
    }
    files = generate(path, Options(parts=("matlab",), verify=False), lambda _: None).files
    for name, text in files.items():
        assert isinstance(text, str)
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    lines = [
        "p = until_.parameters();",
        "p.properties_ = 7;",
        "G = until_.mass_matrix(zeros(2, 1), p); printf('%g ', G);",
        "help until_.parameters",
    ]
    printed = octave(tool, tmp_path / "matlab", "until_", lines)
    assert printed.startswith("2 0.25 0.25 7 ")
    assert "p.properties_  100 % of 'it'" in printed


@pytest.mark.toolchain
@pytest.mark.slow
def test_the_block_and_the_gateway_compile_without_a_warning(tool: Callable[[str], str], tmp_path: Path) -> None:
    """The block against the names it uses of headers that only Simulink has."""
    folder = written(shipped.model("front_car"), shipped.short("front_car", "float64"), tmp_path)
    (tmp_path / "simstruc.h").write_text(SIMSTRUC)
    (tmp_path / "cg_sfun.h").write_text(ENDING)
    headers = subprocess.run([tool("mkoctfile"), "-p", "INCFLAGS"], capture_output=True, text=True, check=True)
    included = [one.replace("-I", "-isystem") for one in headers.stdout.split()]
    for name, where in (("front_car_sfun.c", [f"-I{tmp_path}"]), ("front_car_mex.c", included)):
        flags = ["-std=c99", "-Wall", "-Wextra", "-pedantic", "-fsyntax-only", *where]
        made = subprocess.run([tool("gcc"), *flags, str(folder / name)], capture_output=True, text=True, check=True)
        assert made.stderr == ""


@pytest.mark.toolchain
@pytest.mark.slow
def test_the_documentations_example(tool: Callable[[str], str], tmp_path: Path) -> None:
    page = (shipped.ROOT / "docs/matlab.md").read_text(encoding="utf-8")
    (script,), (shown,) = (re.findall(rf"^```{kind}\n(.*?)^```$", page, re.M | re.S) for kind in ("matlab", "text"))
    folder = written(shipped.model("front_car"), shipped.programs("front_car")["float64"], tmp_path)
    path, _, rest = script.partition("build_front_car();\n")
    assert "generated/front_car/matlab" in path
    printed = octave(tool, folder, "front_car", rest.splitlines())
    assert [line for line in printed.splitlines() if line] == [line for line in shown.splitlines() if line]


def test_a_block_is_made_of_what_a_controller_works_out_alone() -> None:
    model, program = handmade.model(), handmade.program()
    assert BACKEND.around is not None
    block = f"matlab/{model.c_name}_sfun.c"
    assert block in BACKEND.around(model, [program])
    others = replace(program, kernels=tuple(kernel for kernel in program.kernels if kernel.name != BLOCK))
    assert block not in BACKEND.around(model, [others])
    assert BACKEND.around(model, [replace(program, kernels=())]) == {}
