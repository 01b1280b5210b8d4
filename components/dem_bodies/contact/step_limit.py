"""The stable step: a fraction of a contact's duration, shorter where many contacts hold one body.

While nothing can touch, the step is longer.
"""

import math
from dataclasses import dataclass

from quintet.components.dem_bodies.contact.lists import ContactLists
from quintet.components.dem_bodies.contact.materials import DURATION, SPEED_UP
from quintet.components.dem_bodies.laws import DAMPING
from quintet.components.dem_bodies.state import (
    LARGEST_ACCELERATION,
    LARGEST_SPEED,
    SMALLEST_GAP,
    STIFFEST,
    TRAVEL,
    Model,
    State,
)
from quintet.components.shared.search.verlet_list import slack

SHARE = 0.75  # of the limits: the sums leave out how neighbours move
TURN = 0.05  # rad in a step of a free body that is no sphere: its energy is then kept to 1e-4


@dataclass(frozen=True)
class FixedStep:
    """A step that a scene sets."""

    length: float  # s

    def stable(self, state: State, lists: ContactLists) -> float:
        """Return the step [s]."""
        return self.length


@dataclass(frozen=True)
class StepLimit:
    """The stable step of bodies in contact."""

    frequency: float  # rad/s, √(S_n/m*) of the expected impacts
    damping: float  # ζ of the most damped pair of materials
    steps_per_contact: int
    longest: float  # s
    room: float  # m, least contact radius or half thickness: no two approach by more in a step

    def stable(self, state: State, lists: ContactLists) -> float:
        """Return the step [s] that the last step's contacts, gaps and speeds allow."""
        report, longest, model = state.report, self.longest, lists.model
        stiffest = math.sqrt(report[STIFFEST])  # rad/s
        ω = max(self.frequency, stiffest)
        contact = DURATION * SPEED_UP / ω / self.steps_per_contact
        if many_contacts_step(lists.most_contacts, stiffest, self.damping) < contact:
            touching = lists.count_contacts()
            contact = min(contact, many_contacts_step(touching, stiffest, self.damping))
        # Pairs that are not listed were further apart than the skin, and may have come nearer.
        gap = min(report[SMALLEST_GAP], slack(lists.skin, math.sqrt(report[TRAVEL])))
        if len(model.bounding_radius) == 1:  # it turns within its bounding sphere
            gap = max(gap, clearance(model, state))
            longest = min(longest, turning_step(model, state))
        speed = report[LARGEST_SPEED] + report[LARGEST_ACCELERATION] * longest
        free = gap / (2.0 * speed) if speed > 0.0 else longest
        # Bodies far faster than the expected impact would pass through each other unseen.
        fastest = report[LARGEST_SPEED] + report[LARGEST_ACCELERATION] * contact
        contact = min(contact, self.room / (2.0 * fastest)) if fastest > 0.0 else contact
        return float(min(longest, max(free, contact)))


def clearance(model: Model, state: State) -> float:
    """Distance [m] of the first row's bounding sphere from the nearest plane."""
    plane, x = model.plane, state.position[0]
    away = plane[:, 0] * x[0] + plane[:, 1] * x[1] + plane[:, 2] * x[2] - plane[:, 3]
    return float((away - model.bounding_radius[0]).min(initial=math.inf))


def turning_step(model: Model, state: State) -> float:
    """Step [s] that resolves the rotation of the first row, if its axis moves."""
    if model.isotropic[0]:
        return math.inf
    x, y, z = state.angular_velocity[0].tolist()
    return TURN / max(math.sqrt(x * x + y * y + z * z), 1e-300)


def many_contacts_step(contacts: int, ω: float, ζ: float) -> float:
    """Largest step that is stable where many contacts hold one body.

    n springs side by side hold a body n times as fast, velocity Verlet's limit being 2/ω. Its
    dampers, whose velocity is predicted from the last force, are stable for Σ c/m* dt < 1.

    Parameters
    ----------
    contacts : int
    ω : float, rad/s
        Frequency of the stiffest, √(S_n/m*).
    ζ : float
        Damping ratio of the most damped.

    Returns
    -------
    float, s
    """
    if not contacts or not ω > 0.0:
        return math.inf
    damper, spring = contacts * DAMPING * ζ * ω, math.sqrt(contacts) * ω  # 1/s
    return SHARE * min(2.0 / spring, 1.0 / damper if damper > 0.0 else math.inf)
