"""Chunks for clusters: as many as a scheduler can hand out while a thousand cores work on them."""

from __future__ import annotations

import pytest
import study_packages  # noqa: F401
from study_cluster import plan_of, simulated

from symgen.study.chunks import MANY_CHUNKS, MOST_CHUNK_POINTS, MOST_CHUNK_STATES, chunk_grid


def test_one_core_takes_all_there_is_and_many_wait_for_the_scheduler() -> None:
    assert simulated(10, 1, 1.0, 0.5) == pytest.approx(15.0)
    # the last chunk is handed out after ten times the overhead
    assert simulated(10, 100, 1.0, 0.5) == pytest.approx(6.0)
    assert simulated(10, 5, 1.0, 0.0) == pytest.approx(2.0)


def test_chunks_get_larger_where_there_would_be_more_than_a_scheduler_hands_out() -> None:
    few, many = plan_of(10**10), plan_of(10**12)
    assert max(len(chunk_grid(few)), 1) * MOST_CHUNK_STATES >= few.points * few.states
    chunks = chunk_grid(many)
    assert len(chunks) <= 2 * MANY_CHUNKS
    assert all(side <= MOST_CHUNK_POINTS for side in chunks.sides)
    assert chunks.sides[0] * chunks.sides[1] <= MOST_CHUNK_POINTS
    # 1 ms of Dask for each chunk leaves most of a thousand cores' time
    states = many.points * many.states
    ideal = states / 45e6 / 1000
    assert simulated(len(chunks), 1000, states / len(chunks) / 45e6, 1e-3) < 1.5 * ideal
