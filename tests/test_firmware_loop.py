"""What keeps the super-loop honest: the watchdog's reports and the collecting of garbage."""

import pytest

from firmware import heap
from firmware.tasks import CONTROL, RECEIVE, SEND, Tasks
from hil_sim.address import parse
from hil_sim.assembly import assemble
from host.errors import SoftrigError
from tests.firmware_bench import Rig
from tests.hil_rig import HilRig
from tests.sabotage import sabotage


@pytest.fixture
def collected(monkeypatch):
    """Return what the heap did, in place of the interpreter's own collector."""
    done = []

    class Collector:
        collect = staticmethod(lambda: done.append("collect"))
        threshold = staticmethod(lambda size: done.append(f"threshold {size}"))

    monkeypatch.setattr(heap, "gc", Collector)
    return done


@pytest.mark.parametrize("silent", [RECEIVE, CONTROL, SEND])
def test_the_watchdog_starves_while_one_task_is_silent(silent):
    tasks = Tasks()

    for _ in range(10):
        for task in (RECEIVE, CONTROL, SEND):
            if task != silent:
                tasks.report(task)
        assert not tasks.complete()

    tasks.report(silent)
    assert tasks.complete()


def test_each_period_needs_its_own_reports():
    tasks = Tasks()
    tasks.report(RECEIVE | CONTROL | SEND)

    assert tasks.complete()
    assert not tasks.complete()


def test_a_step_of_the_core_reports_for_receiving_and_control_and_leaves_sending_to_the_loop():
    rig = Rig()
    rig.run(5)

    assert not rig.core.tasks.complete()
    rig.core.tasks.report(SEND)
    assert rig.core.tasks.complete()


@pytest.mark.parametrize(("file", "task"), [("core.py", "RECEIVE"), ("core.py", "CONTROL"), ("main.py", "SEND")])
def test_a_loop_that_goes_round_without_a_task_is_restarted(monkeypatch, file, task):
    sabotage(monkeypatch, file, f"tasks.report({task})", "tasks.report(0)")
    bench = assemble(parse("sim:circular?body=still"))

    bench.run(1)
    bench.close()

    assert bench.crashes == []
    assert bench.world.resets > 0


def test_an_error_opens_the_supply_and_does_not_wait_for_the_monostable(monkeypatch):
    sabotage(monkeypatch, "core.py", "self.reports.tell()", "1 // (not self.channels.on_mask)")
    rig = HilRig("sim:circular?body=still")
    rig.robot.arm()

    with pytest.raises(SoftrigError):
        rig.robot.fire(["A"], 500, 1000)

    (_, _), (on_us, _), (off_us, duty) = rig.bench.coil("A").history[-3:]
    assert duty == 0.0
    assert off_us - on_us < 5_000
    assert "ZeroDivisionError" in rig.bench.crashes[0].error
    rig.link.close()


def test_a_loop_that_does_all_is_never_restarted():
    bench = assemble(parse("sim:circular?body=still"))

    bench.run(3)
    bench.close()

    assert bench.world.resets == 0


def test_the_interpreter_collects_by_itself_only_before_an_allocation_that_would_fail(collected):
    heap.Heap()

    assert collected == ["collect", "threshold -1"]


def test_garbage_is_collected_where_a_step_has_time_left(collected):
    kept = heap.Heap()
    collected.clear()

    ran = [kept.collect(4) for _ in range(24)]

    assert [i for i, did in enumerate(ran) if did] == [7, 15, 23]
    assert collected == ["collect"] * 3


def test_garbage_waits_for_a_step_with_time_but_not_for_ever(collected):
    kept = heap.Heap()

    ran = [kept.collect(1) for _ in range(20)]
    assert not any(ran)
    assert kept.collect(3)
    assert [kept.collect(1) for _ in range(32)].index(True) == 31
