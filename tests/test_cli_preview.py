"""`softrig preview`: what is printed, drawn and refused."""

import json

import pytest

SCRIPT = "gait 1\nrobot circular\nparam duty = 60 %\nfire A at $duty for 800 ms\nwait 1 s\n"


@pytest.fixture
def script(tmp_path):
    """Return the path of a script."""
    path = tmp_path / "push.gait"
    path.write_text(SCRIPT)
    return path


def test_a_script_is_shown_in_the_terminal(softrig, script):
    shown = softrig("preview", str(script))

    assert shown.status == 0
    assert "push.gait on circular" in shown.out
    assert "line 4" in shown.out


def test_a_picture_is_written_where_it_is_asked_for(softrig, script, tmp_path):
    drawn = softrig("preview", str(script), "-o", str(tmp_path / "push.svg"), "--theme", "dark")

    assert drawn.status == 0
    assert drawn.out == ""
    assert (tmp_path / "push.svg").read_text().startswith("<svg")


def test_another_picture_than_svg_is_refused(softrig, script):
    assert softrig("preview", str(script), "-o", "push.png").status == 2


def test_json_tells_orders_curves_and_peaks(softrig, script):
    fields = json.loads(softrig("preview", str(script), "-p", "duty=50%", "--json").out)

    coil = fields["ways"]["only"]["coils"]["A"]
    assert coil["orders"][0]["duty_permille"] == 500
    assert max(degc for _, degc in coil["curve"]) == pytest.approx(fields["forecast"]["coils"]["A"]["peak_degc"], abs=1)


def test_two_scripts_are_compared(softrig, script, tmp_path):
    longer = tmp_path / "longer.gait"
    longer.write_text(SCRIPT.replace("800 ms", "900 ms"))

    told = json.loads(softrig("preview", str(longer), "--diff", str(script), "--json").out)

    assert told["coils"]["A"]["on_ms"] == {"old": 800, "new": 900}
    assert told["added"] == [{"line": 4, "text": "fire A at $duty for 900 ms"}]


def test_scripts_for_different_robots_are_not_compared(softrig, script, tmp_path):
    other = tmp_path / "other.gait"
    other.write_text("gait 1\nrobot sphere-b\nfire A100 at 60 % for 1 s\n")

    refused = softrig("preview", str(script), "--diff", str(other))

    assert refused.status != 0


def test_a_check_tells_the_predicted_peak_and_refuses_one_at_the_trip(softrig, script, tmp_path):
    hot = tmp_path / "hot.gait"
    hot.write_text("gait 1\nrobot circular\nfire A at 100 % for 1100 ms\n")

    sound, refused = softrig("check", str(script)), softrig("check", str(hot), "--robot", "sim:circular?supply=2.4")

    assert "predicted peak (trip 120 C)" in sound.out
    assert refused.status == 4
    assert f"{hot}:3:" in refused.err
    assert "E328" in refused.err
