"""What of a structure cannot be shared out yet."""

from quintet.components.fe_plate.params import FePlateParams
from quintet.components.shared.contact.one_rank import refuse_faces


def refuse_what_needs_one_rank(params: FePlateParams, ranks: int) -> None:
    """Raise SceneError where a structure on several ranks touches faces of a partner."""
    if params.contact_with_faces:
        refuse_faces("a structure", ranks)
