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
from symgen.output.manifest import FILES, checksum_of, is_inside, manifest_text, read_manifest

MEASURED = (
    "certificate.json", "*.pdf", "bench.*", "stress.*", "target.*", "proof.json", "simulation.*", ".symgen-*"
)
_HELD_SIGNALS = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))
_DERIVED = "derivation.json"
_MOST_LISTED = 5
_changed: list[Path] = []

Notify = Callable[[str], None]


class ForeignFileError(OSError):
    """A file that symgen did not make stands where one of its files would go."""


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
    since, stay and are told. Raises OSError when the disk refuses, ForeignFileError where a file would have to be
    replaced that symgen did not make, LockedError when another run does not end.
    """
    contents = {_checked(path): _bytes(content) for path, content in files.items()}
    directory.mkdir(parents=True, exist_ok=True)
    with folder_lock(directory, notify):
        if done := recover(directory):
            notify(done)
        known = _known(directory, contents)
        stale = _stale(directory, contents, known)
        removed = [path for path in stale if checksum_of(_read(directory / path) or b"") == known[path]]
        kept = {path: checksum for path, checksum in known.items() if path not in stale and _exists(directory / path)}
        made = kept | {path: checksum_of(content) for path, content in contents.items()}
        if _keeps_a_list(directory, contents):
            contents[FILES] = manifest_text(directory.name, made).encode()
        _replace(directory, contents, removed)
        if others := _others(directory, contents, made):
            more = f" and {len(others) - _MOST_LISTED} more" if len(others) > _MOST_LISTED else ""
            shown = ", ".join(others[:_MOST_LISTED]) + more
            notify(f"{directory}: notice: not made by symgen, or changed since, and left as they are: {shown}")
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
            found = _read(directory / path)
            if found is None:
                differences.append(f"{directory / path}: missing")
            elif found != content:
                differences.append(f"{directory / path}: differs{_first_difference(found, content)}")
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


def _keeps_a_list(directory: Path, contents: Collection[str]) -> bool:
    """Whether the list of files is written: a measurement does not begin the list of a folder that came without one,
    since everything that is not on a list is the user's.
    """
    return read_manifest(directory) is not None or _DERIVED in contents or not _exists(directory / _DERIVED)


def _known(directory: Path, contents: Mapping[str, bytes]) -> dict[str, str]:
    """Checksums by path of what symgen made; ForeignFileError where something else stands in the way of `contents`.

    A folder without a list, of a version that kept none or from a repository without it, is symgen's by its derivation:
    files at the paths of symgen's are replaced, and none is removed.
    """
    found = read_manifest(directory)
    name, known = found or ("", {})
    if name != directory.name and name.lower() == directory.name.lower():
        message = f"here are the files of the model {name}: this disk knows no capitals; rename one, or choose --out"
        raise ForeignFileError(errno.EEXIST, message, str(directory))
    derived = found is None and _exists(directory / _DERIVED)
    foreign = [
        path
        for path, content in contents.items()
        if path not in known and not derived and not (found is None and is_measured(path))
        and _exists(directory / path) and _read(directory / path) != content
    ]
    if foreign:
        message = "symgen did not make this file and does not replace it: move it, or choose another folder (--out)"
        raise ForeignFileError(errno.EEXIST, message, str(directory / foreign[0]))
    return known


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
    found = []
    for folder in sorted(_folders(files)):
        for place, inner, names in os.walk(directory / folder):
            inner[:] = sorted(name for name in inner if not name.startswith(".") and name != "__pycache__")
            paths = ((Path(place) / name).relative_to(directory).as_posix() for name in sorted(names))
            found += [path for path in paths if path not in made and not is_measured(path)]
    return found


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
