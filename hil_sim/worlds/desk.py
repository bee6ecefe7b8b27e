"""The bench's end of the line to a MicroPython process: serves its accesses on the peripherals that world T1 uses, too.

A request is eight bytes (operation, object, ticks, length, argument) and its data; see shim/bench.py, the other end.
Each tick that the process has read since its last request costs its time first, one by one, as it does in T1: so
both worlds spend the same time in the same pieces, and everything that is due in between happens in the same order.

    desk = Desk(processor, say=print)
    answer = desk.serve(request, data)  # None: the request was posted
"""

import json
from collections.abc import Callable
from struct import Struct
from types import ModuleType
from typing import Any

from hil_sim.worlds.costs import PIN_US, TICKS_US, WATCHDOG_US
from hil_sim.worlds.files import Files
from hil_sim.worlds.lines import I2C, UART
from hil_sim.worlds.machine import WDT, machine_module, time_module
from hil_sim.worlds.pins import ADC, Pin
from hil_sim.worlds.processor import Processor
from hil_sim.worlds.pulses import PWM
from hil_sim.worlds.spi import SPI
from hil_sim.worlds.world import Crashed, Interrupted

PIN_SET, PIN_GET, I2C_WRITE, I2C_READ, UART_READ, UART_WRITE, CONVERT = range(7)
FEED, SLEEP, TIME, CALL, CRASH, READ, EXCHANGE, PULSE = range(7, 15)
POSTED = (PIN_SET, FEED, SLEEP)  # they have no answer, unless they carry data
WITHOUT_DATA = (I2C_READ, UART_READ)  # their length is how many bytes are wanted
DONE, OS_ERROR, OTHER_ERROR, INTERRUPTED = range(4)
FILLED = {"readinto": 0, "readfrom_into": 1, "readfrom_mem_into": 2, "write_readinto": 1}  # which argument is filled
Request = tuple[int, int, int, int, int]  # operation, object, ticks, length, argument
HEAD = Struct("<BBHHH")
_ANSWER = Struct("<IIII")
_LOW = (1 << 30) - 1
_PIECE = Struct("<II")  # of a file: where it begins, how long it is
_OBJECTS_MAX = 256


class Desk:
    """The objects of one life of the processor, by the numbers under which its process knows them."""

    def __init__(self, processor: Processor, say: Callable[[str], None]) -> None:
        self.say = say
        self._interrupted = False
        self._processor = processor
        self._machine = machine_module(processor)
        self._sleep_us: Callable[[int], None] = time_module(processor).sleep_us
        self._objects: list[Any] = [self._machine, Files(processor), self]
        self._acts = (
            self._pin_set, self._pin_get, self._i2c_write, self._i2c_read, self._uart_read, self._uart_write,
            self._convert, self._feed, self._sleep, self._time, self._call, self._crash, self._read, self._exchange,
            self._pulse,
        )  # fmt: skip

    def serve(self, head: Request, data: bytes) -> bytes | None:
        """Serve one request; return the answer, or None when it needs none."""
        op, which, ticks, length, argument = head
        value, extra, status = 0, b"", INTERRUPTED
        try:
            if not self._interrupted:
                for _ in range(ticks):
                    self._processor.spend(TICKS_US)
                value, extra = self._acts[op](self._objects[which], length, argument, data)
                status = DONE
        except Interrupted:
            pass
        except OSError as error:
            value, status = int(error.args[0]), OS_ERROR
        except (ValueError, TypeError, AttributeError, RuntimeError) as error:
            extra, status = json.dumps([type(error).__name__, str(error)]).encode(), OTHER_ERROR
            value = len(extra)
        posted = op in POSTED and not data
        self._interrupted = posted and status == INTERRUPTED  # felt with the next request that is answered
        if posted:
            return None
        now_us = self._processor.ticks_us()
        return _ANSWER.pack(now_us & _LOW, now_us >> 30, status, value) + extra

    def contents(self) -> list[Any]:
        """Return what the module `machine` has: its classes with their constants, its values, its functions."""
        members = {name: member for name, member in vars(self._machine).items() if not name.startswith("_")}
        classes = {name: _constants(member) for name, member in members.items() if isinstance(member, type)}
        values = {name: member for name, member in members.items() if isinstance(member, int)}
        functions = [name for name in members if name not in classes and name not in values]
        return [classes, values, functions]

    def costs_us(self) -> list[int]:
        """Return what setting a pin and feeding the watchdog cost, which are not asked for their time."""
        return [PIN_US, WATCHDOG_US]

    def heed(self, character: int) -> None:
        """Let that character of the console raise KeyboardInterrupt; -1: none does."""
        self._processor.heed(character)

    def paths(self) -> list[str]:
        """Return the paths of all files on the flash."""
        return self._processor.board.flash.paths()

    def size(self, path: str) -> int:
        """Return the size of a file of the flash: to import it, or to open it for reading, costs no time."""
        return len(self._processor.board.flash.read(path))

    def _pin_set(self, pin: Pin, length: int, level: int, data: bytes) -> tuple[int, bytes]:
        pin.value(level)
        return 0, b""

    def _pin_get(self, pin: Pin, length: int, argument: int, data: bytes) -> tuple[int, bytes]:
        return pin.value() or 0, b""

    def _i2c_write(self, bus: I2C, length: int, place: int, data: bytes) -> tuple[int, bytes]:
        bus.writeto_mem(place >> 8, place & 0xFF, data)
        return 0, b""

    def _i2c_read(self, bus: I2C, length: int, place: int, data: bytes) -> tuple[int, bytes]:
        return 0, bus.readfrom_mem(place >> 8, place & 0xFF, length)

    def _uart_read(self, port: UART, length: int, argument: int, data: bytes) -> tuple[int, bytes]:
        got = port.read(length) or b""
        return len(got), got

    def _uart_write(self, port: UART, length: int, argument: int, data: bytes) -> tuple[int, bytes]:
        return port.write(data) or 0, b""

    def _convert(self, adc: ADC, length: int, argument: int, data: bytes) -> tuple[int, bytes]:
        return adc.read_u16(), b""

    def _feed(self, watchdog: WDT, length: int, argument: int, data: bytes) -> tuple[int, bytes]:
        watchdog.feed()
        return 0, b""

    def _sleep(self, module: ModuleType, length: int, argument: int, data: bytes) -> tuple[int, bytes]:
        self._sleep_us(int.from_bytes(data, "little") if data else argument)
        return 0, b""

    def _time(self, module: ModuleType, length: int, argument: int, data: bytes) -> tuple[int, bytes]:
        return 0, b""

    def _call(self, module: ModuleType, length: int, argument: int, data: bytes) -> tuple[int, bytes]:
        which, name, args, options = json.loads(data)
        args = [self._lively(value) for value in args]
        options = {key: self._lively(value) for key, value in options.items()}
        result = getattr(self._objects[which], name)(*args, **options)
        if name in FILLED:
            result = args[FILLED[name]]
        if name == "close":
            self._objects[which] = None
        said = json.dumps(self._plain(result)).encode()
        return len(said), said

    def _crash(self, module: ModuleType, length: int, argument: int, data: bytes) -> tuple[int, bytes]:
        error, _, trace = data.decode(errors="replace").partition("\n")
        raise Crashed(error, trace)

    def _read(self, module: ModuleType, length: int, argument: int, data: bytes) -> tuple[int, bytes]:
        at, count = _PIECE.unpack_from(data)
        return 0, self._processor.board.flash.read(data[_PIECE.size :].decode())[at : at + count]

    def _exchange(self, bus: SPI, length: int, argument: int, data: bytes) -> tuple[int, bytes]:
        return 0, bus.transfer(data)

    def _pulse(self, pwm: PWM, length: int, argument: int, data: bytes) -> tuple[int, bytes]:
        pwm.duty_ns(int.from_bytes(data, "little"))
        return 0, b""

    def _lively(self, value: Any) -> Any:
        """Return what JSON carried as the firmware meant it."""
        if isinstance(value, dict):
            return self._objects[value["object"]] if "object" in value else bytearray.fromhex(value["bytes"])
        return value

    def _plain(self, value: Any) -> Any:
        """Return a result as JSON can carry it; an object under its number."""
        if isinstance(value, bytes | bytearray):
            return {"bytes": value.hex()}
        if value is None or isinstance(value, bool | int | float | str | list | tuple):
            return value
        number = next((n for n, known in enumerate(self._objects) if known is value), None)
        return {"object": self._numbered(value) if number is None else number}

    def _numbered(self, value: Any) -> int:
        """Give an object a number that is free."""
        free = next((number for number, known in enumerate(self._objects) if known is None), len(self._objects))
        if free == _OBJECTS_MAX:
            raise RuntimeError(f"more than {_OBJECTS_MAX} objects of the bench at a time")
        self._objects[free : free + 1] = [value]
        return free


def _constants(kind: type) -> dict[str, int]:
    names = [name for name in dir(kind) if name.isupper() and not name.startswith("_")]
    return {name: getattr(kind, name) for name in names}
