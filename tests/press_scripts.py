"""Random scripts for a press: moves, forces and waits for what it feels, alone and in blocks."""

from hypothesis import strategies as st

HOME = "move P to -2 mm over 1500 ms"

depths = st.integers(-20, 40).map(lambda quarters: f"{quarters / 4} mm")
forces = st.one_of(st.integers(0, 18).map("{} N".format), st.integers(0, 18_000).map("{} mN".format))
times = st.sampled_from([200, 303, 701, 1000, 1500, 2000]).map("{} ms".format)
moves = st.builds(
    "move {} to {} over {}{}".format,
    st.sampled_from(["P", "all", "axis"]), depths, times,
    st.sampled_from(["", "", " overlap 50 ms", " overlap 193 ms"]),
)  # fmt: skip
presses = st.builds(
    "press to {} over {} for {}{}".format,
    forces, st.sampled_from(["1 ms", "200 ms", "333 ms"]), st.sampled_from(["333 ms", "1 s", "4.9 s"]),
    st.sampled_from(["", "", " overlap 100 ms", " overlap 333 ms"]),
)  # fmt: skip
conditions = st.one_of(
    st.builds("force {} {}".format, st.sampled_from("<>"), st.integers(-2, 19).map("{} N".format)),
    st.builds("P.depth {} {}".format, st.sampled_from("<>"), depths),
    st.builds(
        "{}.pressure {} {} Pa".format,
        st.sampled_from(["C1", "any", "all C1 C6"]), st.sampled_from("<>"), st.integers(-5, 19_999),
    ),
    st.just("P.current > 50 mA"),
)  # fmt: skip
waits = st.one_of(
    st.integers(1, 900).map("wait {} ms".format),
    st.builds("wait until {} timeout {} else continue".format, conditions, times),
)


def blocks(inner):
    bodies = st.lists(inner, min_size=1, max_size=3).map(lambda lines: "\n".join(lines).replace("\n", "\n    "))
    return st.builds("repeat {}:\n    {}\n    wait 1 ms".format, st.integers(1, 4), bodies)


statements = st.recursive(moves | presses | waits, blocks, max_leaves=5)
bodies = st.lists(statements, min_size=1, max_size=6).map(lambda lines: "\n".join([HOME, *lines]))
