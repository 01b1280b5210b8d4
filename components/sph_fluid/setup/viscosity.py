"""How a fluid is viscous."""

from typing import Literal

from quintet.interfaces.params import NotNegative, parameters

USUAL_ALPHA = 0.1


@parameters
class Viscosity:
    """How a fluid is viscous.

    Parameters
    ----------
    artificial : 1
        α of Monaghan's artificial viscosity (1992, eq. 4.2); without it 0.1, or 0 where
        `kinematic` is given.
    kinematic : m2/s
        ν, the kinematic viscosity of the fluid itself.
    form
        How `kinematic` acts: as a Laplacian (Lo & Shao 2002), close beside walls; or along the
        line between particles (Monaghan & Gingold 1983), without which a free surface is not free
        of stress.
    """

    artificial: NotNegative | None = None
    kinematic: NotNegative = 0.0
    form: Literal["laplacian", "stress"] = "laplacian"

    @property
    def alpha(self) -> float:
        """α of the artificial viscosity: none beside the fluid's own if it is not given."""
        if self.artificial is None:
            return 0.0 if self.kinematic else USUAL_ALPHA
        return self.artificial

    @property
    def notes(self) -> tuple[str, ...]:
        """Say that there is no artificial viscosity where the fluid's own is given alone."""
        if self.artificial is not None or not self.kinematic:
            return ()
        return (
            f"viscosity.kinematic is given ({self.kinematic:g} m2/s) and viscosity.artificial is "
            "not: it is 0, so that the fluid is as viscous as it should be",
        )
