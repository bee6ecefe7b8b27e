"""What is promised for each fault: code, longest time until all coils are off and joints limp, news, way back.

One row per fault and situation. tests/test_hil_fault_table.py runs each through the whole stack, docs/faults.md is
made from it. Times count from the instant of the fault; `why` says what they are made of.
"""

from dataclasses import dataclass

STEP_MS = 5
BUS_MS = 25  # from an access to the bus to the next: after a measurement the averages are not read for four steps
SLOT_MS = 320  # between two measurements of coils that are on
CHECK_MS = 325  # between two looks at the chips' settings, and the step of the second try
LEASE_MS = 505  # and one step
MONOSTABLE_MS = 50

PUSH = "press to 3 N over 1 s for 5 s overlap 4 s\n"
GRIP = "together:\n    move R to 8 deg over 500 ms\n    move L to -8 deg over 500 ms\n"

ORDERS = {  # what is going on: the script, and the time after connecting within which the fault happens [ms]
    "before arming": ("fire {two} at 30 % for 4 s", (0, 0)),
    "two coils at 30 %": ("fire {two} at 30 % for 4 s", (600, 2400)),
    "a coil at 100 %": ("fire {one} at 100 % for 900 ms", (250, 700)),
    "all coils off": ("wait 3 s", (300, 1500)),
    "a guard trips": ("guard any.temperature > 40 C\nfire {one} at 100 % for 900 ms", (0, 50)),
    "attitude is asked for": ("guard roll > 80 deg\nfire {one} at 5 % for 3 s", (300, 1500)),
    "a joint moves": ("move R to -20 deg over 3 s", (700, 2000)),
    "joints hold": (GRIP + "wait 5 s", (1200, 2500)),
    "an object is turned": (GRIP + "orient 1 deg for 3 s", (1200, 2500)),
    "before pressing": ("press to 3 N over 1 s for 3 s", (0, 0)),
    "an axis moves": ("move P to 4 mm over 2 s\nwait 3 s", (700, 1500)),
    "an axis holds": ("move P to 4 mm over 800 ms\nwait 5 s", (1400, 2500)),
    "a force is held": ("press to 3 N over 1 s for 4 s", (1500, 3000)),
    "a force cell is asked for": (PUSH + "wait until C1.pressure < 1 kPa timeout 4 s else abort", (1500, 3000)),
}  # fmt: skip
RECOVERIES = {
    "none": "Nothing to do.",
    "clear": "`softrig clear`, then go on.",
    "mend, clear": "`clear` is refused (R18) until it is mended.",
    "clear, mend": "`clear` works; the next arming or run ends with {again} until it is mended.",
    "mend": "Mend it and connect again.",
    "replace": "Until it is mended, each arming is refused with {again}.",
    "orient": "Until it is mended, each `orient` is refused with {again}.",
}
EXAMPLE = """seed = 1

[[fault]]
name = "coil-open:A"
at_ms = [1000, 5000]    # drawn with the seed

[[fault]]
name = "line-lose:20"   # of 1000 bytes
at_ms = 0
for_ms = 3000
"""
EXIT_CODES = {"done": 0, "guard": 1, "camera lost": 1, "refused": 4, "fault": 6, "lease": 7, "link lost": 7}
ANY = "any"  # code: none, or that of whatever a wrong bit looks like


@dataclass(frozen=True)
class Row:
    """One promise. `off_ms` None: all go on as ordered. `ending` is the word of the run's report, or two of them.

    Where arming is refused, no coil is on for longer than the pulses of the self-test.
    """

    fault: str
    during: str
    code: str
    off_ms: int | None
    ending: str
    recovery: str
    why: str
    again: str = ""  # the code that the next arming or run ends with until it is mended
    after: str = ""  # the code of a robot that is latched afterwards, where it is not `code`
    robot: str = "circular"

    @property
    def endings(self) -> list[str]:
        """Return the words of the report that may come."""
        return self.ending.split(" or ")

    @property
    def exit_codes(self) -> list[int]:
        """Return the exit status of `softrig run` for each of them."""
        return [EXIT_CODES[ending] for ending in self.endings]

    @property
    def recovers(self) -> str:
        """Return the way back in words."""
        return RECOVERIES[self.recovery].format(again=self.again)


TWO, FULL, IDLE, BEFORE, GUARDED, ATTITUDE, MOVING, HOLDING, TURNING, UNPRESSED, AXIS, DEPTH, FORCE, CELL = (
    "two coils at 30 %",
    "a coil at 100 %",
    "all coils off",
    "before arming",
    "a guard trips",
    "attitude is asked for",
    "a joint moves",
    "joints hold",
    "an object is turned",
    "before pressing",
    "an axis moves",
    "an axis holds",
    "a force is held",
    "a force cell is asked for",
)
BEFORES = (BEFORE, UNPRESSED)
GOES_ON = (None, "done", "none")
FINGERS, PRESS = "fingers", "press"
ASTRAY_MS = 1700  # to be pushed away, the profile's astray_ms, and the next look
POT_MS = 115  # one joint is read in a step: ten readings, one more, and the supply
READS_MS = 65  # ten readings, one a step, one more and the step that acts
PULSES_MS = 16  # a stuck MOSFET: from the supply's switch to the look

ROWS = (
    Row("coil-open:A", BEFORE, "F18", PULSES_MS, "refused", "replace", "The self-test measures each coil.", "F18"),
    Row(
        "coil-open:A", TWO, "F18", 3 * SLOT_MS + STEP_MS, "fault", "clear, mend",
        "Coils that are on are measured in turn, then none: with two on, each comes up in every third slot.", "F18",
    ),
    Row("coil-short:A", BEFORE, "F19", PULSES_MS, "refused", "replace", "The self-test measures each coil.", "F19"),
    Row(
        "coil-short:A", TWO, "F19", 650, "fault", "clear, mend",
        "Its mean current stays below the limits, but is not explained: looks with all off and at each coil, by turns.",
        "F19",
    ),
    Row(
        "coil-short:A", FULL, "F22", 25, "fault", "clear, mend",
        "ALERT opens the outputs in hardware at the end of a conversion (9.8 ms) that saw it for long enough.", "F19",
    ),
    Row(
        "mosfet-stuck:C", BEFORE, "F13", PULSES_MS, "refused", "replace",
        "The self-test looks for current with every output off.", "F13",
    ),
    Row(
        "mosfet-stuck:C", TWO, "F21", 155, "fault", "clear, mend",
        "Five readings of the mean current that the orders do not explain, then a look with every output off.", "F13",
    ),
    Row(
        "mosfet-stuck:A", TWO, "F21", 155, "fault", "clear, mend",
        "That the coil is ordered makes no difference: it conducts all the time.", "F13",
    ),
    Row(
        "mosfet-stuck:C", IDLE, "F13", 130, "fault", "clear, mend",
        "Current with all coils off must last 100 ms to be believed: readings are averages.", "F13",
    ),
    Row(
        "contactor-welded", BEFORE, "F20", PULSES_MS, "refused", "replace",
        "The self-test looks for current before it closes the supply.", "F20",
    ),
    Row(
        "contactor-welded", TWO, "", *GOES_ON,
        "Nothing differs while the supply is to be closed; the next arming is refused.", "F20",
    ),
    Row(
        "monostable-bypassed", BEFORE, "F18", PULSES_MS, "refused", "replace",
        "OE follows the heartbeat: a coil that is measured while that is high seems open.", "F18",
    ),
    Row("supply-sag:5", TWO, "", *GOES_ON, "Within the limits of the profile."),
    Row(
        "supply-sag:30", TWO, "F07", 165, "fault", "clear, mend",
        "A low supply must last 100 ms to be believed; the voltage is read every 20 ms, seldom later.", "F07",
    ),
    Row("supply-sag:100", BEFORE, "F07", PULSES_MS, "refused", "replace", "The self-test reads the voltage.", "F07"),
    Row("brown-out", TWO, "", 0, "link lost", "mend", "Without a supply nothing drives a MOSFET."),
    Row(
        "power-cycle", TWO, "", 0, "link lost", "clear",
        "The robot starts anew; its host has lost the session and sends stop (F01). A capacitor remembers that the "
        "coil supply was closed: every coil counts as hot until it must have cooled.", after="F01",
    ),
    Row(
        "battery-empty", TWO, "", 10, "link lost", "mend",
        "Its protection opens at the next point of the bench's grid.", robot="sphere-a",
    ),
    Row(
        "thermistor-open", TWO, "F09", CHECK_MS, "fault", "mend, clear",
        "The temperature of the board is read every 64 steps.",
    ),
    Row("thermistor-short", TWO, "F09", CHECK_MS, "fault", "mend, clear", "As above."),
    Row(
        "thermistor-drift:60", TWO, "F09", 1000 + CHECK_MS, "fault", "mend, clear",
        "After 1 s it reads what no board has. A slow drift is believed; the estimates count less than 20 C as 20 C.",
    ),
    Row("i2c-nack:1", TWO, "", *GOES_ON, "A step in which a chip does not answer is run once more."),
    Row("i2c-nack:20", TWO, "F08", BUS_MS + STEP_MS, "fault", "clear", "The second try fails, too."),
    Row(
        "i2c-bit-error:1", TWO, ANY, None, "done or fault", "clear",
        "A wrong reading may trip; what a wrong write does is found or put right within 325 ms.",
    ),
    Row(
        "i2c-bit-error:200", TWO, ANY, 300, "fault", "clear",
        "A wrong reading trips; so do settings that are not as they should be.",
    ),
    Row(
        "i2c-stuck", TWO, "F08", BUS_MS + STEP_MS, "fault", "mend, clear",
        "Two tries, whose transfers end by their time-out of 1 ms; then the contactor opens.",
    ),
    Row(
        "pwm-dead", TWO, "F08", CHECK_MS, "fault", "mend, clear",
        "Outputs are written when they change, settings are read every 64 steps; then the contactor opens.",
    ),
    Row(
        "pwm-forgets", TWO, "F08", 0, "fault", "clear",
        "A chip that was reset sleeps; it is told when its settings are read.",
    ),
    Row(
        "monitor-dead", TWO, "F08", BUS_MS + STEP_MS, "fault", "mend, clear",
        "It is read in every other step, but for 20 ms after a measurement.",
    ),
    Row("monitor-forgets", TWO, "F08", CHECK_MS, "fault", "clear", "Its settings are read every 64 steps."),
    Row("imu-dead", IDLE, "", *GOES_ON, "The robot tells that it has lost it (`lost`, F17).", robot="sphere-a"),
    Row(
        "imu-dead", ATTITUDE, "F17", 115, "fault", "clear, mend",
        "Readings that fail for 100 ms.", "R20", robot="sphere-a",
    ),
    Row(
        "imu-stuck", ATTITUDE, "F17", 510, "fault", "clear, mend",
        "A sensor in order is never still: readings that are equal for 500 ms.", "R20", robot="sphere-a",
    ),
    Row(
        "hang", TWO, "F12", MONOSTABLE_MS, "fault", "clear",
        "The monostable falls 50 ms after the last heartbeat; the watchdog resets after 200 ms.",
    ),
    Row("hang:receive", TWO, "F12", MONOSTABLE_MS + STEP_MS, "fault", "clear", "As above, from the task's turn on."),
    Row(
        "hang:control", TWO, "F12", MONOSTABLE_MS + BUS_MS, "fault", "clear",
        "As above: the task's turn is the next access to the bus.",
    ),
    Row("hang:send", TWO, "F12", MONOSTABLE_MS + 60, "fault", "clear", "As above; telemetry is sent every 50 ms."),
    Row("reset", TWO, "F12", 0, "fault", "clear", "PWR_EN rests low: the contactor opens."),
    Row(
        "flash-cut:2", GUARDED, "F10", None, "guard", "none",
        "Records are written when every coil is off. The robot starts anew; the torn record is passed over.",
    ),
    Row("line-flip:5", TWO, "", *GOES_ON, "A damaged frame is dropped and sent again."),
    Row("line-lose:2", TWO, "", *GOES_ON, "As above."),
    Row("line-double:5", TWO, "", *GOES_ON, "As above."),
    Row("line-delay:50", TWO, "", *GOES_ON, "Shorter than the lease."),
    Row("line-flip:900", TWO, "", LEASE_MS, "link lost", "mend", "No frame is whole: the lease runs out (F03)."),
    Row("line-lose:900", TWO, "", LEASE_MS, "link lost", "mend", "As above."),
    Row("line-double:900", TWO, "", LEASE_MS, "link lost", "mend", "As above."),
    Row("line-delay:2000", TWO, "F03", LEASE_MS, "lease", "mend", "The lease runs out before a frame arrives."),
    Row("line-baud:57600", TWO, "", LEASE_MS, "link lost", "mend", "Noise in place of bytes: the lease runs out."),
    Row("cable-cut", TWO, "", LEASE_MS, "link lost", "mend", "The lease runs out (F03)."),
    Row("host-killed", TWO, "", LEASE_MS, "link lost", "mend", "The lease runs out (F03)."),
    Row("estop-open", TWO, "F02", 0, "fault", "mend, clear", "The loop opens the outputs itself."),
    Row(
        "estop-open", HOLDING, "F02", 5, "fault", "mend, clear",
        "The loop opens the supply of the servos itself; a joint is looked at every 5 ms.", robot=FINGERS,
    ),
    Row(
        "hang", HOLDING, "F12", 205, "fault", "clear",
        "A servo's pulses need no program: the joints hold until the watchdog resets.", robot=FINGERS,
    ),
    Row("reset", HOLDING, "F12", 5, "fault", "clear", "PWR_EN rests low.", robot=FINGERS),
    Row("cable-cut", HOLDING, "", LEASE_MS + 5, "link lost", "mend", "The lease runs out (F03).", robot=FINGERS),
    Row(
        "contactor-welded", HOLDING, "", *GOES_ON,
        "Nothing tells: servos at rest take too little to be seen. They go limp because their pulses end.",
        robot=FINGERS,
    ),
    Row(
        "joint-jam:R", MOVING, "F25", 1000, "fault", "clear, mend",
        "At 6.7 deg/s a servo strains for 650 ms before it takes its stall current; that must last for 300 ms.", "F25",
        robot=FINGERS,
    ),
    Row("joint-jam:R", HOLDING, "", *GOES_ON, "A joint that holds does not turn.", robot=FINGERS),
    Row(
        "servo-dead:R", HOLDING, "F28", ASTRAY_MS, "fault", "clear, mend",
        "The grip pushes the finger away; 1.5 degrees off for 1.5 s are more than any lag. One in place is not seen.",
        "F28", robot=FINGERS,
    ),
    Row(
        "pot-open:R", HOLDING, "F26", POT_MS, "fault", "clear, mend",
        "A reading that no position gives, ten times.", "F26", robot=FINGERS,
    ),
    Row("camera-lost", HOLDING, "", *GOES_ON, "Nobody asks for it.", robot=FINGERS),
    Row(
        "camera-lost", TURNING, "F27", None, "camera lost", "orient",
        "No new frame for 100 ms ends the loop; the joints hold.", "R33", robot=FINGERS,
    ),
    Row("camera-frozen", TURNING, "F27", None, "camera lost", "orient", "As above.", "R33", robot=FINGERS),
    Row("object-hidden", TURNING, "F27", None, "camera lost", "orient", "As above.", "R33", robot=FINGERS),
    Row(
        "converter-dead", HOLDING, "F26", POT_MS, "fault", "clear, mend",
        "The potentiometers read what no position gives, ten times.", "F26", robot=FINGERS,
    ),
    Row("converter-dead:2", HOLDING, "", *GOES_ON, "Nothing that fingers have hangs on it.", robot=FINGERS),
    Row(
        "estop-open", FORCE, "F02", 5, "fault", "mend, clear",
        "The loop opens the supply of the servo itself; the axis stays where it is, by its screw.", robot=PRESS,
    ),
    Row(
        "hang", FORCE, "F12", 205, "fault", "clear",
        "A servo's pulses need no program: the axis holds until the watchdog resets, and goes no further.", robot=PRESS,
    ),
    Row("reset", FORCE, "F12", 5, "fault", "clear", "PWR_EN rests low; the axis stays where it is.", robot=PRESS),
    Row("cable-cut", FORCE, "", LEASE_MS + 5, "link lost", "mend", "The lease runs out (F03).", robot=PRESS),
    Row(
        "joint-jam:P", AXIS, "F25", 500, "fault", "clear, mend",
        "At 2 mm/s a servo strains for 60 ms before it takes its stall current; that must last for 300 ms.", "F25",
        robot=PRESS,
    ),
    Row("joint-jam:P", DEPTH, "", *GOES_ON, "An axis that holds does not move.", robot=PRESS),
    Row(
        "servo-dead:P", AXIS, "F28", ASTRAY_MS + 200, "fault", "clear, mend",
        "At 2 mm/s it is 0.5 mm off after 250 ms; that must last for 1.5 s.", "F28", robot=PRESS,
    ),
    Row("servo-dead:P", DEPTH, "", *GOES_ON, "The screw holds the axis without it.", robot=PRESS),
    Row(
        "pot-open:P", FORCE, "F26", READS_MS, "fault", "clear, mend",
        "A reading that no position gives, ten times, one in each step.", "F26", robot=PRESS,
    ),
    Row(
        "load-cell-open", UNPRESSED, "F30", 0, "refused", "replace",
        "Readings at the end of the converter's range: no force is regulated by them.", "F30", robot=PRESS,
    ),
    Row("load-cell-open", FORCE, "F30", READS_MS, "fault", "clear, mend", "Ten of them.", "F30", robot=PRESS),
    Row(
        "load-cell-open", DEPTH, "F30", READS_MS, "fault", "clear, mend",
        "As above: an axis without a load cell would press as hard as it can.", "F30", robot=PRESS,
    ),
    Row(
        "cell-open:C1", FORCE, "", *GOES_ON,
        "Nothing tells: an open force cell reads 0, as one without pressure does.", robot=PRESS,
    ),
    Row(
        "cell-open:C1", CELL, "", None, "done", "none",
        "A condition takes the 0 for a pressure.", robot=PRESS,
    ),
    Row(
        "converter-dead:1", FORCE, "F26", READS_MS, "fault", "clear, mend",
        "The potentiometer hangs on it.", "F26", robot=PRESS,
    ),
    Row(
        "converter-dead:2", FORCE, "F30", READS_MS, "fault", "clear, mend",
        "The load cell hangs on it.", "F30", robot=PRESS,
    ),
)  # fmt: skip
