"""A command takes a scene, or ``--all`` for the scenes that come with quintet."""

import argparse

from quintet.interfaces.errors import SceneError

OF_A_SCENE = {"--preset": "preset", "--set": "settings", "--swap": "swap"}


def require_scene_or_all(command: str, options: argparse.Namespace) -> None:
    """Refuse a command without a scene and without --all, or with both."""
    if options.all == (options.scene is not None):
        raise SceneError(f"{command} needs either a scene or --all. Give one of them.")


def refuse_with_all(command: str, options: argparse.Namespace, *others: str) -> None:
    """Refuse the options of a single scene, and those others, beside --all."""
    refused = OF_A_SCENE | {f"--{other}": other for other in others}
    wrong = [option for option, name in refused.items() if getattr(options, name)]
    if wrong:
        raise SceneError(
            f"{command} --all takes no {', '.join(wrong)}. Remove it, or name a scene."
        )
