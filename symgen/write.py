"""The only writer: a model's folder changes as a whole or not at all."""

from __future__ import annotations

import os
import shutil
import signal
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from fnmatch import fnmatch
from pathlib import Path, PurePosixPath

from symgen.diagnostics import SymgenBug

MEASURED = ("certificate.json", "*.pdf", "bench.*", "stress.*", "target.*", "proof.json", "simulation.*")
_HELD_SIGNALS = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))


def is_measured(path: str) -> bool:
    """Whether a file is written by a measurement: never compared, never removed as stale."""
    return any(fnmatch(PurePosixPath(path).name, pattern) for pattern in MEASURED)


def write_files(directory: Path, files: Mapping[str, str | bytes]) -> tuple[Path, ...]:
    """Puts the files (POSIX paths relative to `directory`) on disk and returns their paths.

    Everything is staged first; then each file is renamed into place with interrupts held back, and what a failure
    had already replaced is put back. Earlier files in the same sub-folders that are no longer made are removed.
    Raises OSError when the disk refuses; the folder then is as before.
    """
    contents = {_checked(path): _bytes(content) for path, content in files.items()}
    directory.mkdir(parents=True, exist_ok=True)
    staging = Path(tempfile.mkdtemp(prefix=".staging-", dir=directory))
    try:
        changed = [path for path, content in contents.items() if _read(directory / path) != content]
        for index, path in enumerate(changed):
            (staging / f"new-{index}").write_bytes(contents[path])
        for path in changed:
            (directory / path).parent.mkdir(parents=True, exist_ok=True)
        stale = _stale(directory, contents)
        with _interrupts_held():
            _commit(directory, staging, changed, stale)
    finally:
        shutil.rmtree(staging, ignore_errors=True)
    return tuple(directory / path for path in contents)


def compare(directory: Path, files: Mapping[str, str | bytes]) -> tuple[str, ...]:
    """Differences between the disk and `files`, in content and in the set of files; measured files do not count."""
    expected = {_checked(path): _bytes(content) for path, content in files.items() if not is_measured(path)}
    differences = []
    for path, content in expected.items():
        found = _read(directory / path)
        if found is None:
            differences.append(f"{directory / path}: missing")
        elif found != content:
            differences.append(f"{directory / path}: differs{_first_difference(found, content)}")
    differences += [f"{directory / path}: no longer generated" for path in _stale(directory, expected)]
    return tuple(sorted(differences))


def _commit(directory: Path, staging: Path, changed: list[str], stale: list[str]) -> None:
    """Renames the staged files into place and removes stale ones; on failure puts back what was there."""
    backups = {path: _backup(directory / path, staging / f"old-{k}") for k, path in enumerate((*changed, *stale))}
    touched: list[str] = []
    try:
        for index, path in enumerate(changed):
            os.replace(staging / f"new-{index}", directory / path)
            touched.append(path)
        for path in stale:
            (directory / path).unlink()
            touched.append(path)
    except BaseException:
        for path in touched:
            backup = backups[path]
            if backup is None:
                (directory / path).unlink(missing_ok=True)
            else:
                os.replace(backup, directory / path)
        raise


def _backup(path: Path, backup: Path) -> Path | None:
    if not path.exists():
        return None
    shutil.copy2(path, backup)
    return backup


def _stale(directory: Path, files: Mapping[str, bytes]) -> list[str]:
    """Files of earlier runs in the sub-folders that `files` fills."""
    folders = sorted({path.split("/")[0] for path in files if "/" in path})
    found = (
        path.relative_to(directory).as_posix()
        for folder in folders
        for path in sorted((directory / folder).rglob("*"))
        if (path.is_file() or path.is_symlink()) and "__pycache__" not in path.parts
    )
    return [path for path in found if path not in files and not is_measured(path)]


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
    parts = PurePosixPath(path).parts
    if not parts or path.startswith("/") or ".." in parts or "\\" in path or parts[0].startswith("."):
        raise SymgenBug(f"write: {path!r} is no path inside a model's folder")
    return str(PurePosixPath(path))


def _bytes(content: str | bytes) -> bytes:
    return content.encode() if isinstance(content, str) else content


def _read(path: Path) -> bytes | None:
    try:
        return path.read_bytes()
    except (FileNotFoundError, NotADirectoryError):
        return None


def _first_difference(found: bytes, expected: bytes) -> str:
    for number, (old, new) in enumerate(zip(found.splitlines(), expected.splitlines(), strict=False), start=1):
        if old != new:
            return f" from line {number}"
    return " in length"
