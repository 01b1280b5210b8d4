"""What a gas on several devices does not compute."""

from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.interfaces.errors import SceneError


def refuse_what_needs_one_device(params: MeshlessGasParams, ranks: int) -> None:
    """Refuse what the devices of several ranks do not compute.

    Raises
    ------
    SceneError
        With the key, and what to do.
    """
    if params.particles is not None:
        raise SceneError(
            f"particles must be left out of a gas on the devices of {ranks} ranks; found "
            f'{params.particles.drag} drag. Take one rank, or set device = "cpu".'
        )
