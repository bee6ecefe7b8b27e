"""`softrig deploy` against the real MicroPython interpreter behind a pseudo-terminal, and what then runs."""

import json
import shutil

import pytest
from click.testing import CliRunner

from hil_sim.bench import Bench, Parts
from hil_sim.worlds import micropython
from hil_sim.worlds.image import Image as BenchImage
from host.cli import main as softrig_command
from host.cli.deploy import command
from host.deploy import image as images
from host.deploy.bootrecord import CONFIRMED, BootRecord
from host.errors import BadRequest, LinkLost, NoRobot, PortAbsent, ScriptFailed
from tests.bench_fakes import FakePlant
from tests.fake_pico import FakePico
from tests.slot_bench import PROFILE, said, small

ROBOT = ("--robot-name", "circular")
AS_ONE = softrig_command.context_settings  # a command keeps the help option that it had first


def deploy(pico, *arguments):
    """Deploy to a board and return what was printed; raises what went wrong."""
    result = CliRunner().invoke(command, ["--port", pico.port, *ROBOT, *arguments], catch_exceptions=False, **AS_ONE)
    if result.exception and not isinstance(result.exception, SystemExit):
        raise result.exception
    return result.output


@pytest.fixture(autouse=True)
def image(request, monkeypatch):
    """A small image, which is what is deployed, unless a test is named after the firmware."""
    image = images.Image("circular")
    if "firmware" not in request.node.name:
        filler = {f"firmware/part{number}.py": b"# %d\n" % number * 500 for number in range(6)}
        image.slot = {**filler, **small("a program"), "robot.json": PROFILE}
    monkeypatch.setattr("host.cli.deploy.Image", lambda name: image)
    return image


def record(folder) -> BootRecord:
    """Return the boot record in a flash."""
    copies = [folder / "boot.0", folder / "boot.1"]
    return BootRecord.newest(path.read_bytes() if path.exists() else None for path in copies)


def test_host_and_bench_agree_on_what_a_board_holds():
    image = images.Image("circular")

    bench = BenchImage.installed(PROFILE)

    deployed = {**image.root, **{f"a/{path}": data for path, data in image.slot.items()}}
    assert deployed == {path: bench.read(path) for path in bench.paths()}


def test_an_empty_board_gets_the_firmware_and_it_runs(tmp_path):
    with FakePico(tmp_path) as pico:
        told = deploy(pico)

    assert "slot a runs the firmware of circular" in told
    assert record(tmp_path).slot == 0
    assert record(tmp_path).confirmed
    assert pico.benches[0].crashes == []


def test_the_firmware_that_was_deployed_runs_in_real_micropython_too(tmp_path):
    with FakePico(tmp_path) as pico:
        deploy(pico)
    parts = Parts([(0x60, output) for output in range(8)], [0.5] * 8)

    bench = Bench(parts, FakePlant(), BenchImage.of_folder(tmp_path), execute=micropython.execute)
    bench.run(1)

    assert bench.crashes == []
    assert bench.world.running
    bench.close()


def test_the_next_deployment_goes_to_the_other_slot_and_the_same_again_has_nothing_to_do(tmp_path, image):
    with FakePico(tmp_path) as pico:
        deploy(pico)
        image.slot |= {"firmware/fresh.py": b"FRESH = 1\n"}
        second = deploy(pico)
        third = deploy(pico)

    assert "slot b runs" in second
    assert "nothing was to be done" in third
    assert (record(tmp_path).slot, record(tmp_path).tries, record(tmp_path).fallback) == (1, CONFIRMED, 0)


def test_a_bad_program_is_told_and_the_board_is_back_at_the_one_it_had(tmp_path, image):
    with FakePico(tmp_path) as pico:
        deploy(pico)
        image.slot |= {"firmware/main.py": b"raise ValueError('bad')\n"}

        with pytest.raises(ScriptFailed, match="back in slot a by itself"):
            deploy(pico)

    assert (record(tmp_path).slot, record(tmp_path).confirmed) == (0, True)
    assert said(pico.benches[-1])[-1] == "softrig: slot a is healthy"


def test_a_bad_first_program_is_told_and_leaves_the_console(tmp_path, image, monkeypatch):
    monkeypatch.setattr("host.deploy.steps.HEALTHY_S", 3.0)
    image.slot |= {"firmware/main.py": b"raise ValueError('bad')\n"}

    with FakePico(tmp_path) as pico, pytest.raises(ScriptFailed, match="none to fall back to"):
        deploy(pico)


@pytest.mark.parametrize("cut_after", [2_000, 9_000, 20_000])
def test_a_cable_that_is_pulled_leaves_the_old_program_and_the_next_try_goes_on(tmp_path, image, cut_after):
    with FakePico(tmp_path) as pico:
        deploy(pico)
    image.slot |= {"firmware/fresh.py": b"FRESH = 1\n"}

    with FakePico(tmp_path, cut_after) as pico, pytest.raises((LinkLost, NoRobot)):
        deploy(pico)
    assert record(tmp_path).slot == 0
    before = set((tmp_path / "b").rglob("*.py"))
    with FakePico(tmp_path) as pico:
        told = json.loads(deploy(pico, "--json"))

    assert told["slot"] == "b"
    assert told["copied"] <= told["files"] - len(before) + 1  # the file that was being written is written again


def test_a_first_deployment_that_was_broken_off_goes_on(tmp_path):
    with FakePico(tmp_path, 15_000) as pico, pytest.raises((LinkLost, NoRobot)):
        deploy(pico)

    with FakePico(tmp_path) as pico:
        told = json.loads(deploy(pico, "--json"))

    assert told["slot"] == "a"
    assert 0 < told["copied"] < told["files"]


def test_what_is_damaged_is_copied_again_and_what_is_stale_goes(tmp_path, image):
    with FakePico(tmp_path) as pico:
        deploy(pico)
        shutil.copytree(tmp_path / "a", tmp_path / "b")
        (tmp_path / "b/firmware/part3.py").write_bytes(b"half of")
        (tmp_path / "b/firmware/stale.py").write_bytes(b"")
        image.slot |= {"firmware/fresh.py": b"FRESH = 1\n"}

        told = json.loads(deploy(pico, "--json"))

    assert told["copied"] == 2
    assert not (tmp_path / "b/firmware/stale.py").exists()


def test_a_board_whose_program_has_just_crashed_is_asked_for_service_first(tmp_path):
    with FakePico(tmp_path, ran=True) as pico:
        deploy(pico)

    assert (tmp_path / "asked").exists()


def test_the_files_at_the_root_are_replaced_when_they_differ(tmp_path):
    with FakePico(tmp_path) as pico:
        deploy(pico)
        (tmp_path / "boot.py").write_bytes(b"pass\n")

        deploy(pico)

    assert (tmp_path / "boot.py").read_bytes() == images.Image("circular").root["boot.py"]
    assert not (tmp_path / "boot.py.new").exists()


def test_the_robot_is_asked_on_its_own_line_in_the_end(tmp_path):
    with FakePico(tmp_path) as pico:
        told = deploy(pico, "--robot", "sim:circular?body=still")

    assert told.splitlines()[-1] == "sim:circular?body=still answers: idle, code none"


def test_a_port_that_is_not_there_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr("host.deploy.console.ABSENT_S", 0.0)

    with pytest.raises(PortAbsent, match="there is no port"):
        CliRunner().invoke(command, ["--port", str(tmp_path / "tty"), *ROBOT], catch_exceptions=False, **AS_ONE)


def test_a_dry_run_without_a_port_lists_the_image(image):
    told = CliRunner().invoke(command, ["--dry-run", "--json", *ROBOT], **AS_ONE).output

    assert len(json.loads(told)["files"]) == len(image.slot) + len(image.root)


def test_a_dry_run_with_a_port_lists_what_differs_and_copies_nothing(tmp_path, image):
    with FakePico(tmp_path) as pico:
        deploy(pico)
        shutil.copytree(tmp_path / "a", tmp_path / "b")
        image.slot |= {"firmware/fresh.py": b"FRESH = 1\n"}

        told = deploy(pico, "--dry-run")

    assert told.splitlines() == ["     10  /b/firmware/fresh.py", "1 files of 10 bytes would be copied"]
    assert not (tmp_path / "b/firmware/fresh.py").exists()


@pytest.mark.parametrize("name", ["octopus", "none.json"])
def test_an_unknown_robot_is_refused(name):
    with pytest.raises(BadRequest, match=name):
        images.Image(name)
