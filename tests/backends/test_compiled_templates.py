"""Templates compiled at installation: the same text, refused when the template has changed, no path inside."""

from __future__ import annotations

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
