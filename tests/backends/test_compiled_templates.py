"""Templates compiled at installation: the same text, refused when the template has changed, no path inside."""

from __future__ import annotations

import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from jinja2 import Environment, FileSystemLoader

from symgen.backends.compiled import FOLDER, CompiledTemplates, compile_templates


def _environment(folder: Path) -> Environment:
    return Environment(loader=FileSystemLoader(folder), bytecode_cache=CompiledTemplates(folder / FOLDER))


def test_compiled_templates_are_used_until_the_template_changes(tmp_path: Path) -> None:
    (tmp_path / "c").mkdir()
    template = tmp_path / "c/greeting.jinja"
    template.write_text("hello {{ view }}\n")
    compile_templates(_environment(tmp_path), tmp_path)
    (stored,) = (tmp_path / FOLDER).iterdir()
    assert str(tmp_path).encode() not in stored.read_bytes()

    # what is stored is what runs: its text, changed in place, shows
    stored.write_bytes(stored.read_bytes().replace(b"hello ", b"HELLO "))
    assert _environment(tmp_path).get_template("c/greeting.jinja").render(view=1) == "HELLO 1"
    template.write_text("goodbye {{ view }}\n")
    assert _environment(tmp_path).get_template("c/greeting.jinja").render(view=1) == "goodbye 1"


def test_templates_that_are_gone_are_removed(tmp_path: Path) -> None:
    for name in ("one", "two"):
        (tmp_path / f"{name}.jinja").write_text(name)
    compile_templates(_environment(tmp_path), tmp_path)
    (tmp_path / "one.jinja").unlink()
    compile_templates(_environment(tmp_path), tmp_path)
    assert [path.name.split(".")[0] for path in (tmp_path / FOLDER).iterdir()] == ["two"]
    assert _environment(tmp_path).get_template("two.jinja").render() == "two"


def test_without_compiled_templates_nothing_is_written(tmp_path: Path) -> None:
    (tmp_path / "one.jinja").write_text("one")
    assert _environment(tmp_path).get_template("one.jinja").render() == "one"
    assert [path.name for path in tmp_path.iterdir()] == ["one.jinja"]


def test_several_builds_at_a_time(tmp_path: Path) -> None:
    for number in range(20):
        (tmp_path / f"t{number}.jinja").write_text(f"{number} {{{{ view }}}}")
    with ThreadPoolExecutor(4) as pool:
        builds = [pool.submit(_compile, tmp_path) for _ in range(8)]
    for build in builds:
        build.result()
    assert len(list((tmp_path / FOLDER).iterdir())) == 20


def _compile(folder: Path) -> None:
    command = (
        "import sys; from pathlib import Path; from jinja2 import Environment, FileSystemLoader;"
        "from symgen.backends.compiled import compile_templates; folder = Path(sys.argv[1]);"
        "compile_templates(Environment(loader=FileSystemLoader(folder)), folder)"
    )
    subprocess.run([sys.executable, "-c", command, str(folder)], check=True)
