"""A private import world: what `import` gives the firmware of one board, and nothing else.

The modules of the image are executed anew after each reset; `machine`, `time`, `micropython`, `gc` and `sys` are the
board's own; of the host's library only those parts that MicroPython has are let through, so that a forbidden import
fails on the bench as it does on the board.
"""

import array
import binascii
import builtins
import collections
import errno
import hashlib
import heapq
import io
import json
import math
import re
import struct
import traceback
from collections.abc import Callable, Mapping, Sequence
from types import ModuleType, SimpleNamespace
from typing import Any, NoReturn

from hil_sim.worlds.image import Image
from hil_sim.worlds.world import Interrupted

SHARED: dict[str, ModuleType] = {
    module.__name__: module
    for module in (array, binascii, collections, errno, hashlib, heapq, io, json, math, re, struct)
}


class Modules:
    """The modules of one life of the processor."""

    def __init__(
        self,
        image: Image,
        given: Mapping[str, ModuleType],
        say: Callable[[str], None],
        open_file: Callable[..., object],
    ) -> None:
        self._image = image
        self._say = say
        self.loaded: dict[str, ModuleType] = {**SHARED, **given}
        own = {"__import__": self._import, "open": open_file, "print": self._print, "KeyboardInterrupt": Interrupted}
        self._builtins = {**vars(builtins), **own}

    def run(self, path: str) -> None:
        """Execute a file as the board runs boot.py and main.py: in `__main__`. A missing one is passed over."""
        code = self._image.code(path)
        if code is None:
            return
        main = self.loaded.setdefault("__main__", self._empty("__main__"))
        exec(code, vars(main))

    def _import(
        self,
        name: str,
        globals: Mapping[str, Any] | None = None,
        locals: Mapping[str, Any] | None = None,
        fromlist: Sequence[str] | None = (),
        level: int = 0,
    ) -> ModuleType:
        if level:
            raise ImportError("relative import: the firmware imports absolutely")
        parts = name.split(".")
        for depth in range(1, len(parts) + 1):
            module = self._module(".".join(parts[:depth]))
        if not fromlist:
            return self.loaded[parts[0]]
        for wanted in fromlist:
            if wanted != "*" and not hasattr(module, wanted) and hasattr(module, "__path__"):
                self._module(f"{name}.{wanted}")
        return module

    def _module(self, name: str) -> ModuleType:
        if name in self.loaded:
            return self.loaded[name]
        module = self._empty(name)
        parent, _, child = name.rpartition(".")
        within = getattr(self.loaded[parent], "__path__", ()) if parent else self.loaded["sys"].path
        for folder in within:
            path = f"{folder}/{child}" if folder else child
            code = self._image.code(path + ".py")
            if self._image.has_folder(path):
                module.__path__ = [path]
                code = self._image.code(path + "/__init__.py")
            elif code is None:
                continue
            break
        else:
            raise ImportError(f"no module named '{name}'")
        self._execute(module, code)
        if parent:
            setattr(self.loaded[parent], child, module)
        return module

    def _execute(self, module: ModuleType, code: Any) -> None:
        self.loaded[module.__name__] = module
        if code is None:
            return
        try:
            exec(code, vars(module))
        except BaseException:
            del self.loaded[module.__name__]
            raise

    def _empty(self, name: str) -> ModuleType:
        module = ModuleType(name)
        vars(module)["__builtins__"] = self._builtins
        return module

    def _print(self, *values: object, sep: str = " ", end: str = "\n", file: Any = None) -> None:
        text = sep.join(map(str, values)) + end
        if file is None:
            self._say(text)
        else:
            file.write(text)


def micropython_module(heed: Callable[[int], None] = lambda character: None) -> ModuleType:
    """Return `micropython`: declarations without effect, because the heap is not the board's; and `kbd_intr`."""
    return _module_of(
        "micropython",
        const=lambda value: value,
        native=lambda function: function,
        viper=lambda function: function,
        alloc_emergency_exception_buf=lambda size: None,
        heap_lock=lambda: 0,
        heap_unlock=lambda: 0,
        kbd_intr=heed,
        opt_level=lambda level=0: 0,
    )


def gc_module() -> ModuleType:
    """Return `gc` without effect: the host's collector must not depend on the firmware."""
    return _module_of(
        "gc",
        enable=lambda: None,
        disable=lambda: None,
        collect=lambda: 0,
        threshold=lambda amount=-1: -1,
        mem_alloc=lambda: 32_768,
        mem_free=lambda: 200_000,
    )


def sys_module(say: Callable[[str], None]) -> ModuleType:
    """Return the part of `sys` that firmware uses."""

    def print_exception(error: BaseException, file: Any = None) -> None:
        text = "".join(traceback.format_exception(error))
        say(text) if file is None else file.write(text)

    def leave(code: int = 0) -> NoReturn:
        raise SystemExit(code)

    return _module_of(
        "sys",
        path=["", ".frozen", "/lib"],
        implementation=SimpleNamespace(name="micropython", version=(1, 29, 0)),
        platform="rp2",
        byteorder="little",
        maxsize=0x7FFFFFFF,
        print_exception=print_exception,
        exit=leave,
    )


def _module_of(name: str, **members: object) -> ModuleType:
    module = ModuleType(name)
    vars(module).update(members)
    return module
