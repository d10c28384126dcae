"""The switch of a folder from earlier to new files, which a run that is killed leaves to the next one to finish.

New and earlier files lie in a staging folder. A journal of what is to be moved and removed is put beside them before
the first of them moves; it can be carried out again from any point. An error puts the earlier files back, by a journal
too.
"""

from __future__ import annotations

import os
import re
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path

from symgen.output.manifest import FILES, is_inside
from symgen.records import dataclass

STAGING = ".symgen-staging"
FORWARD, BACK = "journal.forward", "journal.back"
_STAGED = re.compile(r"(new|old)-\d+")
_FORMER = ".staging-*"  # as versions without a journal called theirs


@dataclass(frozen=True, slots=True)
class Switch:
    """Staged files by the path that each goes to, and paths to be removed; paths are relative POSIX paths."""

    moves: Mapping[str, str]
    removals: Sequence[str]


def stage(directory: Path, contents: Sequence[bytes]) -> tuple[str, ...]:
    """Puts contents into a new staging folder, and returns their names there."""
    staging = directory / STAGING
    staging.mkdir()
    names = tuple(f"new-{index}" for index in range(len(contents)))
    for name, content in zip(names, contents, strict=True):
        (staging / name).write_bytes(content)
    return names


def unstage(directory: Path) -> None:
    """Removes the staging folder, unless a switch in it waits to be finished."""
    staging = directory / STAGING
    if not any((staging / name).exists() for name in (FORWARD, BACK)):
        _remove(staging)


def perform(directory: Path, switch: Switch) -> None:
    """Switches; an error puts back what was there and is raised again."""
    staging = directory / STAGING
    paths = (*switch.moves.values(), *switch.removals)
    earlier = {f"old-{k}": path for k, path in enumerate(paths) if os.path.lexists(directory / path)}
    for name, path in earlier.items():
        _copy(directory / path, staging / name)
    added = [path for path in switch.moves.values() if path not in earlier.values()]
    _note(staging / FORWARD, switch)
    try:
        _carry_out(directory, switch)
    except BaseException:
        _note(staging / BACK, Switch(earlier, added))
        _carry_out(directory, Switch(earlier, added))
        (staging / FORWARD).unlink()
        (staging / BACK).unlink()
        raise
    (staging / FORWARD).unlink()


def is_pending(directory: Path) -> bool:
    """Whether a run that was killed left something behind."""
    return (directory / STAGING).is_dir()


def _remove(folder: Path) -> None:
    from shutil import rmtree

    rmtree(folder, ignore_errors=True)


def recover(directory: Path) -> str:
    """Finishes what a killed run began: the folder holds all of its files, or all of the earlier ones.

    Returns what to tell of it, or nothing.
    """
    staging = directory / STAGING
    notice = ""
    for name, meaning in ((BACK, "the earlier files are back"), (FORWARD, "its files are all in place now")):
        switch = _read(staging / name)
        if switch is not None:
            _carry_out(directory, switch)
            notice = f"{directory}: an earlier run was ended while it wrote; {meaning}"
            break
    _remove(staging)
    for former in directory.glob(_FORMER):
        if former.is_dir() and all(_STAGED.fullmatch(name) for name in os.listdir(former)):
            _remove(former)
    return notice


def _carry_out(directory: Path, switch: Switch) -> None:
    """What has been moved or removed already is passed over."""
    for name, path in switch.moves.items():
        source, target = directory / STAGING / name, directory / path
        if os.path.lexists(source):
            target.parent.mkdir(parents=True, exist_ok=True)
            os.replace(source, target)
    for path in switch.removals:
        (directory / path).unlink(missing_ok=True)


def _copy(path: Path, copy: Path) -> None:
    """The same file under a second name, or else its contents."""
    try:
        os.link(path, copy, follow_symlinks=False)
    except (OSError, NotImplementedError):
        from shutil import copy2

        copy2(path, copy, follow_symlinks=False)


def _note(journal: Path, switch: Switch) -> None:
    """A journal is there as a whole or not at all."""
    import json

    draft = journal.with_suffix(".draft")
    draft.write_text(json.dumps({"moves": dict(switch.moves), "removals": list(switch.removals)}), encoding="utf-8")
    os.rename(draft, journal)


def _read(journal: Path) -> Switch | None:
    """A journal as symgen writes it: nothing else is carried out."""
    import json

    with suppress(OSError, ValueError, KeyError, TypeError, AttributeError):
        record = json.loads(journal.read_text(encoding="utf-8"))
        moves, removals = dict(record["moves"]), list(record["removals"])
        paths = (*moves.values(), *removals)
        if all(map(_STAGED.fullmatch, moves)) and all(path == FILES or is_inside(path) for path in paths):
            return Switch(moves, removals)
    return None
