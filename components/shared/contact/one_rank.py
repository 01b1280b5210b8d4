"""Contact with a partner's faces on one rank alone."""

from quintet.interfaces.component import Resources
from quintet.interfaces.errors import SceneError


def require_one_rank(what: str, resources: Resources) -> None:
    """Raise SceneError if the component runs on several ranks.

    `what` names the items in the message, such as ``"bodies"``.
    """
    communicator = resources.communicator
    if communicator is not None and communicator.size > 1:
        raise SceneError(
            f"contact_with_faces must be false of {what} on {communicator.size} ranks; it is true. "
            "Take one rank and several threads."
        )
