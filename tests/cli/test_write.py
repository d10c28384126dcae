"""A model's folder changes as a whole or not at all."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from symgen.diagnostics import SymgenBug
from symgen.output.write import compare, write_files

FILES_MADE = ".symgen-files"
FILES = {"c/m.h": "header\n", "c/m.c": "source\n", "python/m.py": "python\n", "derivation.json": "{}\n"}


def tree(folder: Path) -> dict[str, str]:
    """The files but the list of them; nothing else of symgen's is left."""
    files = {p.relative_to(folder).as_posix(): p.read_text() for p in sorted(folder.rglob("*")) if p.is_file()}
    assert {path for path in files if path.startswith(".")} <= {FILES_MADE}
    return {path: text for path, text in files.items() if path != FILES_MADE}


def test_writes_and_returns_the_paths(tmp_path: Path) -> None:
    written = write_files(tmp_path / "out", FILES)
    assert tree(tmp_path / "out") == dict(sorted(FILES.items()))
    assert written == tuple(tmp_path / "out" / path for path in FILES)
    assert compare(tmp_path / "out", FILES) == ()


def test_stale_files_go_and_measured_and_other_files_stay(tmp_path: Path) -> None:
    write_files(tmp_path, FILES | {"c/old.c": "old", "report/m.pdf": b"%PDF", "certificate.json": "{}"})
    (tmp_path / "notes.txt").write_text("mine")
    write_files(tmp_path, {"c/m.h": "header\n"})
    assert list(tree(tmp_path)) == [
        "c/m.h",
        "certificate.json",
        "derivation.json",
        "notes.txt",
        "python/m.py",
        "report/m.pdf",
    ]


def test_unchanged_files_are_not_touched(tmp_path: Path) -> None:
    write_files(tmp_path, FILES)
    before = (tmp_path / "c/m.h").stat().st_mtime_ns
    write_files(tmp_path, FILES | {"c/m.c": "new\n"})
    assert (tmp_path / "c/m.h").stat().st_mtime_ns == before
    assert (tmp_path / "c/m.c").read_text() == "new\n"


@pytest.mark.parametrize("failing", range(1, 4))
@pytest.mark.parametrize("error", [OSError, KeyboardInterrupt])
def test_a_failure_leaves_the_earlier_output_whole(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, failing: int, error: type[BaseException]
) -> None:
    write_files(tmp_path, FILES | {"c/old.c": "old"})
    before = tree(tmp_path)
    replace, calls = os.replace, 0

    def refuse(source: Path, target: Path) -> None:
        nonlocal calls
        calls += 1
        if calls == failing:
            raise error
        replace(source, target)

    monkeypatch.setattr(os, "replace", refuse)
    with pytest.raises(error):
        write_files(tmp_path, dict.fromkeys(FILES, "new") | {"c/added.c": "new"})
    assert tree(tmp_path) == before


def test_a_failure_while_staging_writes_nothing(tmp_path: Path) -> None:
    write_files(tmp_path, FILES)
    (tmp_path / "report").write_text("a file where a folder must be")
    before = tree(tmp_path)
    with pytest.raises(OSError, match="report"):
        write_files(tmp_path, {"c/m.c": "new", "report/m.html": "new"})
    assert tree(tmp_path) == before


@pytest.mark.parametrize("path", ["../x", "/etc/x", "c/../../x", "", ".git/x", "c\\x"])
def test_nothing_is_written_outside_the_folder(tmp_path: Path, path: str) -> None:
    with pytest.raises(SymgenBug, match="no path inside"):
        write_files(tmp_path / "out", {path: "x"})
    assert not (tmp_path / "out").exists()


def test_compare_lists_every_difference(tmp_path: Path) -> None:
    write_files(tmp_path, FILES | {"c/old.c": "old", "report/m.pdf": b"%PDF"})
    (tmp_path / "c/m.c").write_text("other\n")
    (tmp_path / "python/m.py").unlink()
    assert compare(tmp_path, FILES | {"certificate.json": "measured"}) == (
        f"{tmp_path}/c/m.c: differs from line 1",
        f"{tmp_path}/c/old.c: no longer generated",
        f"{tmp_path}/python/m.py: missing",
    )
