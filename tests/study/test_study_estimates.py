"""How long a study will take: what is done once is counted once, and a trial that is over at once says little."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace

import pytest
from studied_arm import plan_of, study_of

from symgen.study.chunks import chunk_values
from symgen.study.estimate import TRIAL_GROWTH, TRIAL_STATES, estimated
from symgen.study.states import StudyStates
from symgen.study.work import StudyWork

pytestmark = pytest.mark.toolchain


def tried(work: StudyWork, growth: int = 1) -> int:
    """Points of a trial, and of one of more points, of the first chunk and of the last one."""
    ends = (chunk_values(work.plan, work.chunks, number) for number in (0, len(work.chunks) - 1))
    return sum(min(len(values), TRIAL_STATES // work.plan.states // 2 * growth) for values in ends)


@pytest.fixture
def work(tmp_path: Path) -> StudyWork:
    return study_of(tmp_path / "partial", plan_of(["m=1:8:5000", "g=1:9:500"], "inputs", along=("swing",)))


def clock(monkeypatch: pytest.MonkeyPatch, ticks: Iterator[float]) -> None:
    monkeypatch.setattr("symgen.study.estimate.time", SimpleNamespace(perf_counter=lambda: next(ticks)))


def test_what_is_done_once_is_counted_once(work: StudyWork, monkeypatch: pytest.MonkeyPatch) -> None:
    once = iter((0.0, 4.0))
    monkeypatch.setattr(StudyStates, "seconds_once", property(lambda _: next(once)))
    clock(monkeypatch, iter((0.0, 10.0)))
    # of 10 s 6 were for the points
    assert estimated(work).seconds == pytest.approx(4.0 + 6.0 * work.plan.points / tried(work))


def test_a_trial_that_is_over_at_once_is_made_with_more_points(
    work: StudyWork, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(StudyStates, "seconds_once", 0.0)
    clock(monkeypatch, iter((0.0, 0.01, 1.0, 1.2)))
    points = tried(work, TRIAL_GROWTH)
    assert points > 8 * tried(work)
    assert estimated(work).seconds == pytest.approx(0.2 * work.plan.points / points)


def test_a_path_that_all_machines_share_is_done_once(work: StudyWork, tmp_path: Path) -> None:
    values = chunk_values(work.plan, work.chunks, 0)[:3]
    work.states.of(values)
    assert work.states.seconds_once > 0
    solved = work.states.seconds_once
    work.states.of(values)
    assert work.states.seconds_once == solved
    longer = study_of(tmp_path / "longer", plan_of(["l=0.3:0.8:5"], "inputs", along=("swing",)))
    longer.states.of(chunk_values(longer.plan, longer.chunks, 0))
    assert longer.states.seconds_once == 0


def test_a_store_knows_that_it_is_begun_without_looking_for_each_note(work: StudyWork) -> None:
    assert not work.store.is_begun
    work.work(len(work.chunks) - 1)
    assert work.store.is_begun
