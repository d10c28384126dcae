"""Points: boxes of a grid, and samples that are the same whoever draws them."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import qmc
from studied_arm import plan_of

from symgen.study.chunks import FEWEST_CHUNK_STATES, MOST_CHUNK_STATES, ChunkGrid, chunk_grid, chunk_values
from symgen.study.plan import StudyPlan


def all_values(plan: StudyPlan) -> np.ndarray:
    chunks = chunk_grid(plan)
    return np.concatenate([chunk_values(plan, chunks, number) for number in range(len(chunks))])


@given(st.lists(st.integers(1, 7), min_size=1, max_size=4), st.data())
def test_boxes_cover_each_point_once(shape: list[int], data: st.DataObject) -> None:
    sides = [data.draw(st.integers(1, size)) for size in shape]
    chunks = ChunkGrid(tuple(shape), tuple(sides))
    covered = np.zeros(shape, dtype=int)
    for number in range(len(chunks)):
        covered[chunks.slices(number)] += 1
    assert (covered == 1).all()


@pytest.mark.parametrize("over", [["m=1:2:700", "l=0.3:0.8:300"], ["m=1:2:3", "l=0.3:0.8:900000"], ["m=1:2:5"]])
def test_chunks_have_neither_few_states_nor_many(over: list[str]) -> None:
    plan = plan_of(over, "inputs")
    chunks = chunk_grid(plan)
    first = np.prod([part.stop - part.start for part in chunks.slices(0)])
    assert first <= MOST_CHUNK_STATES
    assert first >= min(plan.points, FEWEST_CHUNK_STATES) / 4


def test_a_grid_has_all_combinations_in_order() -> None:
    values = all_values(plan_of(["m=1:2:300", "l=0.3:0.8:200"], "inputs"))
    expected = np.stack(np.meshgrid(np.linspace(1, 2, 300), np.linspace(0.3, 0.8, 200), indexing="ij"), axis=-1)
    assert (values == expected.reshape(-1, 2)).all()


@pytest.mark.parametrize("sample", ["random", "latin_hypercube", "sobol"])
def test_a_sample_is_one_of_its_seed(sample: str) -> None:
    one, again, other = (
        all_values(plan_of(["m=1:2", "l=0.3:0.8"], "inputs", sample=sample, count=40_000, seed=seed))
        for seed in (3, 3, 4)
    )
    assert one.shape == (40_000, 2)
    assert (one == again).all()
    assert not (one == other).any(axis=0).all()
    assert ((one >= [1, 0.3]) & (one <= [2, 0.8])).all()
    assert np.allclose(one.mean(axis=0), [1.5, 0.55], atol=0.01)
    assert len(np.unique(one[:, 0])) > 39_000


def test_a_latin_hypercube_has_a_point_in_each_stratum() -> None:
    values = all_values(plan_of(["m=0:1", "l=0:1"], "inputs", sample="latin_hypercube", count=50_000))
    for column in values.T:
        assert (np.sort((column * 50_000).astype(int)) == np.arange(50_000)).all()


def test_sobol_points_are_those_of_scipy_whatever_the_chunks() -> None:
    values = all_values(plan_of(["m=0:1", "l=0:1", "g=0:1"], "inputs", sample="sobol", count=40_000, seed=5))
    engine = qmc.Sobol(3, scramble=True, rng=np.random.default_rng(5))
    assert (values == engine.random(65_536)[:40_000]).all()
