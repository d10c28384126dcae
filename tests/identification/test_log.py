"""Logs: columns, units, samples and times, and all mistakes at once with their places."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from identified_machines import ARM_WITH_FRICTION, FOUR_BAR_WITH_NAMES

from symgen.diagnostics import ModelError
from symgen.identification.logs.filtering import FilterSettings, filter_settings
from symgen.identification.logs.read_log import FEWEST_SAMPLES, MeasuredLog, read_log
from symgen.identification.not_identified import NotIdentifiedError
from symgen.model.load import load_text
from symgen.model.model import Model

ARM = load_text(ARM_WITH_FRICTION, "arm.yaml")
FOUR_BAR = load_text(FOUR_BAR_WITH_NAMES, "four_bar.yaml")


def rows(count: int = FEWEST_SAMPLES) -> list[list[str]]:
    return [[f"{k / 100:.2f}", f"{k % 7}", f"{k % 5}.5", "1e-1", "-2"] for k in range(count)]


def written(folder: Path, header: str, samples: list[list[str]]) -> Path:
    path = folder / "log.csv"
    path.write_text("\n".join([header, *map(",".join, samples)]) + "\n", encoding="utf-8")
    return path


def mistakes(path: Path, model: Model = ARM) -> str:
    with pytest.raises(ModelError) as raised:
        read_log(path, model)
    return str(raised.value)


def test_a_log_is_read_by_names_with_units_of_the_model(tmp_path: Path) -> None:
    log = read_log(written(tmp_path, "t [s], u_b[Nm],b [rad],a,u_a [N·m]", rows()), ARM)
    assert log.rate == pytest.approx(100)
    assert log.measured == ("a", "b")
    assert log.columns["b"][3] == 3.5
    assert log.columns["u_b"][3] == 3
    assert log.columns["a"][0] == 0.1


def test_rates_and_accelerations_are_columns_of_their_own(tmp_path: Path) -> None:
    samples = [[*row, "3", "4"] for row in rows()]
    header = "t,a,b,u_a,u_b,a_dot [rad/s],a_ddot [rad/s^2]"
    log = read_log(written(tmp_path, header, samples), ARM)
    assert log.columns["a_dot"][5] == 3
    assert log.columns["a_ddot"][5] == 4


@pytest.mark.parametrize(
    ("header", "message", "remedy"),
    [
        ("t,a,b,u_a", "log.csv:1:1: there is no column `u_b`", "add the column `u_b`"),
        ("t,a,b,u_a,u_b,elbow", "log.csv:1:15: unknown column `elbow`", "remove the column"),
        ("t,a,b,u_a,u_b,", "log.csv:1:15: a column without a name", "remove the column"),
        ("t,a,b,u_a,u_b,a", "log.csv:1:15: a second column `a`", "remove one of the two"),
        ("t,a [deg],b,u_a,u_b", "log.csv:1:3: the unit of `a`, `deg`, is not read", "write angles in rad"),
        ("t [ms],a,b,u_a,u_b", "log.csv:1:1: `t` is in ms, which is 10**-3*s: it should be in s", "convert"),
        ("t,a,b,u_a [N],u_b", "`u_a` is in N, which is", "convert"),
        ("t,a,b,u_a [],u_b", "the unit of `u_a` is empty", "write it"),
        ("t,a,a_dot,u_a,u_b", "there is no column `b`, and the other coordinates", "add the column `b`"),
        ("time,a,b,u_a,u_b", "there is no column `t`", "add the column `t`"),
        ("t;a;b;u_a;u_b", "columns are separated by `;`", "by commas"),
        ("t\ta\tb\tu_a\tu_b", "columns are separated by tabs", "by commas"),
    ],
)
def test_mistakes_in_the_first_line(tmp_path: Path, header: str, message: str, remedy: str) -> None:
    width = header.count(",") + 1
    text = mistakes(written(tmp_path, header, [(row * 2)[:width] for row in rows()]))
    assert message in text
    assert remedy in text


@pytest.mark.parametrize(
    ("line", "column", "cell", "message"),
    [
        (12, 2, "1,5", "log.csv:12:1: a sample of 6 cells, where the first line names 5 columns"),
        (12, 2, "one", "log.csv:12:8: `one` is no number"),
        (12, 2, "", "log.csv:12:8: an empty cell"),
        (12, 2, "nan", "log.csv:12:8: `nan` is no measured value"),
        (12, 4, "inf", "log.csv:12:17: `inf` is no measured value"),
        (12, 0, "0.05", "log.csv:12:1: the time runs backwards or stands still here"),
        (12, 0, "0.104", "log.csv:12:1: a step of the time that differs from the others"),
    ],
)
def test_mistakes_in_samples(tmp_path: Path, line: int, column: int, cell: str, message: str) -> None:
    samples = rows()
    samples[line - 2][column] = cell
    assert message in mistakes(written(tmp_path, "t,a,b,u_a,u_b", samples))


def test_missing_samples_and_logs_the_wrong_way_around(tmp_path: Path) -> None:
    samples = rows(FEWEST_SAMPLES + 2)
    gap = mistakes(written(tmp_path, "t,a,b,u_a,u_b", samples[:40] + samples[42:]))
    assert "log.csv:42:1: a gap in the time: samples are missing before this one" in gap
    assert "the time does not run forwards" in mistakes(written(tmp_path, "t,a,b,u_a,u_b", samples[::-1]))
    empty = mistakes(written(tmp_path, "t,a,b,u_a,u_b", [*samples[:40], [], *samples[40:]]))
    assert "log.csv:42:1: an empty line, where a sample is missing" in empty
    few = mistakes(written(tmp_path, "t,a,b,u_a,u_b", samples[:50]))
    assert "50 samples are too few" in few
    assert f"record {FEWEST_SAMPLES} at least" in few


def test_all_mistakes_are_told_at_once(tmp_path: Path) -> None:
    samples = rows()
    samples[5][1], samples[9][2], samples[20][0] = "x", "nan", "0.1"
    text = mistakes(written(tmp_path, "t,a,bb,u_a,u_b", samples))
    for message in ("unknown column `bb`", "did you mean `b`?", "`x` is no number", "no measured value", "backwards"):
        assert message in text


def test_text_in_another_encoding(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_bytes(b"t,a,b\n0,\xff,1\n")
    assert "log.csv:2:1: the file is not text in UTF-8" in mistakes(path)


def test_any_coordinates_that_determine_the_motion_will_do(tmp_path: Path) -> None:
    samples = [row[:4] for row in rows()]
    assert read_log(written(tmp_path, "t,b,u,v", samples), FOUR_BAR).measured == ("b",)
    text = mistakes(written(tmp_path, "t,u,v,a_dot", samples), FOUR_BAR)
    assert "there is no column `a`" in text


def waves(frequency: float, seconds: float = 10.0, rate: float = 200.0, noise: float = 1e-4) -> MeasuredLog:
    t = np.arange(round(seconds * rate)) / rate
    added = noise * np.random.default_rng(1).standard_normal(len(t))
    return MeasuredLog("log.csv", t, {"a": np.sin(2 * np.pi * frequency * t) + added}, ("a",))


@pytest.mark.parametrize("frequency", [0.7, 3.0, 6.0])
def test_the_low_pass_follows_the_motion(frequency: float) -> None:
    settings = filter_settings(waves(frequency), None)
    assert settings.motion == pytest.approx(frequency, rel=0.25)
    assert settings.cutoff == pytest.approx(5 * settings.motion)
    assert settings.decimation == int(200 / (2 * settings.cutoff))
    assert filter_settings(waves(frequency), 12.0).cutoff == 12.0


@pytest.mark.parametrize("amplitude", [0.0, 1e-4])
def test_nothing_moves(amplitude: float) -> None:
    log = waves(1.0, noise=amplitude)
    still = MeasuredLog("log.csv", log.t, {"a": log.columns["a"] - np.sin(2 * np.pi * log.t) + 0.3}, ("a",))
    with pytest.raises(NotIdentifiedError, match="nothing moves"):
        filter_settings(still, None)


def test_filtered_and_differentiated_without_phase() -> None:
    """A wave at a fifth of the cut-off keeps its size to 1e-5, and its rate to 1e-6 of differences of order 6."""
    settings = FilterSettings(200.0, 2.0, 10.0, 5, 80)
    t = np.arange(2000) / 200
    wave, rate = np.sin(4 * np.pi * t), 4 * np.pi * np.cos(4 * np.pi * t)
    inner = slice(200, -200)
    assert np.allclose(settings.smoothed(wave)[inner], wave[inner], atol=1e-5)
    assert np.allclose(settings.differentiated(wave)[inner], rate[inner], atol=1e-6 * 4 * np.pi)
    assert settings.kept(wave).shape == (len(range(80, 1920, 5)),)


def test_noise_is_measured_by_what_the_low_pass_takes_away() -> None:
    settings = FilterSettings(200.0, 2.0, 10.0, 5, 80)
    noise = 0.3 * np.random.default_rng(2).standard_normal((20_000, 2))
    behind = np.std(settings.smoothed(noise), axis=0)
    assert np.allclose(settings.noise_passed(noise), behind, rtol=0.05)
