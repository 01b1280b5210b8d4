"""Contact with a partner's faces on one rank alone."""

from quintet.interfaces.component import Resources
from quintet.interfaces.errors import SceneError


def refuse_faces(what: str, ranks: int) -> None:
    """Raise SceneError: a component on several ranks touches no faces of a partner.

    `what` names the items in the message, such as ``"bodies"``.
    """
    raise SceneError(
        f"contact_with_faces must be false of {what} on {ranks} ranks; it is true. Take one rank "
        "and several threads."
    )


def require_one_rank(what: str, resources: Resources) -> None:
    """Raise SceneError if the component, which touches faces of a partner, has several ranks."""
    communicator = resources.communicator
    if communicator is not None and communicator.size > 1:
        refuse_faces(what, communicator.size)
