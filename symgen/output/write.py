"""The only writer: a model's folder changes as a whole or not at all, and what symgen did not make stays.

See docs/decisions/0039: a lock, a list of the files made, and a journal of the switch.
"""

from __future__ import annotations

import errno
import os
import signal
import sys
from collections.abc import Callable, Collection, Iterator, Mapping
from contextlib import contextmanager, nullcontext
from fnmatch import fnmatch
from pathlib import Path, PurePosixPath

from symgen.diagnostics import SymgenBug
from symgen.output.journal import Switch, is_pending, perform, recover, stage, unstage
from symgen.output.lock import folder_lock
from symgen.output.manifest import FILES, checksum_of, is_inside, manifest_text, read_checksums, read_manifest

MEASURED = (
    "certificate.json", "*.pdf", "*.measured.html", "*.measured.tex", "bench.*", "stress.*", "target.*", "proof.json",
    "simulation.*", "identified.*", "*.identified.yaml", ".symgen-*",
)
_HELD_SIGNALS = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))
# Files that are named; the others are counted.
_MOST_LISTED = 5
_NOT_AS_MADE = "not made by symgen, or changed since,"
_changed: list[Path] = []

Notify = Callable[[str], None]


class ForeignFileError(OSError):
    """A file that symgen did not make, or that was changed since, stands where one of its files would go."""


def is_measured(path: str) -> bool:
    """Whether a file is written by a measurement: never compared, never removed as stale."""
    return any(fnmatch(PurePosixPath(path).name, pattern) for pattern in MEASURED)


def begin_writing() -> None:
    """A run begins: it has changed no folder."""
    _changed.clear()


def changed_folders() -> tuple[Path, ...]:
    """The folders that this run has changed, each as a whole."""
    return tuple(dict.fromkeys(_changed))


def _complain(message: str) -> None:
    print(message, file=sys.stderr)


def write_files(directory: Path, files: Mapping[str, str | bytes], notify: Notify = _complain) -> tuple[Path, ...]:
    """Puts the files (POSIX paths relative to `directory`, named after its model) on disk and returns their paths.

    Everything is staged first; then the files change places with interrupts held back. A failure leaves the folder as
    it was, and a run that is killed leaves a switch that the next one finishes. Of the sub-folders that `files` fill,
    earlier files that symgen made and makes no more are removed. Files that it did not make, or that were changed
    since, stay and are told. Raises OSError when the disk refuses, ForeignFileError where such a file would have to be
    replaced, LockedError when another run does not end.
    """
    contents = {_checked(path): _bytes(content) for path, content in files.items()}
    directory.mkdir(parents=True, exist_ok=True)
    with folder_lock(directory, notify):
        if done := recover(directory):
            notify(done)
        known = _known(directory)
        _refuse_to_replace(directory, contents, known)
        stale = _stale(directory, contents, known)
        removed = [path for path in stale if checksum_of(_read(directory / path) or b"") == known[path]]
        kept = {path: checksum for path, checksum in known.items() if path not in stale and _exists(directory / path)}
        made = kept | {path: checksum_of(content) for path, content in contents.items()}
        contents[FILES] = manifest_text(directory.name, made).encode()
        _replace(directory, contents, removed)
        if others := _others(directory, contents, made):
            more = f" and {len(others) - _MOST_LISTED} more" if len(others) > _MOST_LISTED else ""
            shown = ", ".join(others[:_MOST_LISTED]) + more
            notify(f"{directory}: notice: {_NOT_AS_MADE} and left as they are: {shown}")
    return tuple(directory / path for path in contents if path != FILES)


def compare(directory: Path, files: Mapping[str, str | bytes], notify: Notify = _complain) -> tuple[str, ...]:
    """Differences between the disk and `files`, in content and in the set of files that symgen made.

    Measured files do not count.
    """
    expected = {_checked(path): _bytes(content) for path, content in files.items() if not is_measured(path)}
    differences = []
    with folder_lock(directory, notify) if directory.is_dir() else nullcontext():
        if done := recover(directory):
            notify(done)
        for path, content in expected.items():
            on_disk = _read(directory / path)
            if on_disk is None:
                differences.append(f"{directory / path}: missing")
            elif on_disk != content:
                differences.append(f"{directory / path}: differs{_first_difference(on_disk, content)}")
        _, known = read_manifest(directory) or ("", {})
        differences += [f"{directory / path}: no longer generated" for path in _stale(directory, expected, known)]
    return tuple(sorted(differences))


def recover_folders(out: Path, notify: Notify = _complain) -> None:
    """Finishes what killed runs left in the folders of `out`."""
    try:
        pending = [folder for folder in out.iterdir() if is_pending(folder)]
    except OSError:
        return
    for folder in pending:
        with folder_lock(folder, notify):
            if done := recover(folder):
                notify(done)


def _known(directory: Path) -> dict[str, str]:
    """Checksums by path of what symgen made, as the folder's list has them."""
    name, known = read_manifest(directory) or ("", {})
    if name != directory.name and name.lower() == directory.name.lower():
        message = f"here are the files of the model {name}: this disk knows no capitals; rename one, or choose --out"
        raise ForeignFileError(errno.EEXIST, message, str(directory))
    return known


def _refuse_to_replace(directory: Path, contents: Mapping[str, bytes], known: Mapping[str, str]) -> None:
    """ForeignFileError where a file would be replaced that is not, byte for byte, what symgen made.

    What it made has the checksum of the list, or of files.sha256, which a repository keeps in place of the list. A
    header says nothing: edited files have it, too. They are refused as well, since a notice comes when they are lost,
    and a copy beside them would be compiled by whoever takes `c/*`, or be lost in the next run.
    """
    kept = read_checksums(directory)
    foreign = []
    for path, content in contents.items():
        if _exists(directory / path):
            on_disk = _read(directory / path)
            made = on_disk is not None and checksum_of(on_disk) in (known.get(path), kept.get(path))
            if on_disk != content and not made:
                foreign.append(path)
    if foreign:
        remedy = "move or delete what is named, or choose another folder (--out)"
        message = f"{_NOT_AS_MADE} and not replaced, so nothing is written: {', '.join(foreign)}; {remedy}"
        raise ForeignFileError(errno.EEXIST, message, str(directory))


def _replace(directory: Path, contents: Mapping[str, bytes], removed: list[str]) -> None:
    changed = [path for path, content in contents.items() if _read(directory / path) != content]
    if not changed and not removed:
        return
    try:
        names = stage(directory, [contents[path] for path in changed])
        for path in changed:
            (directory / path).parent.mkdir(parents=True, exist_ok=True)
        with _interrupts_held():
            perform(directory, Switch(dict(zip(names, changed, strict=True)), removed))
            _changed.append(directory)
    finally:
        unstage(directory)


def _stale(directory: Path, files: Collection[str], known: Collection[str]) -> list[str]:
    """What symgen made and makes no more, of the sub-folders that `files` fill."""
    folders = _folders(files)
    return [
        path
        for path in sorted(known)
        if path.split("/")[0] in folders and path not in files and not is_measured(path) and _exists(directory / path)
    ]


def _others(directory: Path, files: Collection[str], made: Collection[str]) -> list[str]:
    """What symgen did not make, of the sub-folders that `files` fill; hidden folders and caches do not count."""
    others = []
    for folder in sorted(_folders(files)):
        for place, inner, names in os.walk(directory / folder):
            inner[:] = sorted(name for name in inner if not name.startswith(".") and name != "__pycache__")
            paths = ((Path(place) / name).relative_to(directory).as_posix() for name in sorted(names))
            others += [path for path in paths if path not in made]
    return others


def _folders(files: Collection[str]) -> frozenset[str]:
    return frozenset(path.split("/")[0] for path in files if "/" in path)


@contextmanager
def _interrupts_held() -> Iterator[None]:
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, _HELD_SIGNALS)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _checked(path: str) -> str:
    if not is_inside(path):
        raise SymgenBug(f"write: {path!r} is no path inside a model's folder")
    return str(PurePosixPath(path))


def _bytes(content: str | bytes) -> bytes:
    return content.encode() if isinstance(content, str) else content


def _exists(path: Path) -> bool:
    return os.path.lexists(path)


def _read(path: Path) -> bytes | None:
    try:
        return path.read_bytes()
    except (FileNotFoundError, NotADirectoryError):
        return None


def _first_difference(present: bytes, expected: bytes) -> str:
    for number, (old, new) in enumerate(zip(present.splitlines(), expected.splitlines(), strict=False), start=1):
        if old != new:
            return f" from line {number}"
    return " in length"
