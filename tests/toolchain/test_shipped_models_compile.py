"""Every shipped model compiles without a warning: gcc and clang, C99 and C++11, both scalar types."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
import shipped

from symgen.output.write import write_files

pytestmark = pytest.mark.toolchain
STRICT = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wdouble-promotion", "-Wshadow", "-Werror"]
DOUBLE = re.compile(r"\b(v?cvtss2sd|v?cvtsd2ss|v?(?:add|sub|mul|div|sqrt|mov|ucomi|comi)sd|fcvt)\b")
COMPILERS = {
    "gcc": ["-std=c99"],
    "g++": ["-xc++", "-std=c++11", "-fsyntax-only"],
    "clang": ["-std=c99", "-fsyntax-only"],
    "clang++": ["-xc++", "-std=c++11", "-fsyntax-only"],
}
# Their code is longer than that of the others, and made of the same statements.
LATER = ("chain16", "chain32", "gough_loops", "gough_stewart", "rapkm_2rrr_rr", "rapkm_two_drives", "three_rrr")


@pytest.mark.parametrize(
    ("name", "compiler"),
    [
        shipped.together(n, compiler, marks=[pytest.mark.campaign] if n in LATER else ())
        for n in shipped.ALL
        for compiler in COMPILERS
        if n in shipped.SWEPT or compiler == "clang"
    ],
)
def test_no_warning(tool: Callable[[str], str], tmp_path: Path, name: str, compiler: str) -> None:
    write_files(tmp_path, {path: text for path, text in shipped.generated(name).items() if path.startswith("c/")})
    for source in sorted((tmp_path / "c").glob("*.c")):
        flags = [*STRICT, *COMPILERS[compiler]]
        if compiler == "gcc":  # the float32 object is looked into below
            flags += ["-O1"] if source.stem.endswith("_f") else ["-fsyntax-only"]
        if source.stem.endswith("_f"):
            flags += ["-Wfloat-conversion"] + (["-Wunsuffixed-float-constants"] if compiler == "gcc" else [])
        command = [tool(compiler), *flags, "-c", str(source), "-o", str(tmp_path / f"{source.stem}.o")]
        made = subprocess.run(command, capture_output=True, text=True, check=False)
        assert made.returncode == 0, made.stderr
    if compiler == "gcc":
        command = [tool("objdump"), "-d", str(tmp_path / f"{name}_f.o")]
        text = subprocess.run(command, capture_output=True, text=True, check=True).stdout
        assert not DOUBLE.search(text)
