"""Waves that a paddle makes: regular ones, or those of a spectrum."""

import cmath
import math
from functools import lru_cache
from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np
from pydantic import Field, NonNegativeInt

from quintet.interfaces.component import Array
from quintet.interfaces.params import Number, Positive, Vector, parameters

if TYPE_CHECKING:
    from quintet.components.sph_fluid.setup.paddle_motion import PaddleMotion
    from quintet.components.sph_fluid.setup.wave_theory import Paddle

LEAST_PARTICLES = 4  # in the height of waves: fewer damp them within a few of their lengths
LONGEST = 8.0 * math.pi**2 / 3.0  # H L²/h³ below which waves of second order have one crest
Components = Annotated[int, Field(ge=2, le=1000)]
Enhancement = Annotated[float, Field(ge=1.0, le=10.0)]


@parameters
class Waves:
    """Waves that a piston or a flap makes, of the water's depth, from still water on.

    Regular waves have a `height` and a `period`, irregular ones a `spectrum`, a
    `significant_height` and a `peak_period`. The paddle moves by linear theory (Biésel 1951); with
    `order` 2 it also moves at twice the frequency, so that regular waves are those of Stokes, and
    no wave of twice the frequency runs freely (Schäffer 1996; in long waves Madsen 1971). The
    motion grows from nothing within `ramp` as a harmonic motion does.

    Parameters
    ----------
    paddle
        Displaced as a whole, or turned about a hinge.
    depth : m
        Of the still water.
    bottom : m
        Height of the bed under it.
    height : m
        Of regular waves, from trough to crest.
    period : s
        Of regular waves.
    order
        Of the theory; 2 is for regular waves.
    phase : rad
        Of regular waves: the paddle moves as sin(2πt/period + phase); 0 if not given.
    spectrum
        Of irregular waves.
    significant_height : m
        Of irregular waves, 4 √m₀.
    peak_period : s
        Of irregular waves.
    peak_enhancement : 1
        γ of the JONSWAP spectrum; 3.3 if not given.
    components : 1
        Number of waves that make a spectrum; 50 if not given.
    seed : 1
        Of the phases and frequencies of these; 0 if not given.
    ramp : s
        In which the motion begins; one period, or one peak period, if not given.
    heading : 1
        Along which the waves run; level.
    hinge : m
        A point on the axis of a flap, which is level and across the waves.
    gravity : m/s2
        That of the fluid.
    absorption
        Whether a piston also moves by the difference of the surface in front of it from what theory
        foresees, so that waves that come back leave the tank there.
    """

    paddle: Literal["piston", "flap"]
    depth: Positive
    bottom: Number = 0.0
    height: Positive | None = None
    period: Positive | None = None
    order: Literal[1, 2] = 1
    phase: Number | None = None
    spectrum: Literal["jonswap", "pierson_moskowitz"] | None = None
    significant_height: Positive | None = None
    peak_period: Positive | None = None
    peak_enhancement: Enhancement | None = None
    components: Components | None = None
    seed: NonNegativeInt | None = None
    ramp: Positive | None = None
    heading: Vector = (1.0, 0.0, 0.0)
    hinge: Vector | None = None
    gravity: Positive = 9.81
    absorption: bool = False

    def __post_init__(self) -> None:
        """Refuse what no paddle can make."""
        self._check_keys()
        if self.heading[2] != 0.0 or not math.hypot(*self.heading) > 0.0:
            raise ValueError(
                "waves.heading must be level and have a length, as in [1, 0, 0]; found "
                f"{self.heading}. Correct it."
            )
        if (self.paddle == "flap") != (self.hinge is not None):
            raise ValueError(
                "waves.hinge belongs to a flap, and a flap needs one; found paddle "
                f"{self.paddle} and hinge {self.hinge}. Correct one of them."
            )
        if self.hinge is not None and not self.hinge[2] < self.level:
            raise ValueError(
                f"waves.hinge must be below still water, at {self.level:g} m; found "
                f"{self.hinge[2]:g} m. Lower it."
            )
        if self.absorption and self.paddle == "flap":
            raise ValueError(
                "waves.absorption is for a piston, whose velocity is that of long waves at all "
                "depths; found a flap. Set paddle to piston, or leave absorption out."
            )
        self._check_height()

    def _check_keys(self) -> None:
        regular = {"height": self.height, "period": self.period}
        irregular = {
            "spectrum": self.spectrum,
            "significant_height": self.significant_height,
            "peak_period": self.peak_period,
        }
        keys_set = [{k for k, v in keys.items() if v is not None} for keys in (regular, irregular)]
        if keys_set not in ([set(regular), set()], [set(), set(irregular)]):
            names = ", ".join(sorted(set().union(*keys_set))) or "none of them"
            raise ValueError(
                "waves must have height and period, or spectrum, significant_height and "
                f"peak_period; found {names}. Give all keys of one kind of waves."
            )
        unused = {"phase": self.phase}
        if self.spectrum is None:
            unused = {"seed": self.seed, "components": self.components}
        if self.spectrum != "jonswap":
            unused["peak_enhancement"] = self.peak_enhancement
        if names := ", ".join(name for name, value in unused.items() if value is not None):
            kind = "regular waves" if self.spectrum is None else f"the spectrum {self.spectrum}"
            raise ValueError(
                "waves.phase is for regular waves, seed and components for a spectrum, and "
                f"peak_enhancement for jonswap; found {names} with {kind}. Remove {names}."
            )
        if self.spectrum is not None and self.order == 2:
            raise ValueError(
                "waves.order 2 is for regular waves; found it with a spectrum. Set order to 1."
            )

    def _check_height(self) -> None:
        # Left out of scenes without wave makers.
        from quintet.components.sph_fluid.setup.wave_theory import BREAKING, wave_number

        height, period = self.significant, self.longest_period
        length = 2.0 * math.pi / wave_number(2.0 * math.pi / period, self.depth, self.gravity)
        highest = BREAKING * length * math.tanh(2.0 * math.pi * self.depth / length)
        name = "height" if self.height is not None else "significant_height"
        if height >= highest:
            raise ValueError(
                f"waves.{name} must be less than that of breaking waves, {highest:.4g} m at a "
                f"length of {length:.4g} m in water of {self.depth:g} m (Miche 1944); found "
                f"{height:g} m. Lower it, or lengthen the period."
            )
        ursell = height * length**2 / self.depth**3
        if self.order == 2 and ursell >= LONGEST:
            raise ValueError(
                f"waves.order 2 is for waves with H L²/h³ below 8π²/3 = {LONGEST:.3g}, whose "
                f"troughs have no crest of their own; found {ursell:.3g}. Lower the height, or set "
                "order to 1."
            )

    @property
    def significant(self) -> float:
        """Height, or significant height [m]."""
        return float(self.height or self.significant_height or 0.0)

    @property
    def longest_period(self) -> float:
        """Period, or that of the peak [s]."""
        return float(self.period or self.peak_period or 0.0)

    @property
    def level(self) -> float:
        """Height [m] of still water."""
        return self.bottom + self.depth

    @property
    def water(self) -> "Paddle":
        """The paddle and the water, for the theory."""
        # Left out of scenes without wave makers.
        from quintet.components.sph_fluid.setup.wave_theory import Paddle

        hinge = None if self.hinge is None else self.level - self.hinge[2]
        return Paddle(self.depth, hinge, self.gravity)

    @property
    def trajectory(self) -> "PaddleMotion":
        """Place over time."""
        return _paddle_motion(self)

    @property
    def turns(self) -> bool:
        """Whether it is turned."""
        return self.paddle == "flap"

    @property
    def shifts(self) -> tuple[bool, bool, bool]:
        """Whether it is displaced along x, y and z at any time."""
        x, y, z = ((part != 0.0) and not self.turns for part in self.heading)
        return x, y, z

    def least(self, axis: int, sign: float) -> float:
        """Displacement [m] along an axis that is least by its sign, over the whole motion."""
        return sign * float((sign * self.trajectory.course()[:, axis]).min())

    @property
    def forward(self) -> Array:
        """Unit vector (3,) along which the waves run."""
        return np.array(self.heading) / math.hypot(*self.heading)

    @property
    def direction(self) -> Array:
        """Unit vector (3,) along a flap's axis: turned about it, the top goes with the waves."""
        x, y, _ = self.forward.tolist()
        return np.array([-y, x, 0.0])

    @property
    def point(self) -> Vector:
        """Point [m] on the axis of rotation."""
        return (0.0, 0.0, 0.0) if self.hinge is None else self.hinge


@lru_cache(maxsize=16)
def _paddle_motion(waves: Waves) -> "PaddleMotion":
    """Motion of the paddle: each wave by the transfer function of its frequency."""
    # Left out of scenes without wave makers.
    from quintet.components.sph_fluid.setup.paddle_motion import PaddleMotion
    from quintet.components.sph_fluid.setup.wave_spectra import components
    from quintet.components.sph_fluid.setup.wave_theory import second_order, transfer

    paddle = waves.water
    if waves.height is not None:
        omega = 2.0 * math.pi / waves.longest_period
        stroke = waves.height / float(transfer(omega, paddle, 0)[1][0].real)
        rotation = cmath.exp(1j * (waves.phase or 0.0))
        amplitudes, frequencies = [0.5 * stroke * rotation], [omega]
        if waves.order == 2:
            amplitudes.append(second_order(0.5 * stroke, omega, paddle) * rotation * rotation)
            frequencies.append(2.0 * omega)
    else:
        enhancement = (waves.peak_enhancement or 3.3) if waves.spectrum == "jonswap" else 1.0
        statistics = (waves.significant, waves.longest_period, enhancement)
        spectrum = components(*statistics, waves.components or 50, waves.seed or 0)
        rows = zip(*spectrum, strict=True)
        amplitudes, frequencies = [], []
        for amplitude, omega, phase in (map(float, row) for row in rows):
            factor = float(transfer(omega, paddle, 0)[1][0].real)
            amplitudes.append(amplitude / factor * cmath.exp(1j * phase))
            frequencies.append(omega)
    vector = np.array([*waves.forward, 0.0])
    if paddle.hinge is not None:
        vector = np.array([0.0, 0.0, 0.0, 1.0 / paddle.hinge])
    ramp = waves.ramp or waves.longest_period
    return PaddleMotion(vector, np.array(amplitudes), np.array(frequencies), ramp)
