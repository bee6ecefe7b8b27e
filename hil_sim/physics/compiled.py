"""Compiles the numerical kernels once, keeps them on disk, and says so when that takes a while.

Every kernel carries `@kernel` or `@lean`. The compiler's own cache looks only at the file a function stands in, so a
change in one file would leave stale code in its callers: `prepare` drops the whole cache of a kernel's folder when any
source there, or in this folder, which all others build on, is newer than it.
"""

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar, cast

import numpy as np
from numba import njit, typeof
from numpy.typing import NDArray

Array = NDArray[np.float64]
Kernel = TypeVar("Kernel", bound=Callable[..., Any])


REORDERED = {"contract", "reassoc", "nsz", "arcp"}


def kernel(function: Kernel) -> Kernel:
    """Return `function` compiled on its first call; sums may be re-ordered, infinities and NaN stay honest."""
    return cast(Kernel, njit(cache=True, fastmath=REORDERED, error_model="numpy")(function))


def lean(function: Kernel) -> Kernel:
    """Return a kernel that makes no array: spared the counting of references, which costs a third of a ring's time."""
    bare: dict[str, Any] = {"_nrt": False}  # numba's own name for it
    return cast(Kernel, njit(cache=True, fastmath=REORDERED, error_model="numpy", **bare)(function))


def prepare(entry: Any, *others: Any) -> bool:
    """Drop stale machine code and return whether `entry`, the outermost kernel, must be compiled now.

    The others are kernels of the other folders whose code it uses. Prints one line on stderr when it must: the first
    run is a minute slower than the next.
    """
    if entry.signatures:
        return False
    sources = {Path(__file__).parent, *(Path(each.py_func.__code__.co_filename).parent for each in (entry, *others))}
    newest = max(_written_s(source) for folder in sources for source in folder.glob("*.py"))
    folders = [Path(each.stats.cache_path) for each in (entry, *others)]
    indexes = [index for folder in folders for index in folder.glob("*.nbi")]
    fresh = [index for index in indexes if _written_s(index) >= newest]
    if len(fresh) < len(indexes):
        for index in indexes:
            index.unlink(missing_ok=True)
        fresh = []
    stem = Path(entry.py_func.__code__.co_filename).stem
    cold = not any(index.parent == folders[0] and index.name.startswith(stem) for index in fresh)
    if cold:
        print("softrig: compiling the physics kernels, once (a minute or less) ...", file=sys.stderr, flush=True)
    return cold


def _written_s(path: Path) -> float:
    """Return when a file was written; 0 when it has gone, as another process drops stale code too."""
    try:
        return path.stat().st_mtime
    except FileNotFoundError:
        return 0.0


def bound(entry: Any, *arguments: Any) -> Callable[..., Any]:
    """Return the machine code of `entry` for arguments of exactly these types, after one call with them.

    It does not look at the types again, which for many arrays takes longer than the work: the caller must keep them.
    """
    entry(*arguments)
    types = tuple(typeof(argument) for argument in arguments)  # type: ignore[no-untyped-call]
    code: Callable[..., Any] = entry.overloads[types].entry_point
    return code
