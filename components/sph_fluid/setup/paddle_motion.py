"""Motion of a paddle that makes waves, and the surface in front of it that theory foresees."""

import cmath
import math

import numpy as np

from quintet.components.sph_fluid.setup.trajectory import Instant, growth
from quintet.components.sph_fluid.setup.wave_theory import Paddle, bound_amplitude, transfer
from quintet.interfaces.component import Array

SAMPLED = 500  # of the longest periods, that the course looks at
EACH = 24  # places in the shortest period


class PaddleMotion:
    """X(t) = r(t) Σ Im(a_n e^{iω_n t}) along a vector (4,); r as in `Harmonic`.

    Parameters
    ----------
    vector : Array
        (4,) Displacement along x, y and z, 1, and angle, rad/m, for X = 1 m.
    amplitudes : Array
        (n,) a, complex, m.
    frequencies : Array
        (n,) ω, 1/s.
    ramp : float, s
    """

    end = math.inf

    def __init__(self, vector: Array, amplitudes: Array, frequencies: Array, ramp: float) -> None:
        self.vector, self.ramp = vector, ramp
        self.amplitudes, self.frequencies = amplitudes, frequencies
        self.parts = list(zip(amplitudes.tolist(), frequencies.tolist(), strict=True))

    def at(self, time: float) -> Instant:
        """Place, velocity and acceleration at a time [s]."""
        waves = [(a * cmath.exp(1j * omega * time), omega) for a, omega in self.parts]
        x = math.fsum(wave.imag for wave, _ in waves)
        dx = math.fsum(omega * wave.real for wave, omega in waves)
        ddx = -math.fsum(omega * omega * wave.imag for wave, omega in waves)
        r, dr, ddr = self.growth(time)
        return Instant(
            self.vector * (r * x),
            self.vector * (dr * x + r * dx),
            self.vector * (ddr * x + 2.0 * dr * dx + r * ddx),
        )

    def growth(self, time: float) -> tuple[float, float, float]:
        """Share r of the motion at a time [s], 1, and its derivatives, 1/s and 1/s2."""
        return growth(time, self.ramp)

    def course(self) -> Array:
        """Places (n, 4): of regular waves in a period, of others in many; a straight line."""
        slowest, fastest = float(self.frequencies[0]), float(self.frequencies[-1])
        # Regular waves have one frequency, or a second that is exactly twice it.
        regular = len(self.frequencies) == 1 or self.frequencies.tolist() == [
            slowest,
            2.0 * slowest,
        ]
        span = 2.0 * math.pi / slowest * (1 if regular else SAMPLED)
        count = math.ceil(span * fastest / (2.0 * math.pi) * EACH)
        times = np.linspace(0.0, span, (8 if regular else 1) * count + 1)
        x = np.zeros_like(times)
        for amplitude, omega in self.parts:
            x += (amplitude * np.exp(1j * omega * times)).imag
        return np.linspace(float(x.min()), float(x.max()), 65)[:, np.newaxis] * self.vector


class ForeseenSurface:
    """Elevation in front of a paddle that theory foresees, beside it evanescent modes included.

    Of the first order; of regular waves with the bound second harmonic of a Stokes wave.

    Parameters
    ----------
    motion : PaddleMotion
    paddle : Paddle
    distance : float, m
        From the paddle.
    height : float or None, m
        Of regular waves.
    """

    def __init__(
        self, motion: PaddleMotion, paddle: Paddle, distance: float, height: float | None
    ) -> None:
        self.motion = motion
        first = motion.parts[:1] if height is not None else motion.parts
        self.parts: list[tuple[complex, complex, float, float]] = []
        for amplitude, omega in first:
            k, factors = transfer(omega, paddle)
            reached = 1j * amplitude * factors * np.exp(-1j * k * distance)
            wave, beside = complex(reached[0]), complex(reached[1:].sum())
            self.parts.append((wave, beside, float(k[0].real), omega))
        self.bound = 0.0j, 0.0, 0.0
        if height is not None:
            amplitude, omega = first[0]
            number = self.parts[0][2]
            phase = cmath.phase(amplitude) - number * distance
            bound = bound_amplitude(height, number, paddle.depth)
            self.bound = 1j * bound * cmath.exp(2j * phase), 2.0 * number, 2.0 * omega

    def at(self, time: float, displacement: float = 0.0) -> float:
        """Elevation above still water at a time [s] before a paddle that is displaced [m]; m.

        Waves run in the tank, and are seen at the displaced place; evanescent modes belong to the
        paddle, and go with it. A bound harmonic is of the square of the waves that grow.
        """
        r, _, _ = self.motion.growth(time)
        first = math.fsum(
            (
                (wave * cmath.exp(-1j * k * displacement) + beside) * cmath.exp(1j * omega * time)
            ).imag
            for wave, beside, k, omega in self.parts
        )
        amplitude, k, omega = self.bound
        second = (amplitude * cmath.exp(1j * (omega * time - k * displacement))).imag
        return r * first + r * r * second
