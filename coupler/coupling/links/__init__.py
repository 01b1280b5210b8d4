"""Links: one file, one kind of exchange between two components.

A kind is a `keys.LinkKind`, found by its name under the entry-point group ``quintet.links``; only
kinds that a scene names are imported.
"""

from quintet.coupler.coupling.links.keys import LinkKind
from quintet.interfaces.errors import SceneError
from quintet.interfaces.installed import installed


def known_links() -> dict[str, str]:
    """Kinds of links that are installed, with the functions that make them."""
    return {entry.name: entry.value for entry in installed("quintet.links")}


def maker(kind: str) -> LinkKind:
    """Return what makes links of a kind, with its keys; KeyError if none is installed."""
    entry = next((entry for entry in installed("quintet.links") if entry.name == kind), None)
    if entry is None:
        raise KeyError(kind)
    loaded = entry.load()
    if not isinstance(loaded, LinkKind):
        raise SceneError(
            f"link {kind}: {entry.value} does not publish its keys. Make it with with_keys of "
            "quintet.coupler.coupling.links.keys."
        )
    return loaded


def keys_of(kind: object) -> type | None:
    """Parameter class of a kind of link; None of what names no installed kind."""
    return maker(kind).keys if isinstance(kind, str) and kind in known_links() else None
