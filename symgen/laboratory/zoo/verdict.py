"""How a run ended: as it should, or a failure of one kind with a signature by which it is known again."""

from __future__ import annotations

import re
from dataclasses import dataclass

from symgen.laboratory.zoo.run import CommandRun

VERIFIED, NOTICED, REFUSED, FAILED = "verified", "verified with a notice", "refused", "failed"
# file:line:column: message, excerpt, marker, remedy
PLACED = re.compile(
    r"^[^\n]*?\.(?:yaml|urdf):\d+:\d+: (?!notice: )(?P<message>[^\n]+)\n.*?^  remedy: (?P<remedy>[^\n]+)", re.M | re.S
)
LEFT_OUT = re.compile(r"(\w+) is left out in [\w ]+: verification rejects every method\n\s*([^\n]*)")
NUMBERS = re.compile(r"[-+]?\d+(\.\d+)?([eE][-+]?\d+)?")
# every draw has a configuration that satisfies its rows, so these cannot be true
UNTRUE = (
    "no configuration was found",
    "cannot be satisfied",
    "regular configurations",
    "cannot be closed",
    "does not depend on the configuration: it demands",
)


@dataclass(frozen=True)
class DrawVerdict:
    """An ending, the kind of failure, and a signature that does not depend on names and numbers."""

    ending: str
    kind: str = ""
    signature: str = ""

    @property
    def failed(self) -> bool:
        """Whether this ending is none of the three that are allowed."""
        return self.ending == FAILED


def verdict_of(run: CommandRun) -> DrawVerdict:
    """What the exit code and the messages say."""
    if run.ended:
        return DrawVerdict(FAILED, run.ended, _last_line(run.err, "reading the model"))
    if "Traceback (most recent call last)" in run.err or "internal error" in run.err:
        return DrawVerdict(FAILED, "internal error", _fault(run.err))
    if run.code < 0:
        return DrawVerdict(FAILED, "signal", str(-run.code))
    if run.code == 0:
        notices = [line for line in run.err.splitlines() if "notice" in line]
        return DrawVerdict(NOTICED if notices else VERIFIED)
    if left_out := LEFT_OUT.search(run.err):
        # the rest is written, and the user is told what to do; but the quantity was asked for and the state is regular
        return DrawVerdict(FAILED, "left out", f"{left_out[1]}: {without_numbers(left_out[2])}"[:150])
    if "verification failed" in run.err:
        return DrawVerdict(FAILED, "verification", _withheld(run.err))
    if run.code == 1 and (placed := PLACED.search(run.err)):
        untrue = any(words in placed["message"] for words in UNTRUE)
        text = without_numbers(placed["message"])
        return DrawVerdict(FAILED, "refused without reason", text) if untrue else DrawVerdict(REFUSED, signature=text)
    return DrawVerdict(
        FAILED, "message without a place or remedy", without_numbers(_last_line(run.err, "nothing was said"))
    )


def _last_line(text: str, otherwise: str) -> str:
    lines = [line.strip() for line in text.replace("\r", "\n").splitlines() if line.strip()]
    return without_numbers(lines[-1]) if lines else otherwise


def _fault(text: str) -> str:
    """The exception and the deepest place in symgen."""
    places = re.findall(r'File "[^"]*/symgen/([^"]+)", line \d+, in (\w+)', text)
    errors = re.findall(r"^(\w*(?:Error|Exception|Bug|Interrupt)\b[^\n]*)", text, re.M)
    inner = re.findall(r"internal error: ([^\n]*)", text)
    error = errors[-1] if errors else inner[0] if inner else "?"
    place = " in ".join(reversed(places[-1])) if places else "?"
    return f"{without_numbers(error)[:120]} at {place}"


def _withheld(text: str) -> str:
    """Which quantity of which target fails, and how, without its numbers."""
    lines = text.splitlines()
    at = next(index for index, line in enumerate(lines) if "verification failed" in line)
    return without_numbers(lines[at + 1].strip()[:160]) if at + 1 < len(lines) else "?"


def without_numbers(text: str) -> str:
    """The text with every number as #, and names in quotes as `.`."""
    return NUMBERS.sub("#", re.sub(r"`[^`]*`|'[^']*'", "`.`", text))
