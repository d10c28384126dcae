"""Names that hurt build everywhere: after every header of a system, in C, C++, Python, CMake, beside other models."""

from __future__ import annotations

import itertools
import re
import subprocess
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path

import numpy as np
import pytest
from generated_python import load_generated
from shipped import sparing

from symgen.generation.results import Options
from symgen.model.expressions.names import RESERVED as REFUSED
from symgen.pipeline import generate

pytestmark = pytest.mark.toolchain
OTHERS = ("clang", "arm-none-eabi-gcc", "riscv64-unknown-elf-gcc")
STRICT = ["-Wall", "-Wextra", "-Wconversion", "-Werror"]


def words(text: str) -> list[str]:
    return text.split()


HEADERS = words(
    """assert complex ctype errno fenv float inttypes iso646 limits locale math setjmp signal stdalign stdarg stdatomic
    stdbool stddef stdint stdio stdlib stdnoreturn string tgmath time wchar wctype endian fcntl sys/param
    sys/stat sys/time sys/types unistd"""
)
# Bare-metal libraries have some of these, and not all of what they include.
SYSTEM = words(
    """byteswap dirent netinet/in poll pthread sched search semaphore sys/ioctl sys/mman sys/socket sys/sysmacros
    sys/uio sys/un sys/wait sysexits syslog termios threads ucontext"""
)
# Not in C++: what is an operator or a template there.
C_ONLY = {"complex", "stdatomic", "stdnoreturn", "tgmath", "iso646", "stdalign"}
ARDUINO = """
#define F(text) (text)
#define HIGH 0x1
#define LOW 0x0
#define INPUT 0x0
#define PI 3.1415926535897932384626433832795
#define EULER 2.718281828459045235360287471352
#define min(a, b) ((a) < (b) ? (a) : (b))
#define max(a, b) ((a) > (b) ? (a) : (b))
#define abs(x) ((x) > 0 ? (x) : -(x))
#define round(x) ((x) >= 0 ? (long)((x) + 0.5) : (long)((x)-0.5))
#define constrain(x, low, high) ((x) < (low) ? (low) : ((x) > (high) ? (high) : (x)))
#define radians(x) ((x) * 0.017453292519943295)
#define degrees(x) ((x) * 57.29577951308232)
#define sq(x) ((x) * (x))
#define bit(b) (1UL << (b))
#define word(...) makeWord(__VA_ARGS__)
#define interrupts() sei()
#define lowByte(w) ((w)&0xff)
#define A0 14
#define B0 0
#define B1 1
#define B101 5
#define SDA 18
#define SS 10
#define LED_BUILTIN 13
#define PORTB _SFR_IO8(0x05)
#define PB0 0
#define DDRB _SFR_IO8(0x04)
#define TIM2 ((TIM_TypeDef *)0x40000000)
#define ADC1 ((ADC_TypeDef *)0x40012000)
#define SPI SPI1
#define linux 1
#define unix 1
#define far
#define near
#define interface struct
#define slots
#define emit
#define Q_OS 1
"""
NAMES = words(
    """I F B0 B1 B101 A0 PI EULER HIGH LOW INPUT SDA SS SPI TIM2 ADC1 PORTB DDRB PB0 LED_BUILTIN abs min max round
    constrain radians degrees sq bit word interrupts lowByte far near interface slots emit linux unix major minor
    makedev errno complex imaginary bool true false self lambda None np NAN INFINITY isnan isinf signbit
    fpclassify BIG_ENDIAN LITTLE_ENDIAN BYTE_ORDER DBL_EPSILON FLT_MAX INT_MAX CHAR_BIT EPERM EIO EINVAL SIGINT
    PATH_MAX BUFSIZ EOF NULL R_OK X_OK O_RDWR S_IRUSR CREAD CR1 ECHO TAB1 HZ MAX MIN NAN_ M_PI M_E M_1_PI st_mtime
    si_addr sa_handler s6_addr h_errno htons ntohl va_start offsetof alignas noreturn thread_local atomic_load
    stdin stdout stderr signals y0 y1 jn gamma signgam drem significand index time read write stat exit main fma
    hypot cbrt float_t double_t size_t uint8_t wchar_t byte boolean print list dict type object field Status
    Parameters PARAMETERS StateError inverse_dynamics mass_matrix result entries batch status rest term angle sine
    cosine prepared value stride count unused this template class new delete and or not xor fn impl mut match loop
    move"""
)
ALLOWED = [name for name in dict.fromkeys(NAMES) if name not in REFUSED]


def groups(size: int) -> Iterator[tuple[str, ...]]:
    """All names in groups of one size; the last is filled up."""
    filled = [*ALLOWED, *(f"a_{k}" for k in range(-len(ALLOWED) % size))]
    return zip(*[iter(filled)] * size, strict=True)


def parameters_text(name: str, names: Iterable[str]) -> str:
    """A model with parameters of these names."""
    values = ", ".join(f"{parameter}: 2" for parameter in names)
    terms = " + ".join(f"{parameter}*cos({k + 2}*phi)" for k, parameter in enumerate(names))
    return (
        f"model: {name}\ncoordinates: {{phi: {{}}, xi: {{}}}}\nparameters: {{{values}}}\n"
        f"kinetic_energy: (phi_dot**2 + xi_dot**2)/2\npotential_energy: {terms}\n"
        "inputs:\n  one: {acts_on: {phi: 1}}\n  two: {acts_on: {xi: 1}}\n"
    )


def places_text(name: str, names: Sequence[str]) -> str:
    """A model with coordinates, definitions, a row and inputs of these names."""
    x, y, a, b, f, g = names
    return (
        f"model: {name}\ncoordinates: {{{x}: {{}}, {y}: {{}}}}\nparameters: {{mass: 2}}\n"
        f"definitions: {{{a}: mass*sin({x}), {b}: cos({y})}}\n"
        f"kinetic_energy: mass*({x}_dot**2 + {y}_dot**2)/2 + {a}*{x}_dot*{y}_dot/9\n"
        f"potential_energy: {a}*{b}\n"
        f"inputs:\n  {f}: {{acts_on: {{{x}: 1, {y}: 3}}}}\n  {g}: {{acts_on: {{{y}: 1}}}}\n"
    )


def made(folder: Path, text: str, name: str, part: str) -> Path:
    """The folder with the C and another part of a model text."""
    path = folder / f"{name}.yaml"
    path.write_text(text)
    result = generate(path, Options(parts=("c", part), verify=False), lambda _: None)
    for file, content in result.files.items():
        (folder / name / file).parent.mkdir(parents=True, exist_ok=True)
        (folder / name / file).write_text(str(content))
    return folder / name


def surroundings(folder: Path) -> Path:
    """Every header there is, then the macros of microcontrollers, Windows and Qt that are none yet."""
    lines = ["#pragma GCC system_header", "#ifndef _GNU_SOURCE", "#define _GNU_SOURCE", "#endif"]
    for header in [*HEADERS, *SYSTEM]:
        include = [f"#if __has_include(<{header}.h>)", f"#include <{header}.h>", "#endif"]
        if header in C_ONLY or header in SYSTEM:
            include = ["#ifndef __cplusplus" if header in C_ONLY else "#ifdef __linux__", *include, "#endif"]
        lines += include
    for line in ARDUINO.strip().splitlines():
        lines += [f"#ifndef {re.split(r'[ (]', line)[1]}", line, "#endif"]
    path = folder / "surroundings.h"
    path.write_text("\n".join(lines) + "\n")
    return path


def compiled(tool: Callable[[str], str], compiler: str, before: Path, *files: Path) -> None:
    language = ["-xc++", "-std=gnu++17"] if compiler.endswith("++") else ["-std=gnu11"]
    specs = ["--specs=picolibc.specs", "-march=rv32imac", "-mabi=ilp32"] if compiler.startswith("riscv") else []
    flags = [*specs, *language, *STRICT, "-include", str(before), "-fsyntax-only", *map(str, files)]
    done = subprocess.run([tool(compiler), *flags], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[:3000]


@pytest.fixture(scope="module")
def hurting(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with models that have every name as a parameter, and every name in another place."""
    folder = tmp_path_factory.mktemp("hurting")
    for number, names in enumerate(groups(12)):
        made(folder, parameters_text(f"parameters{number}", names), f"parameters{number}", "python")
    for number, names in enumerate(groups(6)):
        made(folder, places_text(f"places{number}", names), f"places{number}", "python")
    return folder


@pytest.mark.parametrize("compiler", sparing(["gcc", "g++", *OTHERS], OTHERS))
def test_every_name_compiles_after_every_header(
    tool: Callable[[str], str], hurting: Path, tmp_path: Path, compiler: str
) -> None:
    tool(compiler)
    alone = sorted(hurting.glob("*/c/*_batch.c"))  # each is a program of its own; a few of them are enough
    user = tmp_path / "user.c"
    together = sorted(set(hurting.glob("*/c/*.c")) - set(hurting.glob("*/c/*_batch*.c")))
    user.write_text("".join(f'#include "{file}"\n' for file in together))
    compiled(tool, compiler, surroundings(tmp_path), user, *alone[::9])


def test_python_takes_every_name(hurting: Path, tool: Callable[[str], str]) -> None:
    tool("cc")
    q = np.random.default_rng(5).normal(size=(7, 2))
    for number, names in enumerate(groups(12)):
        module = load_generated(hurting / f"parameters{number}/python/parameters{number}.py")
        p = module.Parameters(**{name: 1.0 + k / 7 for k, name in enumerate(names)})
        ours = module.inverse_dynamics(q, q, q, p)
        assert np.isfinite(ours).all()
        if number == 0:
            assert ours.tobytes() == module.compile().inverse_dynamics(q, q, q, p).tobytes()
    for number, _ in enumerate(groups(6)):
        module = load_generated(hurting / f"places{number}/python/places{number}.py")
        assert np.isfinite(module.inverse_dynamics(q, q, q)).all()


SIDE_BY_SIDE = words(
    """rob rob_f Rob ROB rob_F rob_batch rob_prepared rob_sc rob_sc_f rob_minimal rob_default rob_weighted
    rob_actuator rob_projected rob_inverse_dynamics rob_multipliers rob_params rob_status rob_trig rob_model
    rob_f_model rob_f_model_model x hal m math"""
)


@pytest.fixture(scope="module")
def neighbours(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Models side by side, with all quantities in the campaign of tests; their files are called the same with one."""
    outputs = "all" if request.config.getoption("markexpr") == "campaign" else "[inverse_dynamics]"
    folder = tmp_path_factory.mktemp("neighbours")
    for name in SIDE_BY_SIDE:
        row = "constraints:\n  geometric: {row: sin(alpha) - beta}\n"
        text = places_text(name, words("alpha beta gain share lift push")) + row
        made(folder, f"{text}outputs: {outputs}\n", name, "package")
    return folder


@pytest.mark.campaign
@pytest.mark.parametrize("compiler", ["gcc", "g++"])
def test_models_live_in_one_program(tool: Callable[[str], str], neighbours: Path, compiler: str) -> None:
    """All headers of all kinds in one file, then all single headers with their definitions; no file name is shared."""
    headers = sorted(neighbours.glob("*/c/*.h"))
    user = neighbours / "user.c"
    user.write_text("".join(f'#include "{header}"\n' for header in headers))
    compiled(tool, compiler, surroundings(neighbours), user)
    singles = sorted(neighbours.glob("*/package/src/*.h"))
    macros = [re.findall(r"#if defined\((\w+_IMPLEMENTATION)\)", single.read_text())[0] for single in singles]
    assert len(set(macros)) == len(macros)
    user.write_text(
        "".join(f"#define {macro}\n" for macro in macros) + "".join(f'#include "{single}"\n' for single in singles)
    )
    compiled(tool, compiler, surroundings(neighbours), user)


def test_a_model_that_is_called_otherwise_is_told_so(tmp_path: Path) -> None:
    messages = {}
    for name in ("rob", "rob_f"):
        (tmp_path / f"{name}.yaml").write_text(places_text(name, words("alpha beta gain share lift push")))
        result = generate(tmp_path / f"{name}.yaml", Options(parts=("c",), verify=False), lambda _: None)
        messages[name] = [notice.message for notice in result.notices]
    assert messages["rob"] == []
    (message,) = messages["rob_f"]
    assert "rob_f_model" in message


@pytest.mark.campaign
def test_files_of_models_differ_but_for_capitals(neighbours: Path) -> None:
    """A disk without capitals holds `rob` or `Rob`, in folders of their own anyway."""
    stems = {name: {file.stem for file in (neighbours / name / "c").glob("*.h")} for name in SIDE_BY_SIDE}
    for one, other in itertools.combinations(SIDE_BY_SIDE, 2):
        if one.lower() != other.lower():
            assert not {stem.lower() for stem in stems[one]} & {stem.lower() for stem in stems[other]}, (one, other)
        assert not stems[one] & stems[other]


@pytest.mark.campaign
def test_packages_build_beside_each_other(tool: Callable[[str], str], neighbours: Path, tmp_path: Path) -> None:
    folders = [neighbours / name / "package" for name in words("rob rob_f Rob rob_minimal x m math")]
    names = [re.findall(r"add_library\((\w+) STATIC", (folder / "CMakeLists.txt").read_text())[0] for folder in folders]
    added = "".join(f'add_subdirectory("{folder}" {k})\n' for k, folder in enumerate(folders))
    aliases = " ".join(f"symgen::{name}" for name in names)
    headers = "".join(f'#include "{name}.h"\n' for name in names if name.lower() != "rob" or name == "rob")
    (tmp_path / "main.c").write_text(f"{headers}int main(void) {{ return (int)sizeof(m_model_params) - 8; }}\n")
    (tmp_path / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.13)\nproject(app C)\nenable_testing()\n" + added
        + f"add_executable(app main.c)\ntarget_link_libraries(app PRIVATE {aliases})\n"
    )
    for command in ([tool("cmake"), "-S", ".", "-B", "b"], [tool("cmake"), "--build", "b"], ["b/app"]):
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
