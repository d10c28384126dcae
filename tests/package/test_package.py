"""The package builds with CMake, its single headers compile alone, and the packers of other systems take it."""

from __future__ import annotations

import json
import subprocess
import xml.dom.minidom
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
import yaml
from shipped import ROOT, SCALARS, model, programs, sources

from symgen.backends.backend import Variant
from symgen.backends.c import backend
from symgen.backends.c.plain import emit_c
from symgen.cli.main import main
from symgen.ir.kernel import Program
from symgen.model.model import Model
from symgen.package.files import FLAGS, emit_package

NAME = "skate"


@pytest.fixture(scope="module")
def package(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("package")
    made = [programs(NAME)[scalar] for scalar in SCALARS]
    c_files = {path: text for path, text in sources(NAME).items() if path.startswith("c/")}
    for path, text in emit_package(model(NAME), made, c_files).items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text)
    return folder / "package"


def run(*command: str | Path) -> str:
    made = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False)
    assert made.returncode == 0, made.stdout + made.stderr
    return made.stdout


@pytest.mark.parametrize("language", [["-std=c99"], ["-xc++", "-std=c++11"]])
def test_single_headers_are_complete(
    tool: Callable[[str], str], package: Path, tmp_path: Path, language: list[str]
) -> None:
    user = tmp_path / "user.c"
    user.write_text(
        "#define SKATE_IMPLEMENTATION\n#define SKATE_F_IMPLEMENTATION\n"
        '#include "skate.h"\n#include "skate_f.h"\n#include "skate.h"\n'
        "int main(void) {\n    skate_params_f p = skate_default_params_f();\n"
        "    float q[3] = {0.1f, 0.2f, 0.3f}, u[2];\n"
        "    return (int)skate_inverse_dynamics_f(q, q, q, &p, u);\n}\n"
    )
    flags = ["-Wall", "-Wextra", "-Wpedantic", "-Werror", *language]
    run(tool("gcc"), *flags, "-I", package / "src", user, "-o", tmp_path / "user", "-lm")
    run(tmp_path / "user")


@pytest.mark.campaign
def test_cmake_subdirectory(tool: Callable[[str], str], package: Path, tmp_path: Path) -> None:
    (tmp_path / "main.c").write_text(
        '#include "skate.h"\nint main(void) { return sizeof(skate_default_params()) > 0 ? 0 : 1; }\n'
    )
    (tmp_path / "CMakeLists.txt").write_text(
        f"cmake_minimum_required(VERSION 3.13)\nproject(app C)\nadd_subdirectory({package} skate)\n"
        "add_executable(app main.c)\ntarget_link_libraries(app PRIVATE symgen::skate)\n"
    )
    run(tool("cmake"), "-S", tmp_path, "-B", tmp_path / "b", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON")
    run(tool("cmake"), "--build", tmp_path / "b")
    run(tmp_path / "b/app")
    commands = json.loads((tmp_path / "b/compile_commands.json").read_text())
    assert all(all(flag in c["command"] for flag in FLAGS) for c in commands if "/src/skate" in c["file"])


@pytest.mark.campaign
def test_cross_build_with_cmake(tool: Callable[[str], str], package: Path, tmp_path: Path) -> None:
    core = "-mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16 -Os"
    compiler = tool("arm-none-eabi-gcc")
    given = ["-DCMAKE_SYSTEM_NAME=Generic", f"-DCMAKE_C_COMPILER={compiler}", f"-DCMAKE_C_FLAGS={core}"]
    run(tool("cmake"), "-S", package, "-B", tmp_path, "-DCMAKE_TRY_COMPILE_TARGET_TYPE=STATIC_LIBRARY", *given)
    run(tool("cmake"), "--build", tmp_path)
    listing = run(tool("arm-none-eabi-nm"), "-u", tmp_path / "libskate.a")
    single = listing.split("skate_f.c")[1].split("\n\n")[0]
    assert " U " not in single  # no library at all


def test_the_sources_fuse_nothing_without_flags(tool: Callable[[str], str], package: Path, tmp_path: Path) -> None:
    """Arduino passes no flags of a library; GCC would contract products and sums in its own dialect."""
    core = ["-mcpu=cortex-m4", "-mthumb", "-mfloat-abi=hard", "-mfpu=fpv4-sp-d16", "-O2", "-std=gnu11"]
    run(tool("arm-none-eabi-gcc"), *core, "-S", package / "src/skate_f.c", "-o", tmp_path / "out.s")
    text = (tmp_path / "out.s").read_text()
    assert "vmul" in text
    assert "vfma" not in text
    assert "vfms" not in text


def test_manifests_hold_what_their_systems_ask_for(package: Path) -> None:
    library = json.loads((package / "library.json").read_text())
    keys = "name version description keywords frameworks platforms headers build"
    assert list(library) == keys.split()
    assert all((package / "src" / header).is_file() for header in library["headers"])
    lines = (package / "library.properties").read_text().splitlines()
    given = dict(line.split("=", 1) for line in lines)
    wanted = "name version author maintainer sentence paragraph category url architectures ldflags includes"
    assert list(given) == wanted.split()
    component = yaml.safe_load((package / "idf_component.yml").read_text())
    assert component["version"] == library["version"]
    module = yaml.safe_load((package / "zephyr/module.yml").read_text())
    assert (package / module["build"]["kconfig"]).is_file()
    (pack,) = package.glob("*.pdsc")
    document = xml.dom.minidom.parse(str(pack))
    files = [node.getAttribute("name") for node in document.getElementsByTagName("file")]
    assert all((package / name).exists() for name in files)


def test_platformio_packs_it(tool: Callable[[str], str], package: Path, tmp_path: Path) -> None:
    run(tool("pio"), "pkg", "pack", package, "-o", tmp_path / "skate.tar.gz")


@pytest.mark.campaign
def test_the_esp_registry_packs_it(tool: Callable[[str], str], package: Path, tmp_path: Path) -> None:
    run(tool("compote"), "component", "pack", "--name", "skate", "--project-dir", package, "--dest-dir", tmp_path)
    assert list(tmp_path.glob("skate_*.tgz"))


def test_the_readme_speaks_the_names_of_the_model(package: Path) -> None:
    text = (package / "README.md").read_text()
    the_model = model(NAME)
    for name in (*(c.name for c in the_model.coordinates), *(p.name for p in the_model.parameters)):
        assert f"| {name} |" in text
    assert "skate_inverse_dynamics(q, qd, qdd, &p, u)" in text
    assert "SKATE_ANGLE_RANGE" in text


def made(out: Path, parts: str) -> int:
    few = ("--outputs", "inverse_dynamics", "--scalar", "float64", "--states", "8", "--quiet")
    return main([str(ROOT / f"models/{NAME}.yaml"), "--only", parts, *few, "--out", str(out)])


@pytest.mark.toolchain
@pytest.mark.campaign
def test_a_package_or_proofs_alone_are_verified_as_their_c_is(tool: Callable[[str], str], tmp_path: Path) -> None:
    tool("cc")
    certificates = []
    for parts in ("c", "package", "proof"):
        assert made(tmp_path / parts, parts) == 0
        certificates.append(json.loads((tmp_path / parts / NAME / "certificate.json").read_text()))
    assert certificates[0] == certificates[1] == certificates[2]
    assert certificates[1]["passed"]
    assert {record["target"] for record in certificates[1]["errors"]} >= {"C float64"}
    assert not (tmp_path / "package" / NAME / "c").exists()
    assert not (tmp_path / "proof" / NAME / "c").exists()


@pytest.mark.toolchain
@pytest.mark.parametrize("parts", ["package", "proof"])
@pytest.mark.campaign
def test_nothing_is_written_about_wrong_c(
    tool: Callable[[str], str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    parts: str,
) -> None:
    tool("cc")

    def wrong(model: Model, program: Program) -> dict[str, str]:
        return {path: text.replace(" - ", " + ") for path, text in emit_c(model, program).items()}

    variants = Variant(wrong), *backend.BACKEND.variants[1:]
    monkeypatch.setattr(backend, "BACKEND", replace(backend.BACKEND, variants=variants))
    assert made(tmp_path, parts) == 1
    assert "inverse_dynamics is left out in float64" in capsys.readouterr().err
    assert not list(tmp_path.rglob("*.[ch]"))
