"""The journal: the same entries give the same hash, any other give another."""

from hil_sim.journal import PIN, UART_SENT, Journal


def filled(*entries, keep=False):
    journal = Journal(keep)
    for entry in entries:
        journal.note(*entry)
    return journal


def test_equal_entries_give_equal_hashes_wherever_their_values_come_from():
    one = filled((2**40, UART_SENT, 0, b"ab"))
    other = filled((2 ** int("40"), UART_SENT, 0, bytes([97, 98])))

    assert one.trace_sha256() == other.trace_sha256()


def test_every_field_counts():
    entry = (1, PIN, 3, b"\x01")
    others = [(2, PIN, 3, b"\x01"), (1, UART_SENT, 3, b"\x01"), (1, PIN, 4, b"\x01"), (1, PIN, 3, b"")]

    assert len({filled(one).trace_sha256() for one in (entry, *others)}) == 5


def test_asking_for_the_hash_does_not_change_it():
    entries = [(n, PIN, 3, bytes([n % 256])) for n in range(10_000)]
    asked, silent = Journal(), filled(*entries)
    for entry in entries:
        asked.note(*entry)
        if entry[0] % 1000 == 0:
            asked.trace_sha256()

    assert asked.trace_sha256() == silent.trace_sha256()


def test_a_journal_that_keeps_gives_its_entries_back_in_order():
    entries = [(n, PIN, 3, b"") for n in range(5000)]

    assert filled(*entries, keep=True).kept() == entries
    assert filled(*entries).kept() == []
