"""Campaigns of minutes: recorded with what went in, and run again where that has changed.

    python tools/campaigns.py run [CAMPAIGN...]     runs every member and records it
    python tools/campaigns.py refresh [CAMPAIGN...] runs and records what has changed since it was recorded
    python tools/campaigns.py changed COUNT         runs what has changed since it was recorded, and one in twelve of
                                                    the others, chosen by COUNT (of commits): these must give the same

A member is one model, or one set of tests.  What goes in: its generated files by their checksums, the campaign's code,
the commands, the versions of the tools.  tests/campaigns.json keeps a hash of that and what came out; what depends on
the machine, such as times, is left out.
"""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from pathlib import Path
from threading import Lock
from typing import Any

from campaign_member import Member
from campaign_members import all_members

ROOT = Path(__file__).resolve().parent.parent
RECORD = "tests/campaigns.json"
SAMPLED = 12
LAST_LINES = 30
# The folder of a model's generated files that no campaign reads.
REPORT = "report/"
# Folders of what Python and an installation make beside the sources.
MADE = frozenset({"__pycache__", "compiled"})
Record = dict[str, dict[str, dict[str, Any]]]


def inputs_hash(root: Path, member: Member, version: Callable[[str], str]) -> str:
    """What went in, as one hash: commands, files below the given paths, generated files, versions of tools."""
    hashed = hashlib.sha256()
    for part in (*member.commands, *member.environment, *((tool, version(tool)) for tool in member.tools)):
        hashed.update(repr(part).encode())
    for path in member.files:
        for file in sorted(_below(root / path)):
            hashed.update(f"{file.relative_to(root).as_posix()}\0".encode())
            hashed.update(hashlib.sha256(file.read_bytes()).digest())
    for path in member.checksums:
        lines = (root / path).read_text(encoding="utf-8").splitlines(keepends=True)
        hashed.update(path.encode())
        hashed.update("".join(line for line in lines if not line.split()[1].startswith(REPORT)).encode())
    return hashed.hexdigest()


def _below(path: Path) -> Iterable[Path]:
    if path.is_file():
        return [path]
    return [file for file in path.rglob("*") if file.is_file() and MADE.isdisjoint(file.parts)]


@cache
def version_of(tool: str) -> str:
    """The first line a tool says about its version; that it is missing, where it is."""
    path = shutil.which(tool)
    if path is None:
        return "missing"
    made = subprocess.run([path, "--version"], capture_output=True, text=True, check=False)
    return (made.stdout or made.stderr).partition("\n")[0].strip()


def due(
    members: Sequence[Member], record: Record, count: int, hash_of: Callable[[Member], str]
) -> list[tuple[Member, str]]:
    """The members to run with the reason: not recorded, changed, or one of the sample of this count."""
    members_due = []
    for index, member in enumerate(members):
        known = record.get(member.campaign, {}).get(member.name)
        if known is None:
            members_due.append((member, "not recorded"))
        elif known["inputs"] != hash_of(member):
            members_due.append((member, "changed"))
        elif index % SAMPLED == count % SAMPLED:
            members_due.append((member, "sample"))
    return members_due


def run(root: Path, member: Member) -> tuple[Any, str]:
    """The result, and the end of the log of a member that failed (empty where it passed)."""
    log = root / "build/campaigns" / f"{member.campaign}-{member.name}.log"
    log.parent.mkdir(parents=True, exist_ok=True)
    with log.open("w", encoding="utf-8") as out:
        for command in member.commands:
            first = sys.executable if command[0] == "python" else command[0]
            made = subprocess.run(
                (first, *command[1:]), cwd=root, stdout=out, stderr=subprocess.STDOUT, check=False,
                env={**os.environ, **dict(member.environment)},
            )
            if made.returncode:
                break
    if made.returncode:
        return None, "\n".join(log.read_text(encoding="utf-8", errors="replace").splitlines()[-LAST_LINES:])
    return member.result(root), ""


def run_all(root: Path, members: Sequence[Member], judge: Callable[[Member, Any], str]) -> list[str]:
    """What failed, told as it happens; `judge` says what is wrong with a result, or nothing."""

    def one(member: Member) -> str:
        began = time.monotonic()
        result, complaint = run(root, member)
        complaint = complaint or judge(member, result)
        ended = f"failed\n{complaint}" if complaint else "passed"
        print(f"{member.campaign} {member.name}: {ended} ({time.monotonic() - began:.0f} s)", flush=True)
        return f"{member.campaign} {member.name}" if complaint else ""

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        failed = list(pool.map(one, [member for member in members if not member.alone]))
    return [name for name in (*failed, *(one(member) for member in members if member.alone)) if name]


def read_record(root: Path) -> Record:
    """What was recorded; nothing where there is no file."""
    path = root / RECORD
    return json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}


def write_record(root: Path, record: Mapping[str, Mapping[str, Any]]) -> None:
    """One line a member."""
    lines = []
    for campaign, members in sorted(record.items()):
        rows = [f'  "{name}": {json.dumps(known, sort_keys=True)}' for name, known in sorted(members.items())]
        lines.append(f' "{campaign}": {{\n' + ",\n".join(rows) + "\n }")
    (root / RECORD).write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")


def run_and_record(
    root: Path, members: Sequence[Member], version: Callable[[str], str] = version_of, changed: bool = False
) -> int:
    """Runs all and records those that pass as they end; what is no member any more is forgotten.

    With `changed` only those run that are not recorded as they are.
    """
    record = read_record(root)
    for campaign in {member.campaign for member in members}:
        names = {member.name for member in members if member.campaign == campaign}
        record[campaign] = {name: known for name, known in record.get(campaign, {}).items() if name in names}

    hashes = {(member.campaign, member.name): inputs_hash(root, member, version) for member in members}
    if changed:
        members = [one for one in members if _recorded(record, one) != hashes[one.campaign, one.name]]
    lock = Lock()

    def note(member: Member, result: Any) -> str:
        with lock:
            inputs = hashes[member.campaign, member.name]
            record[member.campaign][member.name] = {"inputs": inputs, "result": result}
            write_record(root, record)
        return ""

    failed = run_all(root, members, note)
    for name in failed:
        campaign, _, member = name.partition(" ")
        record[campaign].pop(member, None)
    write_record(root, record)
    return _said(failed)


def _recorded(record: Record, member: Member) -> str:
    """The hash of what went in when a member was recorded; empty where it was not."""
    return str(record[member.campaign].get(member.name, {}).get("inputs", ""))


def run_changed(
    root: Path, members: Sequence[Member], count: int, version: Callable[[str], str] = version_of
) -> int:
    """Runs what has changed and a sample; a sample that gives another result than recorded is a failure."""
    record = read_record(root)
    members_due = due(members, record, count, lambda member: inputs_hash(root, member, version))
    for member, reason in members_due:
        print(f"{member.campaign} {member.name}: {reason}", flush=True)
    print(f"{len(members_due)} of {len(members)} members are due", flush=True)
    sampled = {(member.campaign, member.name) for member, reason in members_due if reason == "sample"}

    def compare(member: Member, result: Any) -> str:
        if (member.campaign, member.name) not in sampled:
            return ""
        expected = record[member.campaign][member.name]["result"]
        return "" if result == expected else f"recorded: {json.dumps(expected)}\nnow: {json.dumps(result)}"

    return _said(run_all(root, [member for member, _ in members_due], compare))


def _said(failed: Sequence[str]) -> int:
    if failed:
        print("failed: " + ", ".join(failed), file=sys.stderr)
    return int(bool(failed))


def main(arguments: Sequence[str]) -> int:
    """The command line; see the top of this file."""

    members = all_members(ROOT)
    match arguments:
        case ["run", *names]:
            return run_and_record(ROOT, [member for member in members if not names or member.campaign in names])
        case ["refresh", *names]:
            these = [member for member in members if not names or member.campaign in names]
            return run_and_record(ROOT, these, changed=True)
        case ["changed", count]:
            return run_changed(ROOT, members, int(count))
    print(__doc__, file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
