"""Folders of a model beside their user, beside other runs, and after runs that were killed."""

from __future__ import annotations

import hashlib
import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from generated_checksums import checksums_text

from symgen.output.journal import STAGING
from symgen.output.lock import LOCK, LockedError, folder_lock
from symgen.output.manifest import CHECKSUMS, FILES, read_manifest
from symgen.output.write import ForeignFileError, compare, recover_folders, write_files

OLD = {f"c/part{k}.c": f"old {k}\n" for k in range(3)} | {"c/gone.c": "old\n", "derivation.json": "{}\n"}
NEW = {f"c/part{k}.c": f"new {k}\n" for k in range(3)} | {"python/added.py": "new\n", "derivation.json": "[]\n"}


def tree(folder: Path) -> dict[str, str]:
    paths = (path for path in sorted(folder.rglob("*")) if path.is_file() and path.name != FILES)
    return {path.relative_to(folder).as_posix(): path.read_text() for path in paths}


def put(folder: Path, files: dict[str, str]) -> None:
    """Files as a user or git puts them there, without a list."""
    for path, text in files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text)


def silent(_message: str) -> None:
    return


def test_what_symgen_did_not_make_stays_and_is_told(tmp_path: Path) -> None:
    write_files(tmp_path, OLD)
    mine = {"c/main.c": "mine\n", "c/build/out.txt": "mine\n", "notes.txt": "mine\n"}
    put(tmp_path, mine)
    notices: list[str] = []
    write_files(tmp_path, NEW, notices.append)
    assert tree(tmp_path) == dict(sorted((NEW | mine).items()))
    assert notices == [
        f"{tmp_path}: notice: not made by symgen, or changed since, and left as they are: c/main.c, c/build/out.txt"
    ]
    assert compare(tmp_path, NEW) == ()


def test_files_of_the_user_named_like_measurements_are_told_and_those_measured_are_not(tmp_path: Path) -> None:
    write_files(tmp_path, OLD | {"report/m.pdf": "measured\n", "bench.json": "{}\n"})
    mine = {"c/bench.c": "mine\n", "c/target.ld": "mine\n", "report/motor.pdf": "mine\n"}
    put(tmp_path, mine)
    notices: list[str] = []
    write_files(tmp_path, OLD | {"report/m.html": "new\n"}, notices.append)
    assert {path: tree(tmp_path)[path] for path in mine} == mine
    assert [line.partition("they are: ")[2] for line in notices] == ["c/bench.c, c/target.ld, report/motor.pdf"]


def test_a_file_that_was_changed_since_is_not_removed(tmp_path: Path) -> None:
    write_files(tmp_path, OLD)
    (tmp_path / "c/gone.c").write_text("now mine\n")
    notices: list[str] = []
    write_files(tmp_path, NEW, notices.append)
    assert (tmp_path / "c/gone.c").read_text() == "now mine\n"
    assert "c/gone.c" in notices[0]


def test_a_file_of_the_user_is_not_replaced(tmp_path: Path) -> None:
    write_files(tmp_path, OLD)
    put(tmp_path, {"python/added.py": "mine\n"})
    before = tree(tmp_path)
    with pytest.raises(ForeignFileError, match=r": python/added\.py; .*--out") as caught:
        write_files(tmp_path, NEW)
    assert caught.value.filename == str(tmp_path)
    assert tree(tmp_path) == before


@pytest.mark.parametrize("listed", [True, False])
def test_edits_of_generated_files_are_not_replaced_until_they_are_moved(tmp_path: Path, listed: bool) -> None:
    """With a list, or with the checksums of a repository in its place."""
    write_files(tmp_path, OLD)
    if not listed:
        (tmp_path / FILES).unlink()
        put(tmp_path, {CHECKSUMS: checksums_text(OLD)})
    put(tmp_path, {path: OLD[path] + "/* tuned */\n" for path in ("c/part0.c", "c/part2.c", "c/gone.c")})
    before = tree(tmp_path)
    with pytest.raises(ForeignFileError, match=r"nothing is written: c/part0\.c, c/part2\.c; move or delete"):
        write_files(tmp_path, NEW, silent)
    assert tree(tmp_path) == before
    for name in ("part0.c", "part2.c"):
        (tmp_path / "c" / name).rename(tmp_path / name)
    write_files(tmp_path, NEW, silent)
    edits = {"part0.c": before["c/part0.c"], "part2.c": before["c/part2.c"], "c/gone.c": before["c/gone.c"]}
    assert tree(tmp_path) == tree(tmp_path) | NEW | edits


def test_an_edit_that_generation_makes_as_well_is_none(tmp_path: Path) -> None:
    write_files(tmp_path, OLD)
    put(tmp_path, {"c/part1.c": NEW["c/part1.c"]})
    write_files(tmp_path, NEW)
    assert tree(tmp_path) == dict(sorted(NEW.items()))


@pytest.mark.parametrize("listed", [True, False])
def test_what_git_checks_out_is_replaced_without_a_word(tmp_path: Path, listed: bool) -> None:
    """The checksums come with the files; a list, where there is one, is of another commit."""
    if listed:
        write_files(tmp_path, {path: f"other {text}" for path, text in OLD.items()})
    put(tmp_path, OLD | {CHECKSUMS: checksums_text(OLD)})
    notices: list[str] = []
    write_files(tmp_path, NEW | {"c/gone.c": "new\n"}, notices.append)
    assert tree(tmp_path) == tree(tmp_path) | NEW | {"c/gone.c": "new\n"}
    assert notices == []


def test_a_folder_without_a_list_and_checksums_is_the_users(tmp_path: Path) -> None:
    """Whatever lies in it: a derivation does not say who wrote the files beside it."""
    put(tmp_path, OLD | {".staging-ab12/new-3": "left behind by a version without lists"})
    with pytest.raises(ForeignFileError, match=r"c/part0\.c, c/part1\.c, c/part2\.c, derivation\.json; "):
        write_files(tmp_path, NEW)
    assert tree(tmp_path) == dict(sorted(OLD.items()))
    for path in set(OLD) & set(NEW):
        (tmp_path / path).unlink()
    notices: list[str] = []
    write_files(tmp_path, NEW, notices.append)
    assert tree(tmp_path) == dict(sorted((NEW | {"c/gone.c": "old\n"}).items()))
    assert "c/gone.c" in notices[0]


def test_a_measurement_in_a_folder_of_a_repository_leaves_its_files_to_symgen(tmp_path: Path) -> None:
    """What is made first, and begins the list, may be a measurement; the next one and the next run replace all."""
    put(tmp_path, OLD | {CHECKSUMS: checksums_text(OLD)})
    for text in ("{}\n", "[]\n"):
        write_files(tmp_path, {"target.json": text, "stress.svg": "<svg/>\n"})
    write_files(tmp_path, NEW, silent)
    assert tree(tmp_path) == tree(tmp_path) | NEW | {"target.json": "[]\n", "c/gone.c": "old\n"}
    assert read_manifest(tmp_path) is not None


def test_a_measurement_of_the_user_is_not_replaced(tmp_path: Path) -> None:
    put(tmp_path, OLD | {CHECKSUMS: checksums_text(OLD), "target.json": "mine\n"})
    with pytest.raises(ForeignFileError, match=r"target\.json"):
        write_files(tmp_path, {"target.json": "{}\n"})


def test_the_list_is_one_that_sha256sum_checks(tmp_path: Path) -> None:
    write_files(tmp_path, OLD)
    rows = [line.split("  ") for line in (tmp_path / FILES).read_text().splitlines() if not line.startswith("#")]
    assert {path: checksum for checksum, path in rows} == {
        path: hashlib.sha256(text.encode()).hexdigest() for path, text in OLD.items()
    }


def test_parts_that_are_not_written_stay_on_the_list(tmp_path: Path) -> None:
    write_files(tmp_path, OLD)
    write_files(tmp_path, {"python/added.py": "new\n"})
    write_files(tmp_path, {"c/part0.c": "new\n"})
    assert list(tree(tmp_path)) == ["c/part0.c", "derivation.json", "python/added.py"]


def test_models_that_differ_in_capitals_do_not_share_a_folder(tmp_path: Path) -> None:
    """As on a disk that knows no capitals, where both names lead to one folder."""
    write_files(tmp_path / "rob", OLD)
    (tmp_path / "rob").rename(tmp_path / "Rob")
    with pytest.raises(ForeignFileError, match="the model rob"):
        write_files(tmp_path / "Rob", NEW)
    assert tree(tmp_path / "Rob") == dict(sorted(OLD.items()))


STEPS = ("replace", "rename", "link", "unlink", "mkdir", "rmdir")


def killed(folder: Path, limit: int) -> int:
    """How many steps a process of its own took to write NEW; it is killed before the step of this number."""
    taken, writer = os.pipe()
    child = os.fork()
    if not child:
        # the copy of this process ends here whatever happens: what pytest would do at its end is the parent's
        try:
            _dying(limit, writer)
            write_files(folder, NEW, silent)
            os._exit(0)
        finally:
            os._exit(1)
    os.close(writer)
    with open(taken, "rb") as steps:
        count = len(steps.read())
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == (-signal.SIGKILL if count == limit else 0)
    return count


def _dying(limit: int, writer: int) -> None:
    """Every step tells that it comes, and the last one ends the process."""
    count = 0

    def counted(step: Callable[..., Any]) -> Callable[..., Any]:
        def call(*arguments: Any, **named: Any) -> Any:
            nonlocal count
            count += 1
            os.write(writer, b".")
            if count == limit:
                os.kill(os.getpid(), signal.SIGKILL)
            return step(*arguments, **named)

        return call

    for name in STEPS:
        setattr(os, name, counted(getattr(os, name)))


@pytest.mark.campaign
def test_a_run_killed_anywhere_leaves_what_the_next_start_mends(tmp_path: Path) -> None:
    """The folder then holds all earlier files or all new ones, and those of the user, and nothing else."""
    write_files(tmp_path / "whole", OLD)
    steps = killed(tmp_path / "whole", 10**9)
    assert steps > 15
    ways = set()
    for limit in range(1, steps + 1):
        folder = tmp_path / str(limit) / "m"
        write_files(folder, OLD)
        (folder / "c/main.c").write_text("mine\n")
        assert killed(folder, limit) == limit
        messages: list[str] = []
        recover_folders(folder.parent, messages.append)
        files = tree(folder)
        assert files.pop("c/main.c") == "mine\n"
        files.pop(LOCK, None)  # empty; free again
        assert files in (dict(sorted(OLD.items())), dict(sorted(NEW.items())))
        assert not (folder / STAGING).exists()
        ways.add((files == dict(sorted(NEW.items())), bool(messages)))
        write_files(folder, NEW, silent)
        assert tree(folder) == dict(sorted((NEW | {"c/main.c": "mine\n"}).items()))
    assert ways == {(False, False), (True, True), (True, False)}


def test_a_check_sees_the_mended_folder(tmp_path: Path) -> None:
    for limit in range(9, 18):
        folder = tmp_path / str(limit)
        write_files(folder, OLD)
        killed(folder, limit)
        differences = {compare(folder, files, silent) for files in (OLD, NEW)}
        assert () in differences


RACING = """
import sys
from pathlib import Path
from symgen.output.write import write_files
name = sys.argv[2]
for round in range(8):
    write_files(Path(sys.argv[1]), {f"c/{k}.c": f"{name} {round}\\n" for k in range(30)} | {f"c/{name}.h": "own\\n"})
"""


def test_runs_into_one_folder_leave_the_files_of_one(tmp_path: Path) -> None:
    folder = tmp_path / "m"
    runs = [subprocess.Popen([sys.executable, "-c", RACING, str(folder), name]) for name in ("one", "two", "three")]
    assert [run.wait(120) for run in runs] == [0, 0, 0]
    files = tree(folder)
    (text,) = {text for path, text in files.items() if not path.endswith(".h")}
    winner = text.split()[0]
    assert files.keys() == {*(f"c/{k}.c" for k in range(30)), f"c/{winner}.h"}
    assert not (folder / LOCK).exists()


HOLDING = """
import sys, time
from pathlib import Path
from symgen.output.lock import folder_lock
with folder_lock(Path(sys.argv[1]), print):
    print("held", flush=True)
    time.sleep(60)
"""


@pytest.mark.campaign
def test_a_lock_is_waited_for_told_and_free_after_death(tmp_path: Path) -> None:
    holder = subprocess.Popen([sys.executable, "-c", HOLDING, str(tmp_path)], stdout=subprocess.PIPE, text=True)
    assert holder.stdout is not None
    with holder.stdout:
        assert holder.stdout.readline() == "held\n"
        messages: list[str] = []
        with pytest.raises(LockedError, match=f"process {holder.pid}"), folder_lock(tmp_path, messages.append, 1.0):
            pytest.fail("locked twice")
        assert messages == [f"{tmp_path}: waiting for another run of symgen (process {holder.pid}) that writes here"]
        holder.kill()
        holder.wait()
    write_files(tmp_path, NEW)
    assert tree(tmp_path) == dict(sorted(NEW.items()))


def test_a_journal_moves_nothing_from_or_to_elsewhere(tmp_path: Path) -> None:
    folder, outside = tmp_path / "m", tmp_path / "secret"
    outside.write_text("theirs\n")
    for moves, removals in (({"new-0": "../secret"}, []), ({"../../secret": "c/a.c"}, []), ({}, ["../secret"])):
        (folder / STAGING).mkdir(parents=True)
        (folder / STAGING / "new-0").write_text("mine\n")
        journal = json.dumps({"moves": moves, "removals": removals})
        (folder / STAGING / "journal.forward").write_text(journal)
        recover_folders(tmp_path)
        assert outside.read_text() == "theirs\n"
        assert not (folder / STAGING).exists()


@pytest.mark.skipif(os.geteuid() == 0 if hasattr(os, "geteuid") else True, reason="root may write anywhere")
def test_a_folder_that_cannot_be_written_can_be_compared(tmp_path: Path) -> None:
    write_files(tmp_path, OLD)
    tmp_path.chmod(0o555)
    try:
        assert compare(tmp_path, OLD) == ()
    finally:
        tmp_path.chmod(0o755)
