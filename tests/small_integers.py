"""Integers as a small board has them: without taking memory they end at 2**30."""


class Small(int):
    """An integer that stays small through a calculation, or complains."""

    largest = 0

    def __new__(cls, value):
        assert -(1 << 30) <= value < 1 << 30, value
        cls.largest = max(cls.largest, abs(value))
        return super().__new__(cls, value)


def _kept(name):
    def operate(self, other=0):
        return Small(getattr(int, name)(int(self), int(other)) if name != "__neg__" else -int(self))

    return operate


for _name in ("add", "radd", "sub", "rsub", "mul", "rmul", "rshift", "lshift", "floordiv", "neg"):
    setattr(Small, f"__{_name}__", _kept(f"__{_name}__"))
