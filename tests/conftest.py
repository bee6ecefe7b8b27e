"""Fixtures of all tests."""

import json
import weakref
from types import SimpleNamespace

import pytest
from hypothesis import settings

from hil_sim.bench import Bench
from hil_sim.physics import circuit, coil
from hil_sim.physics.compiled import prepare
from host.cli import main
from tests.hil_rig import HilRig
from tests.witness import Witness

settings.register_profile("softrig", derandomize=True, deadline=None)  # the same examples on every machine
settings.load_profile("softrig")


@pytest.fixture(scope="session", autouse=True)
def fresh_kernels():
    """Machine code of older sources is dropped before any test calls a kernel by itself."""
    prepare(coil.advance)
    prepare(circuit.solve)


@pytest.fixture(scope="session", autouse=True)
def caches(tmp_path_factory):
    """No test reads or writes the caches of whoever runs it."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.mktemp("cache")))
        yield


@pytest.fixture(scope="session", autouse=True)
def witnesses():
    """A witness of every bench from its first moment on; the list holds those that nobody has asked yet."""
    fresh, build = [], Bench.__init__

    def witnessed(bench, *parts, **options):
        build(bench, *parts, **options)
        bench.witness = Witness(bench)
        fresh.append(bench.witness)

    Bench.__init__ = witnessed
    yield fresh
    Bench.__init__ = build


@pytest.fixture(scope="session")
def older():
    """Benches that outlive the test that made them."""
    return weakref.WeakSet()


@pytest.fixture(autouse=True)
def invariants(witnesses, older):
    """Whatever a test is about: no coil was on without an order, for too long or too hot (invariants.py)."""
    yield
    ours = [*witnesses, *(bench.witness for bench in older)]
    told = [text for witness in ours if witness.asked_us != witness.bench.clock.now_us for text in witness.broken()]
    older.update(witness.bench for witness in witnesses)
    witnesses.clear()
    assert not told, "\n".join(told)


@pytest.fixture
def rig():
    """A circular robot on the bench, connected and idle."""
    rig = HilRig()
    yield rig
    rig.link.close()


@pytest.fixture
def faulty(tmp_path):
    """Robots to which planned faults happen: faulty(("line-flip:5", 1000, 500), ("hang", 2000)), times in ms."""
    rigs = []

    def built(*faults, robot="sim:circular", seed=1):
        keys = ("name", "at_ms", "for_ms")
        tables = [
            "".join(f"{key} = {json.dumps(value)}\n" for key, value in zip(keys, fault, strict=False))
            for fault in faults
        ]
        path = tmp_path / f"faults{len(rigs)}.toml"
        path.write_text(f"seed = {seed}\n" + "".join(f"[[fault]]\n{table}" for table in tables))
        rigs.append(HilRig(f"{robot}{'&' if '?' in robot else '?'}faults={path}"))
        return rigs[-1]

    yield built
    for rig in rigs:
        rig.link.close()


@pytest.fixture
def softrig(capsys):
    """Run a command line: (exit status, stdout, stderr)."""

    def call(*arguments: str) -> SimpleNamespace:
        with pytest.raises(SystemExit) as ended:
            main(list(arguments))
        printed = capsys.readouterr()
        return SimpleNamespace(status=ended.value.code, out=printed.out, err=printed.err)

    return call
