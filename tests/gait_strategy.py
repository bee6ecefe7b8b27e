"""Random scripts that are valid: of the whole language but for includes, for any robot, as a person might type them.

`scripts(profile)` draws a script that compiles, and that mostly keeps the limits of its robot; `robots` draws the
profile of a robot of the project. `scruffy` draws the same script as somebody in a hurry leaves it: other blanks and
indentation, comments and blank lines anywhere.

    SOFTRIG_EXAMPLES=5000 pytest --timeout 0 tests/test_gait_trees.py    # many more examples
"""

import os
import random
from dataclasses import dataclass, field

from hypothesis import strategies as st

from host.profile import Profile
from tests.gait_scripts import ROOT, profile_of

ROBOTS = [path.stem for path in sorted((ROOT / "firmware" / "robots").glob("*.json"))]
DEPTH_MAX = 3
ASKED_OF_COILS = ["temperature > 95 C", "temperature < 45.5 C", "heat > 200 mJ", "resistance > 4.2 ohm",
                  "resistance < 9700 mohm", "martensite < 20 %"]  # fmt: skip
COMMENTS = ["# warm", "#", "#no blank", '# $t0 is no value; "quoted" 100 %', "# fire A at 60 %", "# é ü 中"]

robots = st.sampled_from(ROBOTS).map(profile_of)


def examples(count: int) -> int:
    """Return how many examples a test draws: so many, or as many as SOFTRIG_EXAMPLES says."""
    return int(os.environ.get("SOFTRIG_EXAMPLES", count))


@st.composite
def scripts(draw, profile: Profile):
    """Draw a script for that robot."""
    return "\n".join(_Pen(draw, profile).script()) + "\n"


@st.composite
def scruffy(draw, text: str):
    """Draw the same script in a hurry."""
    hurry = random.Random(draw(st.integers(0, 2**32 - 1)))
    step = hurry.choice([1, 2, 3, 4, 7])
    lines = []
    for line in text.splitlines():
        depth = (len(line) - len(line.lstrip())) // 4
        while hurry.random() < 0.2:
            lines.append(hurry.choice(["", "  ", " " * hurry.randrange(3 * step) + hurry.choice(COMMENTS)]))
        beside = " " * hurry.randrange(5) + hurry.choice(COMMENTS) if hurry.random() < 0.2 else ""
        lines.append(" " * step * depth + _respaced(line.strip(), hurry) + beside)
    lines += [hurry.choice(["", " " * hurry.randrange(3 * step) + "# end"]) for _ in range(hurry.randrange(4))]
    # What stands first may not be indented.
    first = next(at for at, line in enumerate(lines) if line.strip() and not line.lstrip().startswith("#"))
    return "\n".join([*lines[:first], lines[first].lstrip(), *lines[first + 1 :]])


def _respaced(line, hurry):
    """Return a line with other blanks between its words, those in quotation marks as they are."""
    parts = line.split('"')
    for at in range(0, len(parts), 2):
        words = parts[at].split(" ")
        parts[at] = "".join(word + " " * hurry.choice([1, 1, 1, 2, 5]) for word in words[:-1]) + words[-1]
        parts[at] = parts[at].replace(" %", "%") if hurry.random() < 0.5 else parts[at]
    return '"'.join(parts)


@dataclass
class _Pen:
    """Writes one script: knows what has been declared, which labels are still to come, and what the robot has."""

    draw: object
    profile: Profile
    coils: list[str] = field(init=False)
    names: dict[str, str] = field(default_factory=dict)  # what holds here: name -> coil, joint, share, number
    defs: dict[str, list[str]] = field(default_factory=dict)
    labels: list[str] = field(default_factory=list)  # further down
    plain: bool = False  # no label, let or call here

    def __post_init__(self):
        self.coils = list(self.profile.coil_labels)
        self.turns = bool(self.coils) and self.chance()
        if self.turns:  # only what every turn brings something to the place of
            self.coils = [label for label in self.coils if label[0] != "B" or "B100" in self.coils or len(label) == 1]
        self.joints = list(self.profile.joint_labels)

    def pick(self, options):
        return self.draw(st.sampled_from(options))

    def some(self, options, most=3):
        most = min(most, self.profile.supply.at_once_max)
        return self.draw(st.lists(st.sampled_from(options), min_size=1, max_size=most, unique=True))

    def whole(self, least, most):
        return self.draw(st.integers(least, most))

    def chance(self):
        return self.draw(st.booleans())

    def script(self):
        """Return the lines of a script."""
        head = [
            "gait 1",
            f"robot {self.profile.robot}",
            "param t0 = 300 ms [5 ms .. 1 s]",
            "param s0 = 12.5 % [1 % .. 40 %]",
        ]
        if self.profile.imu is not None:
            head.append("circle roll = A00m1 A10m1 A100 A101 A001 Am101 Am100 Am10m1")
        head += [f"guard {self.condition()}" for _ in range(self.whole(0, 2))]
        defs = [line for number in range(self.whole(0, 2)) for line in self.define(f"act{number}")]
        self.labels = [f"stop{number}" for number in range(self.whole(0, 2))]
        body = [f"move all to 0 {self.profile.unit} over {self.slow()}"] if self.joints else []
        while self.labels or len(body) < 3 or self.chance():
            if self.labels and self.chance():
                body += [f"label {self.labels.pop(0)}", *self.statement(0)]
            body += self.statement(0)
        return [*head, *defs, *body, *(self.on_fault() if self.chance() else [])]

    def define(self, name):
        """Return a def that takes coils or a joint, and a number, where the robot has them."""
        kind = "coil" if self.coils else "joint"
        inner = {f"{name}_c": kind, f"{name}_n": "number"}
        body = self.block(1, inner, plain=True)
        self.defs[name] = [kind, "number"]
        return [f"def {name}({', '.join(inner)}):", *body]

    def on_fault(self):
        return ["on fault:", *self.block(1, {})]

    def block(self, depth, names, plain=False, timed=True):
        """Return an indented block in which these names hold as well; it takes time."""
        outside, was = self.names, self.plain
        self.names, self.plain = {**outside, **names}, was or plain
        lines = [line for _ in range(self.whole(1, 2)) for line in self.statement(depth)]
        lines += [f"wait {self.time()}"] if timed else []
        self.names, self.plain = outside, was
        return [f"    {line}" for line in lines]

    def statement(self, depth):
        """Return the lines of one statement."""
        kinds = [self.order, self.order, self.wait, self.wait_until, self.note]
        kinds += [self.repeat, self.for_each, self.together] if depth < DEPTH_MAX else []
        kinds += [self.sym] * 2 if depth < DEPTH_MAX and self.turns else []
        kinds += [self.let] if self.profile.imu is not None and not self.plain else []
        kinds += [self.call] if self.defs and not self.plain else []
        return self.pick(kinds)(depth)

    def order(self, depth):
        if self.coils:
            return [self.pick([self.fire, self.fire, self.hold])(self.listed())]
        other = self.press if self.profile.press else self.orient if self.profile.orient else self.move
        return [self.pick([self.move, other])()]

    def fire(self, coils):
        ends = self.pick(["", " until 95 C", " ramp 5 ms", " overlap 5 ms", " overlap 0 s until 80.5 C ramp 3 ms"])
        return f"fire {coils} at {self.share()} for {self.time()}{ends}"

    def hold(self, coils):
        end = self.pick(["", " overlap 5 ms"])
        return f"hold {coils} at {self.whole(40, 90)} C with {self.share()} for {self.time()}{end}"

    def move(self, joint=None):
        joint = joint or self.pick([*self.joints, "all", *self.known("joint")])
        ends = [self.profile.servo.least_centi, self.profile.servo.most_centi]
        position = f"{self.whole(*ends) / 100} {self.profile.unit}"
        time = self.pick([self.time(), *[self.slow()] * 7])
        return f"move {joint} to {position} over {time}{self.pick(['', ' overlap 5 ms'])}"

    def slow(self):
        """Return a time in which a joint comes from anywhere to anywhere."""
        limits = self.profile.servo
        return f"{-(-1000 * (limits.most_centi - limits.least_centi) // limits.slew_centi_per_s)} ms + {self.time()}"

    def orient(self):
        return f"orient {self.whole(-12, 12)} deg for {self.time()}"

    def press(self):
        return f"press to {self.pick(['1.5 N', '500 mN', '2 * 1 N'])} over 5 ms for {self.time()}"

    def wait(self, depth):
        return [f"wait {self.time()}"]

    def wait_until(self, depth):
        labels = [] if self.plain else self.labels
        return [f"wait until {self.condition()} timeout {self.time()} else {self.pick(['abort', 'continue', *labels])}"]

    def note(self, depth):
        return [f'note "{self.pick(["warm # really", "", "for $t0 at $s0", *(f"${name}." for name in self.names)])}"']

    def repeat(self, depth):
        return [f"repeat {self.number()}:", *self.block(depth + 1, {})]

    def for_each(self, depth):
        """Return a block that runs for coils, joints, shares, or whole numbers."""
        name, kind = f"e{depth}", "coil" if self.coils else "joint"
        channels = self.coils or self.joints
        kind, items = self.pick([
            (kind, " ".join(self.some(channels))), (kind, ", ".join(self.some(channels))), (kind, "all"),
            ("share", "10 %, $s0, 2 * 7.5 %"), ("number", "1 .. 3"), ("number", f"{self.number()}, 2"),
        ])  # fmt: skip
        if items == "all" and len(channels) > 8:
            items = "axes"
        return [f"for {name} in {items}:", *self.block(depth + 1, {name: kind}, timed=self.chance())]

    def together(self, depth):
        """Return a block in which no channel is in two statements."""
        channels = self.some(self.coils or self.joints)
        rows = [self.fire(label) if self.coils else self.move(label) for label in channels]
        looped = [f"repeat 2:\n        {rows[0]}\n        wait 5 ms", *rows[1:]] if self.chance() else rows
        return ["together:", *"\n".join(f"    {row}" for row in [*looped, *self.wait(depth)]).split("\n")]

    def sym(self, depth):
        """Return a block in a body that is turned."""
        if self.coils[0] == "A":
            turns = self.pick(["45 deg", "-90 deg", "45 deg, 90 deg", "$s0 / 12.5 % * 45 deg"])
        else:
            turns = ", ".join(self.some(["x 90 deg", "y -180 deg", "z 3 * 90 deg"]))
        return [f"sym {turns}:", *self.block(depth + 1, {}, timed=self.chance())]

    def let(self, depth):
        return [
            f"let next = roll[down{self.pick(['', ' + 1', ' - 2'])}]",
            f"fire $next at {self.share()} for {self.time()}",
        ]

    def call(self, depth):
        name = self.pick(list(self.defs))
        return [f"{name}({self.listed() if self.coils else self.pick(self.joints)}, {self.number()})"]

    def listed(self):
        """Return one or more coils: by name, by group, or what a name stands for."""
        groups = [name for name, labels in self.profile.groups.items() if set(labels) <= set(self.coils)]
        lists = [" ".join(self.some(self.coils)) for _ in range(3)]
        return self.pick([*lists, *lists, *self.known("coil"), self.pick(groups or self.coils)])

    def condition(self):
        """Return something that this robot can be asked."""
        profile = self.profile
        asked = [
            "supply.current > 300 mA",
            "supply.voltage < 1.8 * 1000 mV",
            "board.temperature > 40 C",
            "time > 1.5 s",
        ]
        if self.coils:
            asked += [f"{self.pick(['any', 'all'])}.{self.pick(ASKED_OF_COILS)}"]
            asked += [f"{self.pick(['any', 'all'])} {self.listed()}.{self.pick(ASKED_OF_COILS)}"]
            asked += [f"{self.pick(self.coils)}.{self.pick(ASKED_OF_COILS)}"]
        if self.joints:
            position = {"deg": "angle > 5 deg", "mm": "depth < 2.5 mm"}[profile.unit]
            asked += [f"{self.pick(self.joints)}.{position}", f"any.{position}", "all.current > 50 mA"]
        asked += ["orientation < -2.5 deg"] if profile.camera else []
        asked += ["force > 0.5 N", "any.pressure > 5 kPa", "all C1 C2.pressure < 500 Pa"] if profile.load else []
        asked += ["roll > 30 deg", "pitch < -30 deg", f"down is {self.pick(self.coils)}"] if profile.imu else []
        return self.pick(asked)

    def known(self, kind):
        return [f"${name}" for name, known in self.names.items() if known == kind]

    def time(self):
        """Return a time of 5 ms or more."""
        ms = self.whole(5, 900)
        return self.pick([f"{ms} ms", f"{ms / 1000} s", "$t0", f"2 * ($t0 + {ms} ms)", f"$t0 / 2 + {ms} ms - -(5 ms)"])

    def share(self):
        tenths = self.whole(1, 400) / 10
        return self.pick([f"{tenths} %", "$s0", f"({tenths} % + $s0) / 2", *self.known("share")])

    def number(self):
        return self.pick([str(self.whole(1, 3)), "1 + 1", *self.known("number")])
