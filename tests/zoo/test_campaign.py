"""A campaign from its command line: what is told, what is kept, how chunks are summed up."""

from __future__ import annotations

import threading
import time
from dataclasses import replace
from pathlib import Path

import pytest

from symgen.laboratory.zoo import campaign, command
from symgen.laboratory.zoo.alone import alone, beside_others
from symgen.laboratory.zoo.campaign import MOST_SECONDS, Campaign, JudgedDraw, judge, one_draw, shrunk
from symgen.laboratory.zoo.cases import case_of, read_case
from symgen.laboratory.zoo.draws.describe import Description, Terms, read_description, summands
from symgen.laboratory.zoo.draws.families import FAMILIES, draw
from symgen.laboratory.zoo.records import DrawRecord, methods_of, read_records, summary, write_record
from symgen.laboratory.zoo.refusals import UNREPORTED
from symgen.laboratory.zoo.run import CommandRun
from symgen.laboratory.zoo.verdict import FAILED, REFUSED, VERIFIED, DrawVerdict
from symgen.laboratory.zoo.witness.coverage import Coverage
from symgen.laboratory.zoo.witness.reading.expressions import NotReadError
from symgen.laboratory.zoo.witness.reading.urdf_file import expanded
from symgen.laboratory.zoo.witness.results import CheckResult
from symgen.laboratory.zoo.witness.states import LOST_STEPS, NOT_CLOSED, STUCK
from symgen.model.load import load_text

RIGHT = DrawRecord(1, 0, "disc", VERIFIED, "", "", 2.0, 100)
WRONG = DrawRecord(1, 1, "bennett", FAILED, "internal error", "KeyError at run", 3.5, 90, "there.yaml")


@pytest.mark.parametrize("family", FAMILIES)
def test_a_file_is_read_back_as_it_was_drawn(family: str) -> None:
    description = draw(2, 1, family)
    again = read_description(description.text, description.start)
    assert again.text.replace('"', "") == description.text.replace('"', "")
    assert again.start == description.start


def test_summands_stand_outside_of_brackets() -> None:
    assert summands("a*(b + c) - d + e**2 + (f + g)") == ["a*(b + c) - d", "e**2", "(f + g)"]
    assert str(Terms(("a", "-b"))) == "a + (-b)"


def test_chunks_are_summed_up(tmp_path: Path) -> None:
    for name, record in (("a", WRONG), ("b", RIGHT), ("b", DrawRecord(1, 1, "bennett", VERIFIED, "", "", 4.0, 95))):
        write_record(tmp_path / name, record)
    assert "1 failed" in summary(read_records([tmp_path / "a"]))
    text = summary(read_records([tmp_path / "a", tmp_path / "b"]))
    # a draw that was run again counts as it ended last
    assert "2 draws" in text
    assert "failed" not in text
    assert "most CPU time: 4.0 s (1:1 bennett)" in text


def test_methods_are_counted(tmp_path: Path) -> None:
    derivation = {
        "kernels": {
            "inverse_dynamics": {"method": "minor"},
            "forward_dynamics": {"method": "schur_qr", "along": "householder"},
            "energy": {"method": "minors"},
        }
    }
    for index in range(2):
        known = methods_of(derivation if index else {"kernels": {"inverse_dynamics": {"method": "minor"}}})
        write_record(tmp_path / "a", DrawRecord(1, index, "disc", VERIFIED, "", "", 2.0, 100, methods=known))
    text = summary(read_records([tmp_path / "a"]))
    assert "  inverse_dynamics: minor 2\n  forward_dynamics: schur_qr 1\n" in text
    assert "energy" not in text


def test_the_sum_of_failures_is_a_failure(tmp_path: Path, monkeypatch, capsys) -> None:
    write_record(tmp_path / "a", WRONG)
    monkeypatch.setattr("sys.argv", ["zoo", "--sum", str(tmp_path / "a")])
    assert command.main() == 1
    assert "1 x internal error: KeyError at run" in capsys.readouterr().out


def test_a_draw_is_shown(monkeypatch, capsys) -> None:
    monkeypatch.setattr("sys.argv", ["zoo", "--show", "--seed", "3", "--first", "4", "--family", "geared"])
    assert command.main() == 0
    assert capsys.readouterr().out == draw(3, 4, "geared").text


@pytest.fixture
def ends(monkeypatch):
    """The command replaced by an ending, without files."""

    def use(run: CommandRun) -> None:
        def instead(_model: Path, folder: Path, _options: tuple[str, ...]) -> CommandRun:
            folder.mkdir(parents=True, exist_ok=True)
            return run

        monkeypatch.setattr(campaign, "run_command", instead)

    return use


def test_a_run_that_writes_nothing_is_no_success(ends, tmp_path: Path) -> None:
    ends(CommandRun(0, "", "", 1, 1))
    verdict = judge(draw(1, 1, "geared"), tmp_path / "zoo.yaml").verdict
    assert (verdict.ending, verdict.kind) == (FAILED, "nothing written")


def test_what_breaks_the_witness_is_a_failure_of_the_draw(ends, tmp_path: Path) -> None:
    ends(CommandRun(0, "", "", 1, 1))
    made = tmp_path / "zoo" / "zoo"
    made.mkdir(parents=True)
    (made / "derivation.json").write_text("{}")
    (made / "python").mkdir()
    (made / "python" / "zoo.py").write_text("raise RuntimeError('no')")
    verdict = judge(draw(1, 1, "geared"), tmp_path / "zoo.yaml").verdict
    assert (verdict.ending, verdict.kind) == (FAILED, "fault of the zoo")


def test_a_failing_draw_leaves_its_file_and_a_small_case(ends, tmp_path: Path) -> None:
    ends(CommandRun(2, "", "symgen: internal error: odd\n", 1, 1))
    record, message = one_draw(Campaign(1, tmp_path, "car_with_trailers", shrinking=150), 0)
    assert record.failed
    assert "internal error" in message
    large, small = Path(record.file).read_text(), Path(record.file).with_name("case.yaml").read_text()
    assert "# expected: verified" in small
    assert len(small) < len(large) / 2


@pytest.mark.parametrize("enough", [True, False])
def test_what_takes_too_long_beside_others_is_run_again_by_itself(tmp_path: Path, monkeypatch, enough: bool) -> None:
    mistaken = "zoo.yaml:3:1: no mass along some motion\n  m: 0\n  ^\n  remedy: give it one\n"
    runs = [CommandRun(-9, "", "", 61, 1, "time"), CommandRun(1, "", mistaken, 58, 1)]
    runs = runs if enough else [runs[0], runs[0]]

    def instead(_model: Path, folder: Path, _options: tuple[str, ...]) -> CommandRun:
        folder.mkdir(parents=True, exist_ok=True)
        return runs.pop(0)

    monkeypatch.setattr(campaign, "run_command", instead)
    monkeypatch.setattr(campaign, "judged", lambda _, verdict: verdict)
    record, _ = one_draw(Campaign(1, tmp_path, "geared"), 0)
    assert runs == []
    assert (record.ending, record.kind, record.cpu) == ((REFUSED, "", 58) if enough else (FAILED, "time", 61))


def test_one_by_itself_waits_for_those_that_run_and_is_not_overtaken(tmp_path: Path) -> None:
    order: list[str] = []
    waiting, later = threading.Event(), threading.Event()

    def by_itself() -> None:
        waiting.set()
        with alone(tmp_path):
            order.append("alone")
            # time for another to begin, were it let in
            time.sleep(0.2)
            order.append("done")

    def beside() -> None:
        later.set()
        with beside_others(tmp_path):
            order.append("later")

    threads = [threading.Thread(target=by_itself), threading.Thread(target=beside)]
    with beside_others(tmp_path), beside_others(tmp_path):
        threads[0].start()
        waiting.wait(10)
        time.sleep(0.2)
        threads[1].start()
        later.wait(10)
        time.sleep(0.2)
        order.append("first")
    for thread in threads:
        thread.join(10)
    assert order == ["first", "alone", "done", "later"]


def test_a_campaign_makes_its_failures_small_and_keeps_them_as_tests(ends, tmp_path: Path, monkeypatch) -> None:
    ends(CommandRun(2, "", "symgen: internal error: odd\n", 1, 1))
    # processes of a pool would not have the replaced command
    monkeypatch.setattr(command, "run_campaign", lambda one, given, indices, *_: [one(given, k)[0] for k in indices])
    cases = tmp_path / "cases"
    given = ["zoo", "--seed", "1", "--draws", "1", "--family", "geared", "--out", str(tmp_path), "--cases", str(cases)]
    monkeypatch.setattr("sys.argv", given)
    assert command.main() == 1
    assert [path.name for path in cases.iterdir()] == ["1_0.yaml"]
    kept = read_case(cases / "1_0.yaml")
    assert (kept.failure, kept.expected) == ("internal error: odd at ?", VERIFIED)
    assert len(kept.model) < len(draw(1, 0, "geared").text) / 2


def wrote(tmp_path: Path) -> None:
    """What a command that ends well leaves, as far as the campaign looks at it."""
    made = tmp_path / "zoo" / "zoo"
    made.mkdir(parents=True)
    (made / "derivation.json").write_text("{}")


def test_a_draw_that_the_witness_cannot_read_is_a_failure(ends, tmp_path: Path, monkeypatch) -> None:
    ends(CommandRun(0, "", "", 1, 1))
    wrote(tmp_path)

    def unread(*_: object) -> CheckResult:
        raise NotReadError("a joint of type helical")

    monkeypatch.setattr(campaign, "check", unread)
    ended = judge(draw(1, 1, "geared"), tmp_path / "zoo.yaml")
    assert (ended.verdict.kind, ended.verdict.signature) == (
        "fault of the zoo",
        "NotReadError: a joint of type helical",
    )
    assert ended.compared is None


@pytest.mark.parametrize(
    ("compared", "kind", "signature"),
    [
        (Coverage(20), "", ""),
        (Coverage(7, LOST_STEPS), "", ""),
        (Coverage(0, LOST_STEPS), "no state to compare", LOST_STEPS),
        (Coverage(0, NOT_CLOSED), "no state to compare", NOT_CLOSED),
        # several branches meet there: which one is meant nobody can say
        (Coverage(0, STUCK), "", f"no state to compare: {STUCK}"),
    ],
)
def test_a_draw_without_a_state_is_a_failure_unless_its_start_is_singular(
    compared: Coverage, kind: str, signature: str, ends, tmp_path: Path, monkeypatch
) -> None:
    ends(CommandRun(0, "", "", 1, 1))
    wrote(tmp_path)
    monkeypatch.setattr(campaign, "check", lambda *_: CheckResult(compared, 0.0, ()))
    ended = judge(draw(1, 1, "geared"), tmp_path / "zoo.yaml")
    assert (ended.verdict.kind, ended.verdict.signature) == (kind, signature)
    assert ended.compared == compared


def test_what_was_compared_is_recorded_and_summed_up(tmp_path: Path) -> None:
    names = ("inverse_dynamics", "forward_dynamics", "multipliers")
    compared = [
        Coverage(20, "", names, (), 180, 0, 0, 0.0, 0, 40),
        Coverage(20, "", names[:2], names[2:], 100, 2, 18, 3.1e-3),
        Coverage(13, LOST_STEPS, names[1:2], (), 26, 0, 0, 0.0, 4),
        Coverage(0, STUCK, (), names),
        None,
    ]
    for index, each in enumerate(compared):
        write_record(tmp_path / "a", DrawRecord(1, index, "disc", VERIFIED, "", "", 2.0, 100, compared=each))
    records = read_records([tmp_path / "a"])
    assert [record.compared for record in records] == compared
    text = summary(records)
    assert f"4 draws compared: 2 at 20 states, 1 at fewer (1 x {LOST_STEPS}), 1 at none (1 x {STUCK})" in text
    assert "u compared in 2 draws, there but not compared in 1" in text
    assert "λ compared in 1 draws, there but not compared in 2" in text
    assert "306 results compared, 4 without truth" in text
    assert "2 statuses of float64 and 18 of float32 in 1 draws (states determine them to 3.1e-03 at best)" in text
    assert "40 results of 1 draws beside Pinocchio's" in text


def test_a_record_of_an_earlier_version_is_read(tmp_path: Path) -> None:
    (tmp_path / "a").write_text(
        '{"seed": 1, "index": 0, "family": "disc", "ending": "verified", "kind": "", "signature": "", "cpu": 2.0, '
        '"megabytes": 100, "file": ""}\n'
    )
    records = read_records([tmp_path / "a"])
    assert records[0].compared is None
    assert "0 draws compared" in summary(records)


def test_without_pinocchio_nothing_is_drawn_where_tools_are_required(monkeypatch, tmp_path: Path, capsys) -> None:
    monkeypatch.setattr(command, "find_spec", lambda _: None)
    monkeypatch.setattr(command, "run_campaign", lambda *_: [RIGHT])
    monkeypatch.setattr("sys.argv", ["zoo", "--draws", "1", "--out", str(tmp_path)])
    monkeypatch.setenv("SYMGEN_REQUIRE_TOOLS", "1")
    assert command.main() == 1
    assert "Pinocchio is not installed" in capsys.readouterr().err


@pytest.mark.parametrize("installed", [True, False])
def test_trees_that_are_compared_with_one_witness_only_are_told(
    installed: bool, tmp_path: Path, monkeypatch, capsys
) -> None:
    monkeypatch.delenv("SYMGEN_REQUIRE_TOOLS", raising=False)
    monkeypatch.setattr(command, "find_spec", lambda _: object() if installed else None)
    monkeypatch.setattr(command, "run_campaign", lambda *_: [RIGHT])
    monkeypatch.setattr("sys.argv", ["zoo", "--draws", "1", "--out", str(tmp_path)])
    assert command.main() == 0
    assert ("Pinocchio is not installed" in capsys.readouterr().err) != installed


def test_what_takes_long_is_made_small_in_few_runs(monkeypatch, tmp_path: Path) -> None:
    late, runs = DrawVerdict(FAILED, "time", "deriving ..."), []

    def instead(candidate: Description, _model: Path) -> JudgedDraw:
        runs.append(candidate)
        return JudgedDraw(late, MOST_SECONDS / 4, 1)

    monkeypatch.setattr(campaign, "judge", instead)
    description = draw(1, 0, "planar_energies")
    small = shrunk(description, late, tmp_path / "small.yaml", 80)
    assert len(runs) == 5
    assert small == runs[-1]


def test_a_mistake_that_was_not_told_is_kept_with_the_mistake(tmp_path: Path) -> None:
    description, verdict = draw(1, 0, "geared"), DrawVerdict(FAILED, UNREPORTED)
    assert shrunk(description, verdict, tmp_path / "small.yaml", 80) == description
    assert case_of(description, verdict).expected == REFUSED


def test_a_draw_that_ends_well_leaves_nothing(ends, tmp_path: Path, monkeypatch) -> None:
    ends(CommandRun(0, "", "", 1, 1))
    monkeypatch.setattr(campaign, "_witnessed", lambda *_: (DrawVerdict(VERIFIED), "", Coverage(20)))
    record, _ = one_draw(Campaign(1, tmp_path, "disc"), 0)
    assert not record.failed
    assert {path.suffix for path in tmp_path.iterdir()} == {".lock"}


def test_a_draw_is_made_small_and_kept(ends, tmp_path: Path, monkeypatch) -> None:
    ends(CommandRun(2, "", "symgen: internal error: odd\n", 1, 1))
    case, out = tmp_path / "case.yaml", tmp_path / "out"
    given = ["zoo", "--seed", "1", "--first", "2", "--family", "robot_files", "--store", str(case), "--out", str(out)]
    monkeypatch.setattr("sys.argv", given)
    assert command.main() == 1
    kept = read_case(case)
    assert kept.failure.startswith("internal error")
    assert "urdf" not in kept.model
    drawn = draw(1, 2, "robot_files")
    assert len(kept.model) < len(drawn.text + drawn.files["robot.urdf"]) / 2


@pytest.mark.parametrize("index", [2, 7])
def test_a_robot_is_the_same_without_its_file(index: int) -> None:
    drawn = draw(1, index, "robot_files")
    written = replace(drawn, blocks=expanded(drawn.blocks, drawn.files), files={})
    model = load_text(written.text, "zoo.yaml")
    assert [coordinate.name for coordinate in model.coordinates] == list(drawn.start)


def test_what_is_drawn_is_counted(monkeypatch, capsys) -> None:
    monkeypatch.setattr("sys.argv", ["zoo", "--count", "--draws", "3", "--family", "bennett"])
    assert command.main() == 1
    assert "     3  Bennett linkage\n" in capsys.readouterr().out
