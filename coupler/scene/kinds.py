"""Kinds of components, named on the command line."""

from pathlib import Path

from quintet.interfaces.errors import QuintetError, SceneError
from quintet.interfaces.manifest import Manifest, find, look_in, unknown_kind


def named_kind(kind: str, where: str) -> Manifest:
    """Find a kind by its installed name, or as ``module:Class`` beside or below this folder.

    `where` begins the sentence that is said when there is none.
    """
    look_in([str(Path.cwd())] if ":" in kind else [])
    try:
        return find(kind)
    except KeyError as error:
        raise SceneError(unknown_kind(f"{where} {kind}", kind)) from error
    except QuintetError:
        raise
    except AttributeError as error:
        raise SceneError(f"{where} {kind}: {error}. Name a class as module:Class.") from error
    except Exception as error:  # of any kind: the module is its author's
        raise SceneError(f"{where} {kind}: it cannot be imported ({error}).") from error
