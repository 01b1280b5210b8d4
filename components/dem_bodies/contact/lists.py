"""The pairs that may touch before some point has moved by half the skin."""

from collections.abc import Mapping

import numpy as np

from quintet.components.dem_bodies.contact.ball_pairs import ball_pairs
from quintet.components.dem_bodies.contact.ball_search import list_ball_pairs, sorted_balls
from quintet.components.dem_bodies.contact.body_search import (
    body_pairs_of,
    list_body_pairs,
    with_sorted_rows,
)
from quintet.components.dem_bodies.kernels.contact_counts import count_ball_contacts, count_contacts
from quintet.components.dem_bodies.state import BallPairs, Model, State, body_pairs, sort_rows
from quintet.interfaces.component import Array, Fields

SAVED = ("history", "rolling_moment", "force")  # of the pairs of balls, with begin and partner


class ContactLists:
    """Listed pairs with the history of their contacts.

    Parameters
    ----------
    model : Model
    balls : BallPairs or None
        Pairs of balls, and of balls and planes; None if there are no balls.
    skin : float, m
        Distance within which pairs are listed.
    records_forces : bool
        Whether the force of each pair is recorded.
    """

    def __init__(
        self, model: Model, balls: BallPairs | None, skin: float, records_forces: bool
    ) -> None:
        self.model, self.balls, self.bodies = model, balls, body_pairs(0)
        self.skin, self.records_forces = skin, records_forces
        self.contacts = np.zeros(len(model.kind), np.int64)  # of each row
        self.most_contacts = 0  # that a row can have before pairs are listed again

    def renew(self, state: State) -> None:
        """Sort the rows of the balls, and list all pairs nearer than the skin."""
        model, cells = self.model, None
        if self.balls is not None:
            body, (cells, order) = state.body.copy(), sorted_balls(model, state, self.skin)
            sort_rows(model, state, order)
            self.balls = list_ball_pairs(
                model, state, cells, self.balls, body, self.skin, self.records_forces
            )
            self.bodies = with_sorted_rows(self.bodies, order)
        self.bodies = list_body_pairs(model, state, cells, self.bodies, self.skin)
        balls = np.count_nonzero(model.ball)  # the first rows, with the first spheres
        state.listed_centre[:] = state.centre
        state.listed_centre[:balls] = state.motion[:balls, :3]
        self.most_contacts = self.count_contacts(listed=True)

    def count_contacts(self, listed: bool = False) -> int:
        """Most contacts of any row; with `listed` as if all listed pairs touched."""
        self._count_others(listed)
        if (balls := self.balls) is not None:
            history = np.ones_like(balls.history) if listed else balls.history
            count_ball_contacts(balls.row, balls.partner, history, self.contacts)
        return int(self.contacts.max())

    def _count_others(self, listed: bool) -> None:
        """Count the contacts of each row but those of balls with each other and with planes."""
        pairs, model = self.bodies, self.model
        history = np.ones_like(pairs.history) if listed else pairs.history
        ends = (pairs.ends, pairs.begin, model.sphere_row, model.edge_ends)
        count_contacts(history, *ends, self.contacts)

    def save(self) -> dict[str, Array]:
        """Copy out the listed pairs and their history."""
        arrays = {"others.key": self.bodies.key, "others.history": self.bodies.history}
        if self.balls is not None:
            # Messages know no uint32.
            partner = self.balls.partner.astype(np.int64)
            arrays |= {"balls.begin": self.balls.begin, "balls.partner": partner}
            arrays |= {f"balls.{name}": array for name, array in history_of(self.balls).items()}
        return {name: array.copy() for name, array in arrays.items()}

    def load(self, saved: Fields) -> None:
        """Restore saved pairs, bit for bit."""
        pairs = body_pairs(len(saved["others.key"]))
        pairs.key[:] = saved["others.key"]
        pairs.history[:] = saved["others.history"]
        self.bodies = body_pairs_of(pairs.key, pairs)
        if self.balls is not None:
            begin, partner = np.array(saved["balls.begin"]), saved["balls.partner"]
            self.balls = ball_pairs(
                self.model, begin, partner.astype(np.uint32), self.records_forces
            )
            for name, array in history_of(self.balls).items():
                array[:] = saved[f"balls.{name}"]
        self.most_contacts = self.count_contacts(listed=True)


def history_of(balls: BallPairs) -> Mapping[str, Array]:
    """Arrays of the contacts of balls that a later step needs."""
    arrays = {name: getattr(balls, name) for name in SAVED}
    return {name: array for name, array in arrays.items() if array is not None}
