"""Runs of a scene as a whole and in two stages, for tests of begin_from."""

import h5py
import numpy as np
import pytest

from quintet.coupler.cli import main


def status(*arguments):
    """Exit status of a command."""
    with pytest.raises(SystemExit) as exit_info:
        main([str(argument) for argument in arguments])
    return exit_info.value.code


def run(scene, out, *settings, transport="memory", preset=None):
    """Run a scene with settings; return its folder."""
    arguments = [argument for setting in settings for argument in ("--set", setting)]
    preset_arguments = ["--preset", preset] if preset else []
    assert status(
        "run", scene, *preset_arguments, "--transport", transport, "--out", out, *arguments
    ) in (0, 1)
    return out


def rows(folder):
    """All recorded fields of a run, by their places in its recording."""
    with h5py.File(folder / "recording.h5") as file:
        return {
            f"{name}/{key}": array[()]
            for name, component in file["components"].items()
            for key, array in component["fields"].items()
        }


def is_the_end_of(continued, whole):
    """Whether the fields of a run have the bits of the last rows of another."""
    ends = {
        key: array[len(array) - len(rows(continued)[key]) :] for key, array in rows(whole).items()
    }
    assert ends.keys() == rows(continued).keys() and ends
    return all(np.array_equal(ends[key], array) for key, array in rows(continued).items())


def two_stages(scene, folder, half, *settings, transport="memory", preset=None):
    """Run a scene once as a whole, and once in two stages; return whole and second stage."""
    ends = (f"end={2 * half}", f"output.states=[{half}]")
    whole = run(scene, folder / "whole", *settings, *ends, preset=preset)
    keep = ("output.states=[1e9]", f"end={half}")
    run(scene, folder / "first", *settings, *keep, transport=transport, preset=preset)
    begin = (f"end={half}", f'begin_from="{folder / "first"}"')
    continued = run(scene, folder / "again", *settings, *begin, transport=transport, preset=preset)
    return whole, continued
