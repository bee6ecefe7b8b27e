"""Compile the inner loops of the physics once per machine.

A kernel takes and changes arrays in place, allocates nothing and may call other kernels. The first call compiles it
and keeps the result beside the source, so that later processes only load it:

    @kernel
    def advance(state, dt, P, L, coils): ...
"""

from collections.abc import Callable
from typing import TypeAlias, TypeVar, cast

import numba
import numpy as np
from numpy.typing import NDArray

FloatArray: TypeAlias = NDArray[np.float64]
_Function = TypeVar("_Function", bound=Callable[..., object])


def kernel(function: _Function) -> _Function:
    """Return `function` compiled at its first call, cached, with plain (repeatable) arithmetic."""
    return cast(_Function, numba.njit(cache=True, error_model="numpy")(function))
