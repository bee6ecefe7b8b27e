"""The one table of refusals and faults: number, code, cause, what the robot did, what to do.

`softrig explain CODE` prints a row, and the reference page is made from the table. For hosts: a board holds the
numbers only (codes.py).
"""

from collections import namedtuple

from protocol import codes

Code = namedtuple("Code", ("number", "name", "unit", "cause", "did", "todo"))

NOTHING = "Nothing changed."
ALL_OFF = "Everything off, latched until clear."
FOUND = "Before arming: refused, everything off. While armed: everything off, latched until clear."

CODES = (
    Code(
        codes.NOT_ARMED, "R01", "",
        "The robot is not armed.",
        NOTHING,
        "Arm first; `run`, `fire`, `move`, `orient` and `press` do it themselves.",
    ),
    Code(
        codes.TRIPPED, "R02", "",
        "The robot has tripped and is latched.",
        NOTHING,
        "See the fault, mend its cause, then `softrig clear`.",
    ),
    Code(
        codes.UNKNOWN_CHANNEL, "R03", "",
        "The robot has no such channel, or none of that kind.",
        NOTHING,
        "`softrig info` lists the labels.",
    ),
    Code(
        codes.DUTY_LIMIT, "R04", "permille",
        "The duty is above the coil's limit.",
        NOTHING,
        "Ask for less; the limit is in the robot's profile.",
    ),
    Code(
        codes.HOLD_LIMIT, "R05", "ms",
        "The order lasts longer than one order may.",
        NOTHING,
        "Split it; each order must carry a short end of its own.",
    ),
    Code(
        codes.LEASE_HELD, "R06", "",
        "Another session holds the lease.",
        NOTHING,
        "Wait until it ends or its lease runs out; `stop` works for everybody.",
    ),
    Code(
        codes.AT_ONCE_LIMIT, "R07", "coils",
        "More coils would be on at once than the supply feeds.",
        NOTHING,
        "Fire fewer at once.",
    ),
    Code(
        codes.RESTING, "R08", "ms",
        "The coil was on without a pause for as long as it may and must rest.",
        NOTHING,
        "Wait for the rest time.",
    ),
    Code(
        codes.BAD_PAYLOAD, "R09", "bytes",
        "The payload does not fit its message.",
        NOTHING,
        "Use the table of messages of this robot.",
    ),
    Code(
        codes.UNKNOWN_MESSAGE, "R10", "",
        "The robot does not know this message.",
        NOTHING,
        "Use the table of messages of this robot.",
    ),
    Code(
        codes.BAD_HEADER, "R11", "",
        "The program has no header this firmware reads.",
        NOTHING,
        "Compile again with this version of softrig.",
    ),
    Code(
        codes.OTHER_ROBOT, "R12", "",
        "The program was compiled for another robot or other limits.",
        NOTHING,
        "Compile it for this robot: `softrig run` does.",
    ),
    Code(
        codes.TOO_LARGE, "R13", "bytes",
        "The program is larger than the robot's memory for it.",
        NOTHING,
        "Use repeat and def, or split the script.",
    ),
    Code(
        codes.BAD_CODE, "R14", "byte",
        "The program failed its verification at this byte.",
        NOTHING,
        "Send it again; report it if it persists.",
    ),
    Code(
        codes.BUSY, "R15", "",
        "A program is running, or the self-test that stands before arming.",
        NOTHING,
        "Wait for its end, or cancel the program.",
    ),
    Code(
        codes.NO_PROGRAM, "R16", "",
        "No program was uploaded.",
        NOTHING,
        "Upload one first.",
    ),
    Code(
        codes.LEASE_LIMIT, "R17", "ms",
        "The lease asked for is outside the robot's limits.",
        NOTHING,
        "Ask for a shorter lease.",
    ),
    Code(
        codes.CAUSE_REMAINS, "R18", "",
        "The cause of the fault is still there.",
        "Stays tripped.",
        "Mend the cause, then clear.",
    ),
    Code(
        codes.OTHER_VERSION, "R19", "version",
        "Host and robot speak different versions of the protocol.",
        NOTHING,
        "Update the older of the two.",
    ),
    Code(
        codes.NO_ATTITUDE, "R20", "",
        "The program asks where down is, and the robot has no attitude sensor or has lost it.",
        NOTHING,
        "Run it on a robot with an attitude sensor; `softrig status` shows whether it works.",
    ),
    Code(
        codes.SETTING_LIMIT, "R21", "",
        "There is no such setting, or its value is outside its range.",
        NOTHING,
        "`softrig settings` lists them with their ranges.",
    ),
    Code(
        codes.NOT_WHILE_ARMED, "R22", "",
        "The robot keeps records only while everything is off and the supply is open.",
        NOTHING,
        "Disarm first.",
    ),
    Code(
        codes.FLASH_FAILED, "R23", "",
        "The flash did not take the record.",
        "The record before it stands.",
        "Try again; replace the board if it persists.",
    ),
    Code(
        codes.NOT_COLD, "R24", "0.1 C",
        "The coil may still be warm: its resistance would be that of another phase.",
        NOTHING,
        "Let it cool; after a reset the robot takes every coil as hot until it must have cooled.",
    ),
    Code(
        codes.CANCELLED, "R25", "",
        "The program was cancelled before it was verified.",
        NOTHING,
        "Start it again if it is wanted.",
    ),
    Code(
        codes.UNKNOWN_VARIABLE, "R26", "",
        "The robot has no variable of that number.",
        NOTHING,
        "`softrig watch --list` names those there are; update the older of robot and host.",
    ),
    Code(
        codes.RECORD_LIMIT, "R27", "bytes",
        "The variables do not fit into one record of telemetry, or the robot has none of them.",
        NOTHING,
        "Ask for fewer, or share them out to several slots; `softrig watch --list` tells what each is of.",
    ),
    Code(
        codes.PERIOD_LIMIT, "R28", "ms",
        "The period of telemetry is shorter than a control step.",
        NOTHING,
        "Ask for a longer one: nothing changes within a step.",
    ),
    Code(
        codes.SLOT_LIMIT, "R29", "",
        "The robot has no such slot of telemetry.",
        NOTHING,
        "Use one of those there are, counted from 0.",
    ),
    Code(
        codes.OPEN_START, "R30", "",
        "A robot with a pairing key does not wait for `sync`, which anybody may say.",
        NOTHING,
        "Start the program at a time of the robot's clock instead.",
    ),
    Code(
        codes.RANGE_LIMIT, "R31", "centi",
        "The position is outside the joint's range, or both joints are swung too far for `orient` to begin.",
        NOTHING,
        "Ask for one within it; the limits are in the robot's profile.",
    ),
    Code(
        codes.SLEW_LIMIT, "R32", "centi/s",
        "The joint would have to go faster than it may.",
        NOTHING,
        "Give it more time.",
    ),
    Code(
        codes.NO_CAMERA, "R33", "",
        "The angle of the object is asked for, and no camera sees it.",
        NOTHING,
        "Check the camera and its view of the object; a robot without one cannot do this.",
    ),
    Code(
        codes.NOT_HELD, "R34", "",
        "An object can only be turned by joints that hold it, and one of them is limp.",
        NOTHING,
        "Move both joints first, so that they grip the object.",
    ),
    Code(
        codes.NO_LOAD_CELL, "R35", "",
        "The force on a load cell is asked for or to be regulated, and this robot has none, or no press.",
        NOTHING,
        "Move the joint to a position instead.",
    ),
    Code(
        codes.FORCE_LIMIT, "R36", "mN",
        "The force is beyond what may be asked of the press.",
        NOTHING,
        "Ask for less; the limit is in the robot's profile.",
    ),
    Code(
        codes.STARVED, "R37", "",
        "The next order of a streamed program was due and had not arrived.",
        "The program was aborted: all coils off, joints hold, still armed.",
        "Look for what holds the line or the host up; upload a program that fits into the robot instead.",
    ),
    Code(
        codes.NOT_RUNNING, "R38", "",
        "No program runs that could be paused.",
        NOTHING,
        "Start one.",
    ),
    Code(
        codes.STOP, "F01", "",
        "A stop was received.",
        ALL_OFF,
        "`softrig clear` when it is safe.",
    ),
    Code(
        codes.ESTOP, "F02", "",
        "The emergency-stop loop is open.",
        ALL_OFF,
        "Close the loop, then `softrig clear`.",
    ),
    Code(
        codes.LEASE_EXPIRED, "F03", "ms",
        "Nothing was heard from the host for the lease.",
        "Everything off, disarmed.",
        "Check the cable and the host; then run again.",
    ),
    Code(
        codes.HEAT_BUDGET, "F04", "mJ",
        "A coil took more energy than its heat budget.",
        ALL_OFF,
        "Lower duty or time, or let it cool longer; `softrig check` predicts it.",
    ),
    Code(
        codes.OVER_TEMPERATURE, "F05", "0.1 C",
        "A coil's estimated temperature is above its limit.",
        ALL_OFF,
        "Lower duty or time, or let it cool longer.",
    ),
    Code(
        codes.OVER_CURRENT, "F06", "mA",
        "The supply current is above its limit.",
        ALL_OFF,
        "Look for a shorted coil, or a servo that takes too much; drive fewer at once.",
    ),
    Code(
        codes.SUPPLY_LOW, "F07", "mV",
        "The supply voltage is below its limit.",
        ALL_OFF,
        "Charge or replace the supply; drive fewer at once.",
    ),
    Code(
        codes.CHIP, "F08", "",
        "A chip does not answer or has lost its settings.",
        "Supply switched off, latched.",
        "Check the wiring of the bus, then `softrig clear`.",
    ),
    Code(
        codes.SENSOR, "F09", "0.1 C",
        "A sensor reads a value that cannot be.",
        ALL_OFF,
        "Check the sensor and its wires.",
    ),
    Code(
        codes.GUARD, "F10", "",
        "A guard of the program held.",
        ALL_OFF,
        "The report names the line that ran then; change the script or its limits.",
    ),
    Code(
        codes.WAIT_TIMEOUT, "F11", "",
        "A wait of the program ran out of time.",
        "Program ended, all coils off, joints hold, still armed.",
        "Give it more time, or write `else continue`.",
    ),
    Code(
        codes.WATCHDOG, "F12", "",
        "The firmware hung, or its clock had run for six days, and it was restarted.",
        "Everything off by hardware, disarmed.",
        "Keep the log and report it.",
    ),
    Code(
        codes.STRAY_CURRENT, "F13", "mA",
        "Current flows although everything is off.",
        "Before arming: refused. Else latched. The supply is switched off.",
        "A MOSFET is stuck, or a limp servo takes current: replace it.",
    ),
    Code(
        codes.ON_TOO_LONG, "F14", "ms",
        "A coil was on without a pause for longer than it may.",
        ALL_OFF,
        "Put a pause between its orders.",
    ),
    Code(
        codes.REFUSED_STEP, "F15", "",
        "A step of the program asked for what the limits forbid.",
        ALL_OFF,
        "`softrig check` names the line; the event names the limit.",
    ),
    Code(
        codes.SUPPLY_HIGH, "F16", "mV",
        "The supply voltage is above its limit: what hangs on it would burn.",
        ALL_OFF,
        "Set the supply to the robot's own voltage; `softrig info` prints it.",
    ),
    Code(
        codes.ATTITUDE, "F17", "",
        "The attitude sensor does not answer, is another chip, or its readings do not change.",
        "Everything off, latched, if the program asks where down is; else only told.",
        "Check the sensor and its bus, then `softrig clear`.",
    ),
    Code(
        codes.COIL_OPEN, "F18", "mohm",
        "A coil's resistance is above its band: its wire or a contact is open.",
        FOUND,
        "Mend the coil, or arm with `--without COIL`: it is passed over then.",
    ),
    Code(
        codes.COIL_SHORT, "F19", "mohm",
        "A coil's resistance is below its band: it is shorted, or another coil is on beside it.",
        FOUND,
        "Mend it, or arm with `--without COIL`: it is passed over then.",
    ),
    Code(
        codes.CONTACTOR, "F20", "mA",
        "Current flows although the coil supply is switched off: its switch is welded or bridged.",
        "Refused to arm, everything off.",
        "Disconnect the supply by hand and replace the switch behind PWR_EN.",
    ),
    Code(
        codes.EXCESS_CURRENT, "F21", "mA",
        "More current flows than was ordered; it goes on with every output off.",
        "Supply switched off, latched.",
        "A MOSFET is stuck: replace it.",
    ),
    Code(
        codes.ALERT, "F22", "mA",
        "The current monitor has raised its alarm: the supply current was far above its limit.",
        "Coils off by hardware, then everything; latched until clear.",
        "Look for a shorted coil: `softrig clear`, then `softrig arm` names it.",
    ),
    Code(
        codes.SETTINGS, "F23", "",
        "The settings that were stored are damaged or of another version.",
        "The defaults are used; only told.",
        "Set them again with `softrig settings`, and `softrig calibrate`.",
    ),
    Code(
        codes.KEY, "F24", "",
        "The pairing key is damaged, or the number of this start could not be written down.",
        "No session begins, so that nobody can arm; latched.",
        "Make a new key with `softrig key new` and put it on the robot with `softrig deploy --key`.",
    ),
    Code(
        codes.STALL, "F25", "mA",
        "A joint's servo took its stall current for too long: it cannot turn as it is told.",
        ALL_OFF,
        "Find what blocks it, or grip with less; then `softrig clear`.",
    ),
    Code(
        codes.JOINT, "F26", "counts",
        "The reading of a joint's angle is none that its potentiometer gives.",
        FOUND,
        "Check the potentiometer's wire and the converter, then `softrig clear`.",
    ),
    Code(
        codes.CAMERA, "F27", "ms",
        "The camera gave no new angle of the object for too long while it was needed.",
        "The regulation ended and the joints hold; a program that needed it was aborted.",
        "Check the camera, its bus and its view of the object.",
    ),
    Code(
        codes.ASTRAY, "F28", "centi",
        "A joint stands elsewhere than it was told, for too long: its servo gives no torque, or too little.",
        ALL_OFF,
        "Check the servo, its gear, its horn and its supply, then `softrig clear`.",
    ),
    Code(
        codes.OVERLOAD, "F29", "mN",
        "The force on the load cell went beyond its limit.",
        ALL_OFF + " The axis of a press stays where it is: its screw holds it.",
        "Find out what was in the way; `softrig clear`, arm and move the axis back. With nothing in the way, check "
        "the load cell's wire and amplifier.",
    ),
    Code(
        codes.LOAD_CELL, "F30", "counts",
        "The load cell reads the lower end of its range: it is torn off, or pulled far beyond it.",
        FOUND + " The axis of a press stays where it is: its screw holds it.",
        "Check the load cell's wire, its amplifier and the converter, then `softrig clear`.",
    ),
)  # fmt: skip


def row(number: int) -> Code | None:
    """Return the row of that number, or None."""
    for code in CODES:
        if code.number == number:
            return code
    return None


def named(name: str) -> Code | None:
    """Return the row called `name` (R04, F05, ...), or None."""
    for code in CODES:
        if code.name == name.upper():
            return code
    return None
