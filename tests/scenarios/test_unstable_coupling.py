"""A light body in long windows: the run warns of an unstable coupling, and its advice works."""

import re
from pathlib import Path
from typing import Any

import pytest

import quintet
from quintet.coupler.cli import main

ITERATED = {"scheme": "iterated", "iteration.tolerance": 1e-3, "iteration.at_limit": "continue"}
SERIAL = {"scheme": "serial"}
Settings = dict[str, Any]


def square(density: float, window: float, scheme: Settings, end: float = 0.15) -> Settings:
    """Settings of a square whose weight equals its buoyancy at release, five spacings across."""
    return {
        "end": end,
        "window": window,
        "components.water.spacing": 0.03,
        "components.square.bodies.0.density": density,
        "components.square.gravity": [0.0, 0.0, -9.81 * 600.0 / density],
        **scheme,
    }


def stability_warning(folder: Path, settings: Settings) -> str:
    """Run; return the warning of an unstable coupling, or "" if it is stable."""
    run = quintet.run("floating_square", preset="quick", settings=settings, out=folder)
    texts = [
        warning["text"] for warning in run.results["warnings"] if warning["subject"] == "stability"
    ]
    assert str(run).count("Warning of link water-square: its coupling is unstable") == len(texts)
    return str(texts[0]) if texts else ""


def advised(settings: Settings, text: str) -> Settings:
    """The settings, changed as a warning advises."""
    repeated, shorter = (
        'set scheme = "iterated"' in text,
        re.search(r"shorten window from \S+ s to (\S+) s[.;]", text),
    )
    assert repeated or shorter
    window = {"window": float(shorter[1])} if shorter else {}
    return settings | window | (ITERATED if repeated else {})


@pytest.mark.parametrize(
    ("density", "scheme"),
    [
        (200.0, SERIAL),
        (50.0, ITERATED),
        pytest.param(50.0, SERIAL, marks=pytest.mark.slow),
        pytest.param(20.0, SERIAL, marks=pytest.mark.full),
    ],
)
def test_a_light_body_in_long_windows_is_told_and_stable_as_advised(
    tmp_path: Path, density: float, scheme: Settings
) -> None:
    settings = square(density, 5e-3, scheme)
    text = stability_warning(tmp_path / "long", settings)
    assert text.startswith("its coupling is unstable: by t = 0.")
    assert stability_warning(tmp_path / "advised", advised(settings, text)) == ""


def test_half_the_step_of_the_water_alone_holds_a_body_that_is_not_very_light(
    tmp_path: Path,
) -> None:
    """Shorter windows take less time than repeated ones, so they are advised first."""
    settings = square(200.0, 5e-3, SERIAL)
    text = stability_warning(tmp_path / "long", settings)
    assert re.search(
        r"the work that went through it; shorten window from 0.005 s to \S+ s; if that is not "
        r"enough, as for what is far lighter than the fluid, also set scheme = \"iterated\", which "
        r"takes longer\.$",
        text,
    )
    shortened = advised(settings, text) | SERIAL
    assert shortened["window"] < 2e-3  # s
    assert stability_warning(tmp_path / "advised", shortened) == ""


def test_a_doubtful_run_does_not_end_as_one_that_met_all(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    settings = square(50.0, 5e-3, ITERATED) | {"expect": []}
    words = [word for key, value in settings.items() for word in ("--set", f"{key}={value}")]
    with pytest.raises(SystemExit) as ended:
        main(
            ["run", "floating_square", "--preset", "quick", *words, "--out", str(tmp_path / "run")]
        )
    assert ended.value.code == 1
    captured = capsys.readouterr()
    assert (
        "quintet: warning of link water-square: its coupling is unstable: by t = 0." in captured.err
    )
    assert "Warning of link water-square: its coupling is unstable" in " ".join(
        captured.out.split()
    )


STABLE = [
    (800.0, 3e-4, SERIAL),
    (800.0, 1.2e-3, SERIAL),
    (800.0, 5e-3, SERIAL),
    (200.0, 3e-4, SERIAL),
    (200.0, 1.2e-3, SERIAL),
    (50.0, 3e-4, SERIAL),
    (800.0, 2e-2, ITERATED),
    (200.0, 1e-2, ITERATED),
    (50.0, 2.4e-3, ITERATED),
    (10.0, 3e-4, ITERATED),
    (3000.0, 2e-3, SERIAL),  # it sinks, and strikes the floor
]
UNSTABLE = [
    (800.0, 2e-2, SERIAL),
    (200.0, 5e-3, SERIAL),
    (200.0, 2e-2, SERIAL),
    (100.0, 2.4e-3, SERIAL),
    (50.0, 6e-4, SERIAL),
    (50.0, 1.2e-3, SERIAL),
    (50.0, 2e-2, SERIAL),
    (20.0, 6e-4, SERIAL),
    (50.0, 5e-3, ITERATED),
    (50.0, 1e-2, ITERATED),
]


@pytest.mark.full
@pytest.mark.parametrize(("density", "window", "scheme"), STABLE)
def test_a_stable_run_is_not_told(
    tmp_path: Path, density: float, window: float, scheme: Settings
) -> None:
    assert stability_warning(tmp_path, square(density, window, scheme, 0.4)) == ""


@pytest.mark.full
@pytest.mark.parametrize(("density", "window", "scheme"), UNSTABLE)
def test_every_unstable_run_is_told_and_stable_as_advised(
    tmp_path: Path, density: float, window: float, scheme: Settings
) -> None:
    settings = square(density, window, scheme, 0.4)
    text = stability_warning(tmp_path / "long", settings)
    assert text
    assert stability_warning(tmp_path / "advised", advised(settings, text)) == ""
