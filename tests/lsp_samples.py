"""A desk of the language server with a text on it, and a robot that is always there."""

from pathlib import Path

from host.lsp.desk import Desk
from tests.gait_scripts import round_robot

ROOT = Path(__file__).parents[1]
URI = (ROOT / "gaits" / "new.gait").as_uri()
HEAD = """gait 1
robot round
param duty = 60 % [5 % .. 90 %]  # how much
include "lib/lift.gait"
circle ring = A B C
# Both at once.
def both(a, b):
    fire $a $b at $duty for 600 ms
"""
FIRST_FREE = HEAD.count("\n") + 1


class Known:
    """Robots of which each is the same."""

    def __init__(self, profile):
        self.profile = profile

    def ask(self, address):
        return self.profile

    known = ask

    def names(self):
        return ["round"]

    def forget_lost(self):
        pass


def desk_with(text, profile=None, uri=URI):
    desk = Desk(Known(profile or round_robot()))
    path = desk.texts.put(uri, text, 1)
    desk.judge(path, desk.robots.profile)
    return desk, path
