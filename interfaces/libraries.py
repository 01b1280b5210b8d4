"""Libraries that not every user needs: each belongs to an extra of the installation."""

from importlib.util import find_spec

from quintet.interfaces.errors import SceneError

EXTRAS = {
    "zenoh": "zenoh",
    "cryptography": "zenoh",
    "matplotlib": "pictures",
    "jinja2": "report",
    "pandas": "tables",
    "xarray": "tables",
    "pyvista": "views3d",
    "imageio": "views3d",
    "imageio_ffmpeg": "views3d",
    "optuna": "calibrate",
    "pint": "units",
    "pyopencl": "opencl",
}  # by the name that is imported


def is_installed(library: str) -> bool:
    """Whether a library can be imported; it is not imported here."""
    return find_spec(library) is not None


def how_to_install(library: str) -> str:
    """A sentence for users who lack a library."""
    extra = EXTRAS[library]
    return f"Install the extra {extra}: pip install 'quintet[{extra}]'."


def require(library: str, purpose: str) -> None:
    """Refuse what needs a library that is not installed."""
    if not is_installed(library):
        raise SceneError(
            f"{purpose} needs the library {library}; it is not installed. {how_to_install(library)}"
        )
