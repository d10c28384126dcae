"""Filters of logs: a Butterworth low-pass without phase, differences of high order, decimation.

What is differentiated and what is fitted goes through the same filter (parallel filtering: Gautier, Dynamic
identification of robots with power model, 1997; Khalil and Dombre, Modeling, Identification and Control of Robots,
2002, ch. 12).
"""

from __future__ import annotations

import numpy as np
from scipy import signal

from symgen.identification.arrays import Array
from symgen.identification.logs.read_log import MeasuredLog
from symgen.identification.not_identified import NotIdentifiedError
from symgen.records import dataclass

# The order of the low-pass, which runs forwards and backwards.
FILTER_ORDER = 4
# The low-pass cuts off at so many times the highest frequency of the motion: torques have harmonics of it.
BEYOND_MOTION = 5.0
# Of the power of the rates, what lies at the frequencies of the motion.
POWER_OF_MOTION = 0.999
# Of the rate of samples, the highest cut-off: beyond it differences of high order lose accuracy.
HIGHEST_CUTOFF = 0.2
# Times the power of the noise, from which on a band of frequencies holds motion.
ABOVE_NOISE = 10.0
# Bands an octave in which power is averaged: rounding of encoders has lines of its own in a motion that repeats.
BANDS_AN_OCTAVE = 4
# Periods of the cut-off that are left out at both ends, where the filter has no past and no future.
LEFT_OUT = 4.0
# A motion is so many times larger than the noise at least.
LEAST_MOTION = 5.0
# What a difference of third order makes of white noise: the root of 1 + 9 + 9 + 1.
THIRD_DIFFERENCE = 20**0.5
_RATES = np.array([-1 / 60, 3 / 20, -3 / 4, 0, 3 / 4, -3 / 20, 1 / 60])


@dataclass(frozen=True, slots=True)
class FilterSettings:
    """Frequencies in Hz; one sample in `decimation` is kept, and `ends` samples are left out at both ends."""

    rate: float
    motion: float
    cutoff: float
    decimation: int
    ends: int

    def smoothed(self, values: Array) -> Array:
        """The values (N, ...) through the low-pass, forwards and backwards."""
        # beyond both ends values go on as they came: what is shorter than the filter's memory shows inside
        beyond = min(len(values) - 1, int(LEFT_OUT * self.rate / self.cutoff))
        return np.asarray(signal.sosfiltfilt(self._sections, values, axis=0, padlen=beyond), dtype=np.float64)

    def kept(self, values: Array) -> Array:
        """The low-passed values (N, ...) at the samples that are kept."""
        return self.smoothed(values)[self.places(len(values))]

    def places(self, count: int) -> slice:
        """The samples that are kept, of so many."""
        return slice(self.ends, count - self.ends, self.decimation)

    def differentiated(self, values: Array) -> Array:
        """Rates (N, ...) by central differences of order 6; the three values at both ends are repeated."""
        inner = sum(c * values[k : len(values) - 6 + k] for k, c in enumerate(_RATES) if c)
        edges = [(3, 3), *[(0, 0)] * (values.ndim - 1)]
        return np.asarray(np.pad(self.rate * np.asarray(inner), edges, mode="edge"), dtype=np.float64)

    def noise_passed(self, values: Array) -> Array:
        """The standard deviation (...) that white noise of the values (N, ...) has behind the low-pass.

        Measured by what the low-pass takes away, or by differences of third order: the smaller one has less of the
        motion in it.
        """
        _, response = signal.sosfreqz(self._sections, 4096)
        passed = np.abs(response) ** 2
        taken = np.std(values - self.smoothed(values), axis=0) / np.sqrt(np.mean((1 - passed) ** 2))
        rough = np.std(np.diff(values, 3, axis=0), axis=0) / THIRD_DIFFERENCE
        return np.asarray(np.minimum(taken, rough) * np.sqrt(np.mean(passed**2)), dtype=np.float64)

    @property
    def _sections(self) -> Array:
        sections: Array = signal.butter(FILTER_ORDER, self.cutoff, fs=self.rate, output="sos")
        return sections


def filter_settings(log: MeasuredLog, cutoff: float | None) -> FilterSettings:
    """The settings for a log: a cut-off that is not given follows from the spectrum of the motion.

    Raises NotIdentifiedError where no coordinate moves more than its noise, and for a cut-off that is too high.
    """
    rate, count = log.rate, len(log.t)
    motion = max(_highest(log.columns[name], rate) for name in log.measured)
    if not motion > 0:
        raise NotIdentifiedError(
            "nothing moves in this log, so that no parameter shows: record a motion that goes through the workspace "
            "at the speeds that the machine is used at",
            log.file,
        )
    highest = HIGHEST_CUTOFF * rate
    if cutoff is not None and cutoff > highest:
        raise NotIdentifiedError(f"a cut-off is at most {highest:.4g} Hz, a fifth of the rate of samples", log.file)
    chosen = min(highest, BEYOND_MOTION * motion) if cutoff is None else cutoff
    decimation = max(1, int(rate / (2 * chosen)))
    return FilterSettings(rate, motion, chosen, decimation, min(count // 10, int(LEFT_OUT * rate / chosen)))


def _highest(values: Array, rate: float) -> float:
    """The frequency in Hz below which nearly all of a coordinate's motion lies; 0 where it stands still."""
    noise = float(np.std(np.diff(values, 3))) / THIRD_DIFFERENCE
    if float(np.std(values)) <= LEAST_MOTION * max(noise, np.finfo(float).eps * float(np.max(np.abs(values)))):
        return 0.0
    centred = signal.detrend(values) * signal.windows.hann(len(values))
    power = np.abs(np.fft.rfft(centred))[1:] ** 2
    frequencies = np.fft.rfftfreq(len(values), 1 / rate)[1:]
    bands = (BANDS_AN_OCTAVE * np.log2(frequencies / frequencies[0])).astype(int)
    averages = (np.bincount(bands, power) / np.maximum(1, np.bincount(bands)))[bands]
    floor = float(np.mean(power[len(power) // 2 :]))
    rates = np.where(averages > ABOVE_NOISE * floor, power, 0.0) * frequencies**2
    total = np.cumsum(rates)
    return float(frequencies[int(np.searchsorted(total, POWER_OF_MOTION * total[-1]))])
