"""What is printed where there is no terminal, or one without the characters."""

from __future__ import annotations

import io
from pathlib import Path

import pytest

from symgen.generation.results import Summary
from symgen.terminal import SPELLED, Progress, fitted, summary_table, written_table


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_a_log_has_one_line_a_stage() -> None:
    log = io.StringIO()
    progress = Progress("car", quiet=False, stream=log)
    for message in ("deriving", "reference, state 1 of 64", "reference, state 9 of 64", "writing"):
        progress(message)
    progress.done()
    assert log.getvalue() == "car: deriving ...\ncar: reference ...\ncar: writing ...\n"


def test_a_terminal_shows_every_step_in_one_line() -> None:
    terminal = Terminal()
    progress = Progress("car", quiet=False, stream=terminal)
    progress("reference, state 1 of 64")
    progress("reference, state 9 of 64")
    progress.done()
    assert "state 9 of 64" in terminal.getvalue()
    assert "\n" not in terminal.getvalue()
    assert terminal.getvalue().endswith("\r\x1b[K")


def test_a_stage_that_counts_has_a_bar_and_says_what_is_left(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    seconds = iter((100.0, 100.0, 110.0, 110.0))
    monkeypatch.setattr("symgen.terminal.time.monotonic", lambda: next(seconds, 110.0))
    terminal = Terminal()
    progress = Progress("car", quiet=False, stream=terminal)
    progress("working, 100 of 400 chunks")
    progress("working, 200 of 400 chunks")
    progress.done()
    lines = terminal.getvalue().split("\r\x1b[K")
    assert lines[1] == "car: working, 100 of 400 chunks ... [#####---------------]"
    # what was there before this run took no time
    assert lines[2] == "car: working, 200 of 400 chunks ... [##########----------] 20 s left"


def test_an_empty_message_makes_room_for_tables() -> None:
    terminal, log = Terminal(), io.StringIO()
    for stream in (terminal, log):
        progress = Progress("car", quiet=False, stream=stream)
        progress("drawing")
        progress("")
    assert terminal.getvalue().endswith("drawing ...\r\x1b[K")
    assert log.getvalue() == "car: drawing ...\n"


def test_a_narrow_terminal_does_not_wrap(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "20")
    terminal = Terminal()
    progress = Progress("car", quiet=False, stream=terminal)
    progress("reference, state 1 of 64")
    assert terminal.getvalue() == "\r\x1b[Kcar: reference, sta"
    progress.done()


def test_long_lines_are_folded_at_words_in_terminals_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """Excerpts of files stay, whose marks would otherwise be elsewhere."""
    monkeypatch.setenv("COLUMNS", "40")
    excerpt = f"   14 |   foot: {{{'m' * 40}}}\n      | {' ' * 30}^^^^^^^^^^^\n"
    message = "wrong.yaml:14:25: unknown name `L` in the centre of mass"
    remedy = "  remedy: name the coordinate of that joint"
    text = f"{message}\n{excerpt}{remedy}\n"
    assert fitted(text, io.StringIO()) == text
    shown = fitted(text, Terminal())
    assert excerpt in shown
    assert shown.replace(excerpt, "").splitlines() == [
        "wrong.yaml:14:25: unknown name `L` in",
        "    the centre of mass",
        "  remedy: name the coordinate of that",
        "      joint",
    ]
    assert fitted("short", Terminal()) == "short"


@pytest.mark.parametrize(
    ("text", "ascii_text"),
    [
        ("cos² θ sin 2φ", "cos^2 theta sin 2phi"),
        ("δ = 2 ─ q̇ Θ₁ M̃⁺", "delta = 2 - q_dot Theta_1 M~^+"),
        ("☃ √ …", "? sqrt ..."),
    ],
)
def test_missing_characters_are_spelled(text: str, ascii_text: str) -> None:
    assert text.encode("ascii", errors=SPELLED).decode() == ascii_text


def test_sentences_fit_the_terminal_and_lose_no_word() -> None:
    long = "δ = 1 for 4 coordinates: one direction, the cross product of the rows"
    skipped = (("(B Bᵀ)⁻¹ of bucket_eye_x, bucket_eye_z, link_length", long), ("multipliers", "none"))
    summary = Summary(4, 3, 1, 1, skipped, ())
    narrow, wide = summary_table("digger", summary, 60), summary_table("digger", summary)
    assert max(map(len, narrow.splitlines())) <= 60 < max(map(len, wide.splitlines()))
    assert sorted(narrow.replace("─", "").split()) == sorted(wide.replace("─", "").split())


def test_what_was_written_takes_a_line_a_kind() -> None:
    files = [Path("derivation.json"), *(Path(f"c/robot_{name}.c") for name in range(20)), Path("report/robot.pdf")]
    lines = written_table(Path("out/robot"), files).splitlines()
    assert lines[0] == "written to out/robot/:"
    assert [line.split()[:2] for line in lines[1:3]] == [["c/", "20"], ["report/", "1"]]
    assert lines[1].endswith("robot_4.c, ...")
    assert lines[3].split() == ["1", "derivation.json"]
    assert max(map(len, lines)) <= 80
