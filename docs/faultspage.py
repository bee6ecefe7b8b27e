"""The tables of docs/faults.md: every fault by name, and what is promised for each."""

from collections.abc import Callable, Iterable, Sequence

from hil_sim.faults.table import TABLE
from tests import fault_table

Table = Callable[[Sequence[str], Iterable[tuple[str, ...]]], str]
PROMISE = ("fault", "while", "code", "off [ms]", "ends as", "exit", "way back", "because")


def fields(table: Table) -> dict[str, str]:
    """Return what the template of the page leaves open."""
    names = [(f"`{fault.spelled}`", fault.about, "lasts" if fault.ends else "") for fault in TABLE]
    situations = "\n".join(
        f"* *{name}*: {'; '.join(f'`{line}`' for line in script.splitlines())}"
        for name, (script, _) in fault_table.ORDERS.items()
    )
    return {
        "example": fault_table.EXAMPLE,
        "names": table(("name", "what happens", ""), names),
        "promises": table(PROMISE, [promise(row) for row in fault_table.ROWS]),
        "situations": situations.format(one="A", two="A B") + "\n",
    }


def promise(row: fault_table.Row) -> tuple[str, ...]:
    """Return one promise as a row of a table."""
    where = row.during if row.robot == "circular" else f"{row.during}, {row.robot}"
    off = "-" if row.off_ms is None else str(row.off_ms)
    status = " or ".join(map(str, row.exit_codes))
    return f"`{row.fault}`", where, row.code or "-", off, row.ending, status, row.recovers, row.why
