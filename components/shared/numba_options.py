"""Options under which kernels are compiled, one set for each need.

All are cached on disk and release Python's lock; division by zero gives ∞, as numpy has it.
"""

from quintet.components.shared import compilation

compilation.announce()

# As written: for loops that must notice numbers that are not finite, whose sums must keep their
# order, or that compute each row by itself. Such a loop is made of vectors, and of single rows at
# its end, which `FAST` may round otherwise: bits would depend on where a row stands. The option is
# stated because numba otherwise takes that of the first caller, and a function's bits
# would depend on what was compiled before it.
EXACT = {"error_model": "numpy", "cache": True, "nogil": True, "fastmath": False}
# Sums may be reordered into vectors, and every number is taken to be finite.
FAST = EXACT | {"fastmath": True}
# Of functions that only other kernels call: without the code for calls from Python and C.
INNER = EXACT | {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
FAST_INNER = INNER | {"fastmath": True}
# Of laws that loops over lanes call: always part of the loop, so that vectors are made of it.
LANEWISE = INNER | {"forceinline": True}
FAST_LANEWISE = LANEWISE | {"fastmath": True}
