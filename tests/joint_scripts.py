"""Random scripts for joints: moves, orients and waits for them, alone and in blocks, for the robot of two joints."""

from hypothesis import strategies as st

HOME = "move all to 0 deg over 1 s"

names = st.sampled_from(["R", "L", "R L", "both"])
angles = st.integers(-30, 30).map("{} deg".format)
times = st.sampled_from([100, 300, 403, 701, 1000]).map("{} ms".format)
moves = st.builds(
    "move {} to {} over {}{}".format,
    names, angles, times, st.sampled_from(["", "", " overlap 50 ms", " overlap 93 ms"]),
)  # fmt: skip
orients = st.builds(
    "orient {} deg for {}{}".format, st.integers(-12, 12), times, st.sampled_from(["", " overlap 80 ms"])
)
conditions = st.one_of(
    st.builds("{}.angle {} {}".format, st.sampled_from(["R", "any", "all R L"]), st.sampled_from("<>"), angles),
    st.builds("orientation {} {}".format, st.sampled_from("<>"), angles),
    st.just("any both.current > 50 mA"),
)
waits = st.one_of(
    st.integers(1, 900).map("wait {} ms".format),
    st.builds("wait until {} timeout {} else continue".format, conditions, times),
)
pairs = st.builds("together:\n    move R to {} over {}\n    move L to {} over {}".format, angles, times, angles, times)


def blocks(inner):
    bodies = st.lists(inner, min_size=1, max_size=3).map(lambda lines: "\n".join(lines).replace("\n", "\n    "))
    return st.builds("repeat {}:\n    {}\n    wait 1 ms".format, st.integers(1, 4), bodies)


statements = st.recursive(moves | orients | waits | pairs, blocks, max_leaves=5)
bodies = st.lists(statements, min_size=1, max_size=6).map(lambda lines: "\n".join([HOME, *lines]))
