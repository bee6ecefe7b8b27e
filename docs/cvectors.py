"""The C program that holds the header against the vectors: each vector becomes one call or one function of it."""

from pathlib import Path

from docs import vectors
from docs.definitions import Place, Row, rows

TEMPLATE = Path(__file__).parent / "templates" / "vectors.c"


def text() -> str:
    """Return the program."""
    table = {row.name: row for row in rows()}
    payloads = [vector for vector in vectors.payloads() if table[vector["message"]].fields]
    functions = [_payload(number, table[vector["message"]], vector) for number, vector in enumerate(payloads)]
    calls = [f"payload_{number}();" for number in range(len(payloads))]
    calls += [_frame(vector) for vector in vectors.whole_frames()]
    calls += [_stream(vector["wire"], [], 0, vector["why"]) for vector in vectors.refused()]
    for vector in vectors.streams():
        kinds = [table[name].number for name in vector["kinds"]]
        calls.append(_stream(vector["wire"], kinds, vector["stops"], vector["why"]))
    calls += [_segments(vector) for vector in vectors.segments() if vector["message"] != "sync"]  # which is no segment
    filled = {
        "DICTIONARY_CRC": str(vectors.DICTIONARY_CRC),
        "SESSION": str(vectors.SESSION),
        "MESSAGES": "\n".join(functions),
        "CALLS": "\n".join(f"    {call}" for call in [*calls, _key(vectors.key())]),
    }
    page = TEMPLATE.read_text(encoding="utf-8")
    for name, value in filled.items():
        page = page.replace(f"@{name}@", value)
    return page


def _payload(number: int, row: Row, vector: vectors.Json) -> str:
    """Return the function that packs and unpacks one payload."""
    values, what = vector["values"], f'"{row.name} {number}"'
    rest = row.fields[-1].name if row.is_open else ""
    lines = ["static held bytes, payload, packed;"] if rest else ["static held payload, packed;"]
    lines.append(f"softrig_{row.name} in, out;")
    lines += [f"in.{place.name} = {_literal(place, values[place.name])};" for place in row.fields if place.name != rest]
    if rest:
        lines.append(f'in.{rest} = view(hex(&bytes, "{values[rest]}"));')
    lines += [
        f'hex(&payload, "{vector["payload"]}");',
        f"check(same(packed.at, softrig_pack_{row.name}(&in, packed.at, HELD_MAX), &payload), {what});",
        f"check(softrig_unpack_{row.name}(&out, view(&payload)) == 0, {what});",
    ]
    lines += [f"check(out.{place.name} == in.{place.name}, {what});" for place in row.fields if place.name != rest]
    lines += [f"check(same_view(out.{rest}, &bytes), {what});"] if rest else []
    body = "\n".join(f"    {line}" for line in lines)
    return f"static void payload_{number}(void)\n{{\n{body}\n}}\n"


def _frame(vector: vectors.Json) -> str:
    numbers = ", ".join(str(vector[name]) for name in ("flags", "kind", "seq", "ack", "node"))
    texts = ", ".join(f'"{vector[name]}"' for name in ("key", "payload", "body", "wire"))
    told = f"{numbers}, {vector['seed']}u, {vector['number']}u, {int(vector['from_robot'])}, {texts}"
    return f'{{ static const whole told = {{{told}}}; frame(&told, "{vector["message"]}"); }}'


def _stream(wire: str, kinds: list[int], stops: int, why: str) -> str:
    return f'stream("{wire}", "{"".join(f"{kind} " for kind in kinds)}", {stops}, "{why}");'


def _segments(vector: vectors.Json) -> str:
    numbers = ", ".join(str(int(vector[name])) for name in ("kind", "robot", "host", "from_robot", "fd"))
    data = "".join(f"{len(each) // 2:02x}{each}" for each in vector["data"])
    return f'segments({vector["identifier"]}u, {numbers}, "{vector["body"]}", "{data}", "CAN {vector["message"]}");'


def _key(vector: vectors.Json) -> str:
    proof_a, proof_b = vector["proof"]
    return (
        f'key("{vector["pairing_key"]}", "{vector["hello"]}", {vector["nonce_a"]}u, {vector["nonce_b"]}u, '
        f'{vector["dictionary_crc"]}u, "{vector["session_key"]}", {proof_a}u, {proof_b}u, "{vector["body"]}", '
        f'{vector["number"]}u, "{vector["tag"]}");'
    )


def _literal(place: Place, value: int) -> str:
    if place.signed:
        return f"{value + 1} - 1" if value == -(1 << 31) else str(value)
    return f"{value}u"
