"""Films of water in narrow gaps; imported only by a scene that asks.

Between two faces nearer than WIDEST spacings lies a film that the particles do not show, or not
wholly. It is filled from its rim, where it has the pressure of the fluid outside (none where that
is dry), and pushes its faces apart, one as much as the other. Reynolds' equation of lubrication,

    ∂(θw)/∂t = ∇·(K ∇(p - ρ₀ g·r)),    K = w³/(12μ),    p ≥ 0,  θ ≤ 1,  p (1 - θ) = 0,

says how fast the share θ of the width w that is full of water grows, and with which pressure: a
film that is not full has none (Elrod, ASME J. Lubr. Technol. 103 (1981) 350), faces that part
draw it down and faces that close press it up. Water does not flow in faster than the pressure at
the rim can drive it, √(2p/ρ₀): this bounds K in wide gaps. The film's own mass is left out.

Particles get into gaps of half a spacing and more, but the kernel reaches through a gap and finds
less water there than in the open. Per area of a flat face, fluid of pressure p presses with

    2p Σ_j V_j W(r_face - r_j),

the sum over columns of samples below it of what pairs give, ∫∂W/∂z dz = W. Summed over all but
the body itself this is p. So the film presses with its own pressure on that part of it alone which
particles leave, as many of them as there are in the gap, and nothing is pressed twice.
"""

import numpy as np

from quintet.components.shared.search.neighbours import Lists
from quintet.components.sph_fluid.boundary.film_geometry import (
    Films,
    find_faces,
    find_films,
)
from quintet.components.sph_fluid.boundary.film_rows import FilmRows
from quintet.components.sph_fluid.boundary.kernels.films import (
    WIDEST,
    FilmPlaces,
    face_normals,
    solve_reynolds,
)
from quintet.components.sph_fluid.boundary.method import MakeFilmRows
from quintet.components.sph_fluid.boundary.samples import Samples
from quintet.components.sph_fluid.constants import constants
from quintet.components.sph_fluid.laws import Constants
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.ranks.method import Ranks
from quintet.components.sph_fluid.state import State
from quintet.interfaces.component import Fields

FADING = 0.85  # spacings below WIDEST over which films fade out, as particles get in and press
WATER = 1e-3  # Pa s, its viscosity
LARGEST = 0.1  # of the speed of sound, velocity: a pressure above ρu² is sound, not flow
SWEEPS = 20  # over the film in each step; it starts from the last step's pressure


class LubricationFilms:
    """The films of one fluid."""

    def __init__(
        self,
        params: SphFluidParams,
        samples: Samples,
        ranks: Ranks,
        make_rows: MakeFilmRows | None = None,
    ) -> None:
        self.params, self.samples, self.constants = params, samples, constants(params)
        self.ranks, self._make_rows = ranks, make_rows or FilmRows
        self.notes: list[str] = []

    def join(self, state: State, static: Fields) -> None:
        """Make room for films at all samples."""
        state.film = np.zeros((len(self.samples.volume), 3))

    def load(self, state: State) -> None:
        """Nothing to do: films are found with the lists."""

    def resize(self, state: State, lists: Lists) -> None:
        """Find the films of a state with new lists."""
        if len(state.film):
            spacing = self.params.spacing
            faces = find_faces(state, self.ranks, spacing)
            self.films = find_films(faces, self.samples, spacing, self.constants)
            self.rows = self._make_rows(self.films, faces, self.ranks)

    def advance(self, state: State, lists: Lists, dt: float) -> None:
        """Advance the films by a step [s], and add their push to the samples' force."""
        if len(state.film):
            advance(self.films, self.rows, state, lists, dt, self.params, self.constants)


def advance(
    films: Films, rows: FilmRows, state: State, lists: Lists, dt: float, params: SphFluidParams,
    constants: Constants,
) -> None:  # fmt: skip
    """Advance films by a step [s]; add their push to the samples' force."""
    spacing, density = params.spacing, params.density
    near_side, far_side = rows.now(state)
    near_arm, far_arm = near_side[:, 5:] - near_side[:, :3], far_side[:, 5:] - far_side[:, :3]
    normal = face_normals(near_arm, far_arm)
    below, beyond = (np.einsum("nd,nd->n", vectors, normal) for vectors in (near_arm, far_arm))
    foot = near_side[:, :3] + 0.5 * below[:, None] * normal
    gap = np.einsum("nd,nd->n", foot - far_side[:, :3], normal) - 0.5 * beyond
    width = np.maximum(gap, params.boundary.roughness)
    weight = density * np.array(params.gravity)
    outside = near_side[:, 4] * near_side[:, 3] ** 2
    outside = np.where(outside > 0.0, outside + (foot - near_side[:, :3]) @ weight, 0.0)
    outside = np.minimum(outside, density * (LARGEST * params.sound_speed) ** 2)
    driving = max(float(outside[films.rim].max(initial=0.0)), 1.0)
    bound = width * films.size * np.sqrt(2.0 / (density * driving))
    transmissivity = np.minimum(width**3 / (12.0 * WATER), bound)
    pressure, share, previous_width = state.film[films.sample].T.copy()
    had_film = previous_width > 0.0
    stored = np.where(had_film, share * previous_width, 0.0)
    places = FilmPlaces(
        films.rim, films.begin, films.near, width, foot, outside, stored, transmissivity
    )
    x, y, z = weight.tolist()
    solve_reynolds(places, spacing**2 / dt, (x, y, z), SWEEPS, pressure, share)
    state.film[:] = 0.0
    state.film[films.sample] = np.stack([pressure, share, width], axis=1)
    water_share = rows.fluid_share(state, foot, lists, constants)
    film_share = 2.0 * np.maximum(1.0 - films.own_share - water_share, 0.0)
    film_share *= np.clip((WIDEST - width / spacing) / FADING, 0.0, 1.0)
    force = (pressure * film_share * films.area)[:, None] * normal
    np.add.at(state.force, films.sample, force)
    bodies = films.facing >= 0
    np.add.at(state.force, films.facing[bodies], -force[bodies])
