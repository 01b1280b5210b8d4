"""``quintet new``: a small scene, component or link to begin with, written into a new folder.

The files are the examples of the folders' texts, whose tests install and run them; names are
replaced.
"""

import keyword
import re
import shlex
from dataclasses import dataclass
from importlib.resources import files
from importlib.util import find_spec
from pathlib import Path

from quintet.coupler.coupling.links import known_links
from quintet.coupler.files.disk import reporting_disk
from quintet.coupler.scene.read import library
from quintet.interfaces.errors import SceneError
from quintet.interfaces.manifest import known_kinds
from quintet.interfaces.params import shown

FILE = re.compile(r"`([\w/]+\.(?:py|toml))`:\n\n```\w+\n(.*?)^```$", re.MULTILINE | re.DOTALL)
NAME = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*")
LONGEST = 40  # characters of a name


@dataclass(frozen=True, slots=True)
class Template:
    """Where the files of an example stand, and what is to be done with them."""

    package: str  # whose README.md has them
    name: str  # of the example, replaced by the new one
    next: tuple[str, ...]  # commands to go on with; {name}, {folder}, {scene} are filled in


INSTALL = "pip install -e {folder}"
TEMPLATES = {
    "scene": Template("quintet.scenarios", "falling_ball", ("quintet run {scene}",)),
    "component": Template(
        "quintet.interfaces",
        "mooring",
        (INSTALL, "quintet conform {name}", "quintet run {scene}", "pytest {folder}"),
    ),
    "link": Template(
        "quintet.coupler",
        "mount",
        (INSTALL, "quintet run {scene}", "pytest {folder}"),
    ),
}


def write_new(subject: str, name: str, folder: Path) -> list[Path]:
    """Write the files of a starting point into a folder that is not there yet.

    Parameters
    ----------
    subject : {"scene", "component", "link"}
    name : str
        Of the scene, or of the package and the kind.
    folder : Path
        To be made.

    Returns
    -------
    list of Path
        The files.

    Raises
    ------
    SceneError
        The name may not be used, or the folder is there.
    """
    _check_name(subject, name)
    if folder.exists():
        raise SceneError(
            f"new {subject}: the folder must not exist yet, nothing is overwritten; found "
            f"{shown(str(folder))}. Choose another name, or --out DIR."
        )
    paths = []
    for path, text in starting_point(subject, name).items():
        with reporting_disk(folder / path):
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            (folder / path).write_text(text, encoding="utf-8")
        paths.append(folder / path)
    return paths


def starting_point(subject: str, name: str) -> dict[str, str]:
    """Texts of the files of a starting point by their paths, with a new name in them."""
    template = TEMPLATES[subject]
    text = (files(template.package) / "README.md").read_text(encoding="utf-8")
    return {
        _renamed(path, template.name, name): _renamed(inside, template.name, name)
        for path, inside in FILE.findall(text)
    }


def next_commands(subject: str, name: str, folder: Path) -> list[str]:
    """Commands to go on with."""
    place = shlex.quote(str(folder))
    scene = shlex.quote(str(folder / "scene.toml"))
    return [line.format(name=name, folder=place, scene=scene) for line in TEMPLATES[subject].next]


def _renamed(text: str, old: str, new: str) -> str:
    """Replace a name where it stands for the package or its classes, not in prose."""
    not_prose = r"(?! lines?\b)"
    text = re.sub(rf"(?<![A-Za-z]){old}(?![A-Za-z]){not_prose}", new, text)
    return re.sub(rf"\b{_in_classes(old)}(?=[A-Z]|\b){not_prose}", _in_classes(new), text)


def _in_classes(name: str) -> str:
    return "".join(part.capitalize() for part in name.split("_"))


def _check_name(subject: str, name: str) -> None:
    if not NAME.fullmatch(name) or len(name) > LONGEST or keyword.iskeyword(name):
        raise SceneError(
            f"new {subject}: a name must be words of lower-case letters and digits, joined by "
            f"single _, beginning with a letter, at most {LONGEST} characters, and no keyword of "
            f"Python; found {shown(name)}. Choose another one."
        )
    taken = set(
        library()
        if subject == "scene"
        else known_kinds()
        if subject == "component"
        else known_links()
    )
    if name in taken or (subject != "scene" and find_spec(name) is not None):
        known = f"a {subject}" if name in taken else "a module of Python"
        raise SceneError(
            f"new {subject}: the name must be free; found {name}, {known} that is installed. "
            "Choose another one."
        )
