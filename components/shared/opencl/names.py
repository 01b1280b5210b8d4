"""Names in OpenCL C: letters of other alphabets are spelled out, reserved words get a tail."""

import unicodedata
from typing import Any

RESERVED = frozenset(
    """auto break case char const constant continue default do double else enum extern event_t float
    for generic global goto half if image1d_t inline int kernel local long pipe private real
    register restrict return sampler_t short signed size_t sizeof static struct switch typedef
    uchar uint ulong union unsigned ushort void volatile while bool true false none
    sqrt exp exp2 log log2 log10 log1p expm1 pow sin cos tan asin acos atan atan2 sinh cosh tanh
    fabs floor ceil rint fmin fmax hypot copysign cbrt fmod trunc isnan isinf isfinite erf
    min max abs dot cross distance length normalize sign step mix clamp radians degrees""".split()
)


def identifier(name: str) -> str:
    """Spell a name of Python for C."""
    text = "".join(letter if letter.isascii() else _spelled(letter) for letter in name)
    return f"{text}_" if text in RESERVED else text


def function_name(function: Any) -> str:
    """Name of a function in C: that of its module's file stands first."""
    module = str(function.__module__).rpartition(".")[2]
    return identifier(f"{module}_{function.__name__}".replace("<", "").replace(">", ""))


def _spelled(letter: str) -> str:
    return unicodedata.name(letter).split()[-1].lower()
