"""Materials by name, as tables of a scene, each with its source."""

from typing import Any

Table = dict[str, Any]

LIBRARY: dict[str, Table] = {
    # Dyanov, Kazantsev, Chelakov (LOGOS), tables 2 and 3; constants of Howell & Ball (2002).
    "steel": {
        "density": 7850.0,
        "shear_modulus": 81.8e9,
        "johnson_cook": {
            "a": 350e6, "b": 275e6, "n": 0.36, "c": 0.022, "m": 1.0, "melting_temperature": 1811.0,
        },
        "mie_gruneisen": {"sound_speed": 4596.0, "s1": 1.49, "gamma": 2.17},
        "spall_stress": 2.25e9,
        "specific_heat": 452.0,
    },
    # The same paper, tables 4 and 5.
    "aluminium": {
        "density": 2780.0,
        "shear_modulus": 27.6e9,
        "johnson_cook": {
            "a": 330e6, "b": 426e6, "n": 0.34, "c": 0.015, "m": 1.0, "melting_temperature": 910.0,
        },
        "mie_gruneisen": {"sound_speed": 5328.0, "s1": 1.338, "gamma": 2.0},
        "spall_stress": 1.1e9,
        "specific_heat": 875.0,
    },
    # Taylor's bar of Kamoulakos (1990) and Zhu & Cescotto (1995): linear hardening.
    "copper": {
        "density": 8930.0,
        "youngs_modulus": 117e9,
        "poissons_ratio": 0.35,
        "johnson_cook": {"a": 400e6, "b": 100e6, "n": 1.0},
        "specific_heat": 385.0,
    },
    # Pantalé, DynELA, samples of impacts: at 20 °C, melting at 1540 °C.
    "42CrMo4": {
        "density": 7830.0,
        "youngs_modulus": 206.9e9,
        "poissons_ratio": 0.3,
        "johnson_cook": {
            "a": 806e6, "b": 614e6, "n": 0.168, "c": 0.0089, "m": 1.1,
            "reference_temperature": 293.15, "melting_temperature": 1813.15,
        },
        "specific_heat": 460.0,
        "taylor_quinney": 0.9,
        "temperature": 293.15,
    },
}  # fmt: skip
