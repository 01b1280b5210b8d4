"""How a tank moves: by a table over time, or harmonically."""

import math

import numpy as np

from quintet.components.sph_fluid.setup.trajectory import Harmonic, Spline, Trajectory
from quintet.interfaces.component import Array
from quintet.interfaces.params import DataFile, NotNegative, Number, Positive, Vector, parameters

FEWEST = 2  # rows of a table
STILL: Vector = (0.0, 0.0, 0.0)


@parameters
class Motion:
    """How something moves: displaced along x, y and z, and turned about an axis through a point.

    Either `file` or `times` give a table, through which a cubic spline goes; its velocity and
    acceleration are continuous. Its slopes at the ends are those of parabolas through three rows,
    and 0 where the first two or the last two rows are equal. Or `period` gives a harmonic motion,
    the amplitudes times sin(2πt/period); within `ramp` it grows from nothing by 10τ³ - 15τ⁴ + 6τ⁵,
    τ = t/ramp. What is displaced is turned first.

    Parameters
    ----------
    file
        Table (CSV) beside the scene: columns time and any of x, y, z, angle, with units in
        brackets, as in time [s], x [mm], angle [deg]; without brackets s, m and rad.
    times : s
        Of the rows of a table in the scene, from 0 or earlier on to the end of the run.
    displacement : m
        In these rows.
    angle : rad
        In these rows, by the right-hand rule about `axis`.
    amplitude : m
        Of a harmonic displacement.
    angle_amplitude : rad
        Of a harmonic rotation.
    period : s
        Of a harmonic motion.
    ramp : s
        In which a harmonic motion begins; with 0 the fluid starts as fast as the tank.
    axis : 1
        Direction of the axis of rotation; along y in two dimensions.
    point : m
        On the axis, where it is at no displacement.
    """

    file: DataFile | None = None
    times: tuple[Number, ...] | None = None
    displacement: tuple[Vector, ...] | None = None
    angle: tuple[Number, ...] | None = None
    amplitude: Vector = STILL
    angle_amplitude: Number = 0.0
    period: Positive | None = None
    ramp: NotNegative = 0.0
    axis: Vector | None = None
    point: Vector = STILL

    def __post_init__(self) -> None:
        """Refuse what does not say where it is at every time."""
        sources = {"file": self.file, "times": self.times, "period": self.period}
        named = [name for name, value in sources.items() if value is not None]
        if len(named) != 1:
            raise ValueError(
                "motion must have one of file, times and period; found "
                f"{' and '.join(named) or 'none'}. Give one."
            )
        self._check_keys(named[0])
        if self.period is None:
            self._check_table()
        if self.axis is not None and not math.hypot(*self.axis) > 0.0:
            raise ValueError(
                f"motion.axis must be a direction; found {self.axis}. Give it a length, as in "
                "[0, 1, 0]."
            )
        if self.axis is None and self.turns:
            raise ValueError("motion.axis is needed, as there is an angle; found none. Add it.")

    def _check_keys(self, source: str) -> None:
        """Keys of one kind of motion do not stand beside another."""
        tabled = [name for name in ("displacement", "angle") if getattr(self, name) is not None]
        swings = any(self.amplitude) or self.angle_amplitude or self.ramp
        if tabled and source != "times":
            raise ValueError(
                f"motion.{tabled[0]} belongs to times; found it with {source}. Remove one."
            )
        if swings and source != "period":
            raise ValueError(
                "motion.amplitude, angle_amplitude and ramp belong to period; found them with "
                f"{source}. Remove them."
            )
        if source == "times" and not tabled:
            raise ValueError(
                "motion.times needs displacement or angle, with a row for each time; found "
                "neither. Add one, or remove motion."
            )
        if source == "period" and not (any(self.amplitude) or self.angle_amplitude):
            raise ValueError(
                "motion.period needs an amplitude or an angle_amplitude other than 0; found "
                "neither. Add one, or remove motion."
            )

    def _check_table(self) -> None:
        """Rows of a table follow each other, and are of one length."""
        count = len(self.times or ())
        for name in ("displacement", "angle") if self.times is not None else ():
            rows = getattr(self, name)
            if rows is not None and len(rows) != count:
                raise ValueError(
                    f"motion.{name} must have a row for each of the {count} times; found "
                    f"{len(rows)}. Add or remove rows."
                )
        times, _ = self._table()
        if len(times) < FEWEST or not (np.diff(times) > 0.0).all() or times[0] > 0.0:
            raise ValueError(
                f"motion: times must be {FEWEST} or more, increase, and begin at 0 s or before; "
                f"found {len(times)} from {times[0] if len(times) else math.nan:g} s on. Correct "
                "them."
            )

    def _table(self) -> tuple[Array, Array]:
        """Times (n,) s and places (n, 4)."""
        if self.file is not None:
            # Left out of motions that the scene itself has.
            from quintet.components.sph_fluid.setup.motion_table import read_motion

            return read_motion(self.file)
        times = np.array(self.times or (), float)
        places = np.zeros((len(times), 4))
        if self.displacement is not None:
            places[:, :3] = np.array(self.displacement).reshape(-1, 3)
        if self.angle is not None:
            places[:, 3] = self.angle
        return times, places

    @property
    def trajectory(self) -> Trajectory:
        """Place over time."""
        if self.period is None:
            return Spline(*self._table())
        return Harmonic(np.array([*self.amplitude, self.angle_amplitude]), self.period, self.ramp)

    @property
    def turns(self) -> bool:
        """Whether it turns at any time."""
        if self.period is not None:
            return self.angle_amplitude != 0.0
        return bool(self._table()[1][:, 3].any())

    @property
    def shifts(self) -> tuple[bool, bool, bool]:
        """Whether it is displaced along x, y and z at any time."""
        if self.period is not None:
            moved = np.array(self.amplitude)
        else:
            moved = np.abs(self._table()[1][:, :3]).max(axis=0)
        x, y, z = (moved != 0.0).tolist()
        return x, y, z

    def least(self, axis: int, sign: float) -> float:
        """Displacement [m] along an axis that is least by its sign, over the whole motion."""
        return sign * float((sign * self.trajectory.course()[:, axis]).min())

    @property
    def direction(self) -> Array:
        """Unit vector (3,) along the axis of rotation; that of y if it has none."""
        axis = np.array((0.0, 1.0, 0.0) if self.axis is None else self.axis)
        return np.asarray(axis / math.hypot(*axis.tolist()))
