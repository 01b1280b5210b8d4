"""``[[links]]``: which components are joined, each link made by its kind."""

from collections import Counter
from collections.abc import Iterator
from typing import Any

from quintet.coupler.coupling.link import Link
from quintet.coupler.coupling.links import known_links, maker
from quintet.coupler.scene.scene import ComponentPlan
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import shown, unknown


def read_links(
    table: list[dict[str, Any]],
    components: dict[str, ComponentPlan],
    wrong: set[str],
    mistakes: list[str],
) -> list[Link]:
    """Match the links of a scene to the ports of its components.

    `wrong` are components with mistakes: of links to them nothing is said.
    """
    ports = {name: (plan.takes, plan.gives) for name, plan in components.items()}
    links: list[Link] = []
    known = known_links()
    for number, keys in enumerate(table):
        kind = str(keys.get("kind", ""))
        lists = [keys.get("between", []), keys.get("pairs", [])]
        if kind not in known:
            mistakes.append(unknown(f"links.{number}.kind {kind}", kind, known))
        elif not all(map(_is_names, lists)):
            mistakes.append(
                f"links.{number}: components and ports are names; found {shown(lists)}."
            )
        elif not wrong & set(_named(lists)):
            try:
                links.append(maker(kind)(number, keys, ports))
            except SceneError as error:
                mistakes += error.mistakes
            except Exception as error:  # of any kind: what a link does here is its author's
                cause = f"{type(error).__name__}: {error}"
                mistakes.append(
                    f"links.{number}: kind {kind} cannot be made from this table ({cause})."
                )
    for name, count in Counter(link.name for link in links).items():
        if count > 1:
            mistakes.append(f"links: {count} have the name {name}. Give each its own.")
    return links


def _is_names(value: Any) -> bool:
    """Whether there are names in a list, and in the lists in it, and nothing else."""
    return isinstance(value, str) or (isinstance(value, list) and all(map(_is_names, value)))


def _named(value: Any) -> Iterator[str]:
    """Components that stand in a link's lists, whatever else is wrong with them."""
    if isinstance(value, list):
        for entry in value:
            yield from _named(entry)
    elif isinstance(value, str):
        yield value.split(".")[0]
