/* vectors.c: holds softrig.h against every vector of docs/vectors.json.
 *
 * Made by docs/generate.py: `make docs`. Build and run: cc -std=c99 -Wall -Wextra -Werror -pedantic vectors.c && ./a.out
 */
#include <stdio.h>

#include "softrig.h"

#define HELD_MAX 4096

static int checks, failures;

static void check(int holds, const char *what)
{
    checks++;
    if (!holds) {
        failures++;
        printf("failed: %s\n", what);
    }
}

typedef struct held {
    uint8_t at[HELD_MAX];
    size_t size;
} held;

/* Read hexadecimal digits into `into`, which is handed back. */
static held *hex(held *into, const char *digits)
{
    unsigned byte;
    into->size = 0;
    while (*digits && into->size < HELD_MAX && sscanf(digits, "%2x", &byte) == 1) {
        into->at[into->size++] = (uint8_t)byte;
        digits += 2;
    }
    return into;
}

static softrig_bytes view(const held *bytes)
{
    softrig_bytes seen;
    seen.at = bytes->at;
    seen.size = bytes->size;
    return seen;
}

static int same(const uint8_t *at, int size, const held *expected)
{
    return size == (int)expected->size && memcmp(at, expected->at, expected->size) == 0;
}

static int same_view(softrig_bytes seen, const held *expected)
{
    return same(seen.at, (int)seen.size, expected);
}

typedef struct whole {
    unsigned flags, kind, seq, ack, node;
    uint32_t seed, number;
    int from_robot;
    const char *key, *payload, *body, *wire;
} whole;

/* A frame is sealed, stuffed, fed and unsealed, each time to what the vector says. */
static void frame(const whole *told, const char *what)
{
    static held payload, key, body, wire, got;
    static softrig_decoder decoder;
    softrig_frame out = {0, 0, 0, 0, 0, {NULL, 0}}, in;
    const uint8_t *secret = hex(&key, told->key)->size ? key.at : NULL;
    int size = 0;
    size_t i;
    in.flags = (uint8_t)(told->flags & SOFTRIG_RELIABLE);
    in.kind = (uint8_t)told->kind;
    in.seq = (uint8_t)told->seq;
    in.ack = (uint8_t)told->ack;
    in.node = (uint8_t)told->node;
    in.payload = view(hex(&payload, told->payload));
    hex(&body, told->body);
    hex(&wire, told->wire);
    check(same(got.at, softrig_seal(&in, told->seed, secret, told->from_robot, told->number, got.at, HELD_MAX), &body), what);
    check(same(got.at, softrig_stuff(body.at, body.size, got.at, HELD_MAX), &wire), what);
    for (i = 0; i < wire.size; i++)
        size = softrig_feed(&decoder, wire.at[i]);
    check(same(decoder.body, size, &body), what);
    check(softrig_unseal(body.at, body.size, told->seed, told->seed, &out) == 0, what);
    check(out.flags == told->flags && out.kind == in.kind && out.seq == in.seq && out.ack == in.ack, what);
    check(out.node == in.node && same_view(out.payload, &payload), what);
    if (secret) {
        check(softrig_verified(body.at, body.size, secret, told->from_robot, told->number) == 0, what);
        check(softrig_verified(body.at, body.size, secret, !told->from_robot, told->number) != 0, what);
        check(softrig_verified(body.at, body.size, secret, told->from_robot, told->number + 256) != 0, what);
    }
}

/* What arrives holds these kinds, as a string of their numbers, and so many stops. */
static void stream(const char *digits, const char *kinds, unsigned stops, const char *what)
{
    static held wire;
    softrig_decoder decoder;
    softrig_frame found;
    char seen[256] = "";
    size_t i;
    memset(&decoder, 0, sizeof decoder);
    hex(&wire, digits);
    for (i = 0; i < wire.size; i++) {
        int size = softrig_feed(&decoder, wire.at[i]);
        stops -= (unsigned)softrig_is_stop(&decoder, wire.at[i]);
        if (size > 0 && softrig_unseal(decoder.body, (size_t)size, 3237998146u,
                                       softrig_session_seed(3237998146u, 305419896u), &found) == 0)
            sprintf(seen + strlen(seen), "%u ", (unsigned)found.kind);
    }
    check(strcmp(seen, kinds) == 0 && stops == 0, what);
}

static void key(const char *pairing_key, const char *hello, uint32_t nonce_a, uint32_t nonce_b, uint32_t dictionary_crc,
                const char *session_key, uint32_t proof_a, uint32_t proof_b, const char *body, uint32_t number,
                const char *tag)
{
    static held pairing, said, expected, covered;
    uint8_t made[32];
    uint32_t a, b;
    hex(&pairing, pairing_key);
    hex(&said, hello);
    check(softrig_session_key(view(&pairing), view(&said), nonce_a, nonce_b, dictionary_crc, made) == 0, "session key");
    check(same(made, 32, hex(&expected, session_key)), "session key");
    check(softrig_proof(made, &a, &b) == 0 && a == proof_a && b == proof_b, "proof");
    hex(&covered, body);
    hex(&expected, tag);
    check(softrig_tag(made, 0, number, view(&covered), covered.at + HELD_MAX / 2) == 0, "tag");
    check(memcmp(covered.at + HELD_MAX / 2, expected.at, SOFTRIG_TAG_BYTES) == 0, "tag");
}

/* A body becomes these CAN frames, and they become the body again; the data follow one another, each after its size. */
static void segments(uint32_t identifier, unsigned kind, unsigned robot, unsigned host, int from_robot, int fd,
                     const char *body_digits, const char *data_digits, const char *what)
{
    static held body, data;
    static softrig_can_joiner joiner;
    uint8_t cut[SOFTRIG_CAN_FD];
    size_t at = 0, from = 0, mtu = fd ? SOFTRIG_CAN_FD : SOFTRIG_CAN_CLASSIC;
    unsigned counter = 0;
    int size, joined = 0;
    hex(&body, body_digits);
    hex(&data, data_digits);
    check(softrig_can_identifier((uint8_t)kind, robot, host, from_robot) == identifier, what);
    while ((size = softrig_can_segment(body.at, body.size, mtu, &at, &counter, cut)) > 0) {
        check(from < data.size && data.at[from] == size && memcmp(cut, data.at + from + 1, (size_t)size) == 0, what);
        from += 1 + (size_t)size;
        joined = softrig_can_join(&joiner, identifier, cut, (size_t)size, fd);
    }
    check(from == data.size && same(joiner.body, joined, &body), what);
}

static void payload_0(void)
{
    static held payload, packed;
    softrig_hello in, out;
    in.version = 0u;
    in.session = 0u;
    in.attach = 0u;
    in.nonce_a = 0u;
    in.nonce_b = 0u;
    hex(&payload, "0000000000000000000000000000000000");
    check(same(packed.at, softrig_pack_hello(&in, packed.at, HELD_MAX), &payload), "hello 0");
    check(softrig_unpack_hello(&out, view(&payload)) == 0, "hello 0");
    check(out.version == in.version, "hello 0");
    check(out.session == in.session, "hello 0");
    check(out.attach == in.attach, "hello 0");
    check(out.nonce_a == in.nonce_a, "hello 0");
    check(out.nonce_b == in.nonce_b, "hello 0");
}

static void payload_1(void)
{
    static held payload, packed;
    softrig_hello in, out;
    in.version = 255u;
    in.session = 4294967295u;
    in.attach = 4294967295u;
    in.nonce_a = 4294967295u;
    in.nonce_b = 4294967295u;
    hex(&payload, "ffffffffffffffffffffffffffffffffff");
    check(same(packed.at, softrig_pack_hello(&in, packed.at, HELD_MAX), &payload), "hello 1");
    check(softrig_unpack_hello(&out, view(&payload)) == 0, "hello 1");
    check(out.version == in.version, "hello 1");
    check(out.session == in.session, "hello 1");
    check(out.attach == in.attach, "hello 1");
    check(out.nonce_a == in.nonce_a, "hello 1");
    check(out.nonce_b == in.nonce_b, "hello 1");
}

static void payload_2(void)
{
    static held payload, packed;
    softrig_hello in, out;
    in.version = 35u;
    in.session = 3874979985u;
    in.attach = 3454992675u;
    in.nonce_a = 3168727058u;
    in.nonce_b = 2042486820u;
    hex(&payload, "239180f7e62301efcd12f0debc24e0bd79");
    check(same(packed.at, softrig_pack_hello(&in, packed.at, HELD_MAX), &payload), "hello 2");
    check(softrig_unpack_hello(&out, view(&payload)) == 0, "hello 2");
    check(out.version == in.version, "hello 2");
    check(out.session == in.session, "hello 2");
    check(out.attach == in.attach, "hello 2");
    check(out.nonce_a == in.nonce_a, "hello 2");
    check(out.nonce_b == in.nonce_b, "hello 2");
}

static void payload_3(void)
{
    static held bytes, payload, packed;
    softrig_identity in, out;
    in.session = 0u;
    in.boot = 0u;
    in.uptime_ms = 0u;
    in.dictionary_crc = 0u;
    in.dictionary_bytes = 0u;
    in.version = 0u;
    in.state = 0u;
    in.role = 0u;
    in.node = 0u;
    in.secured = 0u;
    in.slots = 0u;
    in.bytes = 0u;
    in.byte_ns = 0u;
    in.holder = 0u;
    in.step = 0u;
    in.nonce_a = 0u;
    in.nonce_b = 0u;
    in.proof_a = 0u;
    in.proof_b = 0u;
    in.firmware = view(hex(&bytes, ""));
    hex(&payload, "00000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000");
    check(same(packed.at, softrig_pack_identity(&in, packed.at, HELD_MAX), &payload), "identity 3");
    check(softrig_unpack_identity(&out, view(&payload)) == 0, "identity 3");
    check(out.session == in.session, "identity 3");
    check(out.boot == in.boot, "identity 3");
    check(out.uptime_ms == in.uptime_ms, "identity 3");
    check(out.dictionary_crc == in.dictionary_crc, "identity 3");
    check(out.dictionary_bytes == in.dictionary_bytes, "identity 3");
    check(out.version == in.version, "identity 3");
    check(out.state == in.state, "identity 3");
    check(out.role == in.role, "identity 3");
    check(out.node == in.node, "identity 3");
    check(out.secured == in.secured, "identity 3");
    check(out.slots == in.slots, "identity 3");
    check(out.bytes == in.bytes, "identity 3");
    check(out.byte_ns == in.byte_ns, "identity 3");
    check(out.holder == in.holder, "identity 3");
    check(out.step == in.step, "identity 3");
    check(out.nonce_a == in.nonce_a, "identity 3");
    check(out.nonce_b == in.nonce_b, "identity 3");
    check(out.proof_a == in.proof_a, "identity 3");
    check(out.proof_b == in.proof_b, "identity 3");
    check(same_view(out.firmware, &bytes), "identity 3");
}

static void payload_4(void)
{
    static held bytes, payload, packed;
    softrig_identity in, out;
    in.session = 4294967295u;
    in.boot = 4294967295u;
    in.uptime_ms = 4294967295u;
    in.dictionary_crc = 4294967295u;
    in.dictionary_bytes = 65535u;
    in.version = 255u;
    in.state = 255u;
    in.role = 255u;
    in.node = 255u;
    in.secured = 255u;
    in.slots = 32u;
    in.bytes = 65535u;
    in.byte_ns = 4294967295u;
    in.holder = 4294967295u;
    in.step = 65535u;
    in.nonce_a = 4294967295u;
    in.nonce_b = 4294967295u;
    in.proof_a = 4294967295u;
    in.proof_b = 4294967295u;
    in.firmware = view(hex(&bytes, "ffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff"));
    hex(&payload, "ffffffffffffffffffffffffffffffffffffffffffffff20ffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff");
    check(same(packed.at, softrig_pack_identity(&in, packed.at, HELD_MAX), &payload), "identity 4");
    check(softrig_unpack_identity(&out, view(&payload)) == 0, "identity 4");
    check(out.session == in.session, "identity 4");
    check(out.boot == in.boot, "identity 4");
    check(out.uptime_ms == in.uptime_ms, "identity 4");
    check(out.dictionary_crc == in.dictionary_crc, "identity 4");
    check(out.dictionary_bytes == in.dictionary_bytes, "identity 4");
    check(out.version == in.version, "identity 4");
    check(out.state == in.state, "identity 4");
    check(out.role == in.role, "identity 4");
    check(out.node == in.node, "identity 4");
    check(out.secured == in.secured, "identity 4");
    check(out.slots == in.slots, "identity 4");
    check(out.bytes == in.bytes, "identity 4");
    check(out.byte_ns == in.byte_ns, "identity 4");
    check(out.holder == in.holder, "identity 4");
    check(out.step == in.step, "identity 4");
    check(out.nonce_a == in.nonce_a, "identity 4");
    check(out.nonce_b == in.nonce_b, "identity 4");
    check(out.proof_a == in.proof_a, "identity 4");
    check(out.proof_b == in.proof_b, "identity 4");
    check(same_view(out.firmware, &bytes), "identity 4");
}

static void payload_5(void)
{
    static held bytes, payload, packed;
    softrig_identity in, out;
    in.session = 3454992675u;
    in.boot = 3168727058u;
    in.uptime_ms = 2042486820u;
    in.dictionary_crc = 4084973640u;
    in.dictionary_bytes = 32913u;
    in.version = 36u;
    in.state = 18u;
    in.role = 35u;
    in.node = 145u;
    in.secured = 72u;
    in.slots = 15u;
    in.bytes = 61458u;
    in.byte_ns = 3874979985u;
    in.holder = 3454992675u;
    in.step = 61458u;
    in.nonce_a = 3874979985u;
    in.nonce_b = 3454992675u;
    in.proof_a = 3168727058u;
    in.proof_b = 2042486820u;
    in.firmware = view(hex(&bytes, "00017f80ff0053544f5000"));
    hex(&payload, "2301efcd12f0debc24e0bd7948c07bf3918024122391480f12f09180f7e62301efcd12f09180f7e62301efcd12f0debc24e0bd7900017f80ff0053544f5000");
    check(same(packed.at, softrig_pack_identity(&in, packed.at, HELD_MAX), &payload), "identity 5");
    check(softrig_unpack_identity(&out, view(&payload)) == 0, "identity 5");
    check(out.session == in.session, "identity 5");
    check(out.boot == in.boot, "identity 5");
    check(out.uptime_ms == in.uptime_ms, "identity 5");
    check(out.dictionary_crc == in.dictionary_crc, "identity 5");
    check(out.dictionary_bytes == in.dictionary_bytes, "identity 5");
    check(out.version == in.version, "identity 5");
    check(out.state == in.state, "identity 5");
    check(out.role == in.role, "identity 5");
    check(out.node == in.node, "identity 5");
    check(out.secured == in.secured, "identity 5");
    check(out.slots == in.slots, "identity 5");
    check(out.bytes == in.bytes, "identity 5");
    check(out.byte_ns == in.byte_ns, "identity 5");
    check(out.holder == in.holder, "identity 5");
    check(out.step == in.step, "identity 5");
    check(out.nonce_a == in.nonce_a, "identity 5");
    check(out.nonce_b == in.nonce_b, "identity 5");
    check(out.proof_a == in.proof_a, "identity 5");
    check(out.proof_b == in.proof_b, "identity 5");
    check(same_view(out.firmware, &bytes), "identity 5");
}

static void payload_6(void)
{
    static held payload, packed;
    softrig_dictionary in, out;
    in.part = 0u;
    in.offset = 0u;
    in.count = 0u;
    hex(&payload, "00000000");
    check(same(packed.at, softrig_pack_dictionary(&in, packed.at, HELD_MAX), &payload), "dictionary 6");
    check(softrig_unpack_dictionary(&out, view(&payload)) == 0, "dictionary 6");
    check(out.part == in.part, "dictionary 6");
    check(out.offset == in.offset, "dictionary 6");
    check(out.count == in.count, "dictionary 6");
}

static void payload_7(void)
{
    static held payload, packed;
    softrig_dictionary in, out;
    in.part = 255u;
    in.offset = 65535u;
    in.count = 255u;
    hex(&payload, "ffffffff");
    check(same(packed.at, softrig_pack_dictionary(&in, packed.at, HELD_MAX), &payload), "dictionary 7");
    check(softrig_unpack_dictionary(&out, view(&payload)) == 0, "dictionary 7");
    check(out.part == in.part, "dictionary 7");
    check(out.offset == in.offset, "dictionary 7");
    check(out.count == in.count, "dictionary 7");
}

static void payload_8(void)
{
    static held payload, packed;
    softrig_dictionary in, out;
    in.part = 35u;
    in.offset = 32913u;
    in.count = 36u;
    hex(&payload, "23918024");
    check(same(packed.at, softrig_pack_dictionary(&in, packed.at, HELD_MAX), &payload), "dictionary 8");
    check(softrig_unpack_dictionary(&out, view(&payload)) == 0, "dictionary 8");
    check(out.part == in.part, "dictionary 8");
    check(out.offset == in.offset, "dictionary 8");
    check(out.count == in.count, "dictionary 8");
}

static void payload_9(void)
{
    static held bytes, payload, packed;
    softrig_dictionary_page in, out;
    in.part = 0u;
    in.offset = 0u;
    in.text = view(hex(&bytes, ""));
    hex(&payload, "000000");
    check(same(packed.at, softrig_pack_dictionary_page(&in, packed.at, HELD_MAX), &payload), "dictionary_page 9");
    check(softrig_unpack_dictionary_page(&out, view(&payload)) == 0, "dictionary_page 9");
    check(out.part == in.part, "dictionary_page 9");
    check(out.offset == in.offset, "dictionary_page 9");
    check(same_view(out.text, &bytes), "dictionary_page 9");
}

static void payload_10(void)
{
    static held bytes, payload, packed;
    softrig_dictionary_page in, out;
    in.part = 255u;
    in.offset = 65535u;
    in.text = view(hex(&bytes, "ffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff"));
    hex(&payload, "ffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff");
    check(same(packed.at, softrig_pack_dictionary_page(&in, packed.at, HELD_MAX), &payload), "dictionary_page 10");
    check(softrig_unpack_dictionary_page(&out, view(&payload)) == 0, "dictionary_page 10");
    check(out.part == in.part, "dictionary_page 10");
    check(out.offset == in.offset, "dictionary_page 10");
    check(same_view(out.text, &bytes), "dictionary_page 10");
}

static void payload_11(void)
{
    static held bytes, payload, packed;
    softrig_dictionary_page in, out;
    in.part = 35u;
    in.offset = 32913u;
    in.text = view(hex(&bytes, "00017f80ff0053544f5000"));
    hex(&payload, "23918000017f80ff0053544f5000");
    check(same(packed.at, softrig_pack_dictionary_page(&in, packed.at, HELD_MAX), &payload), "dictionary_page 11");
    check(softrig_unpack_dictionary_page(&out, view(&payload)) == 0, "dictionary_page 11");
    check(out.part == in.part, "dictionary_page 11");
    check(out.offset == in.offset, "dictionary_page 11");
    check(same_view(out.text, &bytes), "dictionary_page 11");
}

static void payload_12(void)
{
    static held payload, packed;
    softrig_stopped in, out;
    in.state = 0u;
    in.code = 0u;
    in.coils = 0u;
    in.now_ms = 0u;
    hex(&payload, "0000000000000000000000");
    check(same(packed.at, softrig_pack_stopped(&in, packed.at, HELD_MAX), &payload), "stopped 12");
    check(softrig_unpack_stopped(&out, view(&payload)) == 0, "stopped 12");
    check(out.state == in.state, "stopped 12");
    check(out.code == in.code, "stopped 12");
    check(out.coils == in.coils, "stopped 12");
    check(out.now_ms == in.now_ms, "stopped 12");
}

static void payload_13(void)
{
    static held payload, packed;
    softrig_stopped in, out;
    in.state = 255u;
    in.code = 65535u;
    in.coils = 4294967295u;
    in.now_ms = 4294967295u;
    hex(&payload, "ffffffffffffffffffffff");
    check(same(packed.at, softrig_pack_stopped(&in, packed.at, HELD_MAX), &payload), "stopped 13");
    check(softrig_unpack_stopped(&out, view(&payload)) == 0, "stopped 13");
    check(out.state == in.state, "stopped 13");
    check(out.code == in.code, "stopped 13");
    check(out.coils == in.coils, "stopped 13");
    check(out.now_ms == in.now_ms, "stopped 13");
}

static void payload_14(void)
{
    static held payload, packed;
    softrig_stopped in, out;
    in.state = 35u;
    in.code = 32913u;
    in.coils = 2042486820u;
    in.now_ms = 4084973640u;
    hex(&payload, "23918024e0bd7948c07bf3");
    check(same(packed.at, softrig_pack_stopped(&in, packed.at, HELD_MAX), &payload), "stopped 14");
    check(softrig_unpack_stopped(&out, view(&payload)) == 0, "stopped 14");
    check(out.state == in.state, "stopped 14");
    check(out.code == in.code, "stopped 14");
    check(out.coils == in.coils, "stopped 14");
    check(out.now_ms == in.now_ms, "stopped 14");
}

static void payload_15(void)
{
    static held payload, packed;
    softrig_nak in, out;
    in.kind = 0u;
    in.code = 0u;
    in.version = 0u;
    hex(&payload, "00000000");
    check(same(packed.at, softrig_pack_nak(&in, packed.at, HELD_MAX), &payload), "nak 15");
    check(softrig_unpack_nak(&out, view(&payload)) == 0, "nak 15");
    check(out.kind == in.kind, "nak 15");
    check(out.code == in.code, "nak 15");
    check(out.version == in.version, "nak 15");
}

static void payload_16(void)
{
    static held payload, packed;
    softrig_nak in, out;
    in.kind = 255u;
    in.code = 65535u;
    in.version = 255u;
    hex(&payload, "ffffffff");
    check(same(packed.at, softrig_pack_nak(&in, packed.at, HELD_MAX), &payload), "nak 16");
    check(softrig_unpack_nak(&out, view(&payload)) == 0, "nak 16");
    check(out.kind == in.kind, "nak 16");
    check(out.code == in.code, "nak 16");
    check(out.version == in.version, "nak 16");
}

static void payload_17(void)
{
    static held payload, packed;
    softrig_nak in, out;
    in.kind = 35u;
    in.code = 32913u;
    in.version = 36u;
    hex(&payload, "23918024");
    check(same(packed.at, softrig_pack_nak(&in, packed.at, HELD_MAX), &payload), "nak 17");
    check(softrig_unpack_nak(&out, view(&payload)) == 0, "nak 17");
    check(out.kind == in.kind, "nak 17");
    check(out.code == in.code, "nak 17");
    check(out.version == in.version, "nak 17");
}

static void payload_18(void)
{
    static held payload, packed;
    softrig_watch in, out;
    in.period_ms = 0u;
    hex(&payload, "0000");
    check(same(packed.at, softrig_pack_watch(&in, packed.at, HELD_MAX), &payload), "watch 18");
    check(softrig_unpack_watch(&out, view(&payload)) == 0, "watch 18");
    check(out.period_ms == in.period_ms, "watch 18");
}

static void payload_19(void)
{
    static held payload, packed;
    softrig_watch in, out;
    in.period_ms = 65535u;
    hex(&payload, "ffff");
    check(same(packed.at, softrig_pack_watch(&in, packed.at, HELD_MAX), &payload), "watch 19");
    check(softrig_unpack_watch(&out, view(&payload)) == 0, "watch 19");
    check(out.period_ms == in.period_ms, "watch 19");
}

static void payload_20(void)
{
    static held payload, packed;
    softrig_watch in, out;
    in.period_ms = 291u;
    hex(&payload, "2301");
    check(same(packed.at, softrig_pack_watch(&in, packed.at, HELD_MAX), &payload), "watch 20");
    check(softrig_unpack_watch(&out, view(&payload)) == 0, "watch 20");
    check(out.period_ms == in.period_ms, "watch 20");
}

static void payload_21(void)
{
    static held payload, packed;
    softrig_alive in, out;
    in.have = 0u;
    in.slots = 0u;
    in.bytes = 0u;
    hex(&payload, "00000000000000");
    check(same(packed.at, softrig_pack_alive(&in, packed.at, HELD_MAX), &payload), "alive 21");
    check(softrig_unpack_alive(&out, view(&payload)) == 0, "alive 21");
    check(out.have == in.have, "alive 21");
    check(out.slots == in.slots, "alive 21");
    check(out.bytes == in.bytes, "alive 21");
}

static void payload_22(void)
{
    static held payload, packed;
    softrig_alive in, out;
    in.have = 4294967295u;
    in.slots = 32u;
    in.bytes = 65535u;
    hex(&payload, "ffffffff20ffff");
    check(same(packed.at, softrig_pack_alive(&in, packed.at, HELD_MAX), &payload), "alive 22");
    check(softrig_unpack_alive(&out, view(&payload)) == 0, "alive 22");
    check(out.have == in.have, "alive 22");
    check(out.slots == in.slots, "alive 22");
    check(out.bytes == in.bytes, "alive 22");
}

static void payload_23(void)
{
    static held payload, packed;
    softrig_alive in, out;
    in.have = 3454992675u;
    in.slots = 24u;
    in.bytes = 291u;
    hex(&payload, "2301efcd182301");
    check(same(packed.at, softrig_pack_alive(&in, packed.at, HELD_MAX), &payload), "alive 23");
    check(softrig_unpack_alive(&out, view(&payload)) == 0, "alive 23");
    check(out.have == in.have, "alive 23");
    check(out.slots == in.slots, "alive 23");
    check(out.bytes == in.bytes, "alive 23");
}

static void payload_24(void)
{
    static held payload, packed;
    softrig_arm in, out;
    in.session = 0u;
    in.lease_ms = 0u;
    in.without = 0u;
    hex(&payload, "00000000000000000000");
    check(same(packed.at, softrig_pack_arm(&in, packed.at, HELD_MAX), &payload), "arm 24");
    check(softrig_unpack_arm(&out, view(&payload)) == 0, "arm 24");
    check(out.session == in.session, "arm 24");
    check(out.lease_ms == in.lease_ms, "arm 24");
    check(out.without == in.without, "arm 24");
}

static void payload_25(void)
{
    static held payload, packed;
    softrig_arm in, out;
    in.session = 4294967295u;
    in.lease_ms = 65535u;
    in.without = 4294967295u;
    hex(&payload, "ffffffffffffffffffff");
    check(same(packed.at, softrig_pack_arm(&in, packed.at, HELD_MAX), &payload), "arm 25");
    check(softrig_unpack_arm(&out, view(&payload)) == 0, "arm 25");
    check(out.session == in.session, "arm 25");
    check(out.lease_ms == in.lease_ms, "arm 25");
    check(out.without == in.without, "arm 25");
}

static void payload_26(void)
{
    static held payload, packed;
    softrig_arm in, out;
    in.session = 3454992675u;
    in.lease_ms = 61458u;
    in.without = 3874979985u;
    hex(&payload, "2301efcd12f09180f7e6");
    check(same(packed.at, softrig_pack_arm(&in, packed.at, HELD_MAX), &payload), "arm 26");
    check(softrig_unpack_arm(&out, view(&payload)) == 0, "arm 26");
    check(out.session == in.session, "arm 26");
    check(out.lease_ms == in.lease_ms, "arm 26");
    check(out.without == in.without, "arm 26");
}

static void payload_27(void)
{
    static held payload, packed;
    softrig_fire in, out;
    in.coils = 0u;
    in.duty_permille = 0u;
    in.hold_ms = 0u;
    hex(&payload, "0000000000000000");
    check(same(packed.at, softrig_pack_fire(&in, packed.at, HELD_MAX), &payload), "fire 27");
    check(softrig_unpack_fire(&out, view(&payload)) == 0, "fire 27");
    check(out.coils == in.coils, "fire 27");
    check(out.duty_permille == in.duty_permille, "fire 27");
    check(out.hold_ms == in.hold_ms, "fire 27");
}

static void payload_28(void)
{
    static held payload, packed;
    softrig_fire in, out;
    in.coils = 4294967295u;
    in.duty_permille = 1000u;
    in.hold_ms = 65535u;
    hex(&payload, "ffffffffe803ffff");
    check(same(packed.at, softrig_pack_fire(&in, packed.at, HELD_MAX), &payload), "fire 28");
    check(softrig_unpack_fire(&out, view(&payload)) == 0, "fire 28");
    check(out.coils == in.coils, "fire 28");
    check(out.duty_permille == in.duty_permille, "fire 28");
    check(out.hold_ms == in.hold_ms, "fire 28");
}

static void payload_29(void)
{
    static held payload, packed;
    softrig_fire in, out;
    in.coils = 3454992675u;
    in.duty_permille = 882u;
    in.hold_ms = 32913u;
    hex(&payload, "2301efcd72039180");
    check(same(packed.at, softrig_pack_fire(&in, packed.at, HELD_MAX), &payload), "fire 29");
    check(softrig_unpack_fire(&out, view(&payload)) == 0, "fire 29");
    check(out.coils == in.coils, "fire 29");
    check(out.duty_permille == in.duty_permille, "fire 29");
    check(out.hold_ms == in.hold_ms, "fire 29");
}

static void payload_30(void)
{
    static held bytes, payload, packed;
    softrig_subscribe in, out;
    in.slot = 0u;
    in.period_ms = 0u;
    in.on_change = 0u;
    in.variables = view(hex(&bytes, ""));
    hex(&payload, "00000000");
    check(same(packed.at, softrig_pack_subscribe(&in, packed.at, HELD_MAX), &payload), "subscribe 30");
    check(softrig_unpack_subscribe(&out, view(&payload)) == 0, "subscribe 30");
    check(out.slot == in.slot, "subscribe 30");
    check(out.period_ms == in.period_ms, "subscribe 30");
    check(out.on_change == in.on_change, "subscribe 30");
    check(same_view(out.variables, &bytes), "subscribe 30");
}

static void payload_31(void)
{
    static held bytes, payload, packed;
    softrig_subscribe in, out;
    in.slot = 3u;
    in.period_ms = 65535u;
    in.on_change = 1u;
    in.variables = view(hex(&bytes, "ffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff"));
    hex(&payload, "03ffff01ffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff");
    check(same(packed.at, softrig_pack_subscribe(&in, packed.at, HELD_MAX), &payload), "subscribe 31");
    check(softrig_unpack_subscribe(&out, view(&payload)) == 0, "subscribe 31");
    check(out.slot == in.slot, "subscribe 31");
    check(out.period_ms == in.period_ms, "subscribe 31");
    check(out.on_change == in.on_change, "subscribe 31");
    check(same_view(out.variables, &bytes), "subscribe 31");
}

static void payload_32(void)
{
    static held bytes, payload, packed;
    softrig_subscribe in, out;
    in.slot = 3u;
    in.period_ms = 32913u;
    in.on_change = 0u;
    in.variables = view(hex(&bytes, "00017f80ff0053544f5000"));
    hex(&payload, "0391800000017f80ff0053544f5000");
    check(same(packed.at, softrig_pack_subscribe(&in, packed.at, HELD_MAX), &payload), "subscribe 32");
    check(softrig_unpack_subscribe(&out, view(&payload)) == 0, "subscribe 32");
    check(out.slot == in.slot, "subscribe 32");
    check(out.period_ms == in.period_ms, "subscribe 32");
    check(out.on_change == in.on_change, "subscribe 32");
    check(same_view(out.variables, &bytes), "subscribe 32");
}

static void payload_33(void)
{
    static held payload, packed;
    softrig_faults_request in, out;
    in.skip = 0u;
    hex(&payload, "00");
    check(same(packed.at, softrig_pack_faults_request(&in, packed.at, HELD_MAX), &payload), "faults_request 33");
    check(softrig_unpack_faults_request(&out, view(&payload)) == 0, "faults_request 33");
    check(out.skip == in.skip, "faults_request 33");
}

static void payload_34(void)
{
    static held payload, packed;
    softrig_faults_request in, out;
    in.skip = 255u;
    hex(&payload, "ff");
    check(same(packed.at, softrig_pack_faults_request(&in, packed.at, HELD_MAX), &payload), "faults_request 34");
    check(softrig_unpack_faults_request(&out, view(&payload)) == 0, "faults_request 34");
    check(out.skip == in.skip, "faults_request 34");
}

static void payload_35(void)
{
    static held payload, packed;
    softrig_faults_request in, out;
    in.skip = 35u;
    hex(&payload, "23");
    check(same(packed.at, softrig_pack_faults_request(&in, packed.at, HELD_MAX), &payload), "faults_request 35");
    check(softrig_unpack_faults_request(&out, view(&payload)) == 0, "faults_request 35");
    check(out.skip == in.skip, "faults_request 35");
}

static void payload_36(void)
{
    static held payload, packed;
    softrig_set in, out;
    in.setting = 0u;
    in.channel = 0u;
    in.value = -2147483647 - 1;
    hex(&payload, "000000000080");
    check(same(packed.at, softrig_pack_set(&in, packed.at, HELD_MAX), &payload), "set 36");
    check(softrig_unpack_set(&out, view(&payload)) == 0, "set 36");
    check(out.setting == in.setting, "set 36");
    check(out.channel == in.channel, "set 36");
    check(out.value == in.value, "set 36");
}

static void payload_37(void)
{
    static held payload, packed;
    softrig_set in, out;
    in.setting = 255u;
    in.channel = 255u;
    in.value = 2147483647;
    hex(&payload, "ffffffffff7f");
    check(same(packed.at, softrig_pack_set(&in, packed.at, HELD_MAX), &payload), "set 37");
    check(softrig_unpack_set(&out, view(&payload)) == 0, "set 37");
    check(out.setting == in.setting, "set 37");
    check(out.channel == in.channel, "set 37");
    check(out.value == in.value, "set 37");
}

static void payload_38(void)
{
    static held payload, packed;
    softrig_set in, out;
    in.setting = 35u;
    in.channel = 145u;
    in.value = 1937489992;
    hex(&payload, "239148c07b73");
    check(same(packed.at, softrig_pack_set(&in, packed.at, HELD_MAX), &payload), "set 38");
    check(softrig_unpack_set(&out, view(&payload)) == 0, "set 38");
    check(out.setting == in.setting, "set 38");
    check(out.channel == in.channel, "set 38");
    check(out.value == in.value, "set 38");
}

static void payload_39(void)
{
    static held payload, packed;
    softrig_calibrate in, out;
    in.session = 0u;
    in.without = 0u;
    hex(&payload, "0000000000000000");
    check(same(packed.at, softrig_pack_calibrate(&in, packed.at, HELD_MAX), &payload), "calibrate 39");
    check(softrig_unpack_calibrate(&out, view(&payload)) == 0, "calibrate 39");
    check(out.session == in.session, "calibrate 39");
    check(out.without == in.without, "calibrate 39");
}

static void payload_40(void)
{
    static held payload, packed;
    softrig_calibrate in, out;
    in.session = 4294967295u;
    in.without = 4294967295u;
    hex(&payload, "ffffffffffffffff");
    check(same(packed.at, softrig_pack_calibrate(&in, packed.at, HELD_MAX), &payload), "calibrate 40");
    check(softrig_unpack_calibrate(&out, view(&payload)) == 0, "calibrate 40");
    check(out.session == in.session, "calibrate 40");
    check(out.without == in.without, "calibrate 40");
}

static void payload_41(void)
{
    static held payload, packed;
    softrig_calibrate in, out;
    in.session = 3454992675u;
    in.without = 3168727058u;
    hex(&payload, "2301efcd12f0debc");
    check(same(packed.at, softrig_pack_calibrate(&in, packed.at, HELD_MAX), &payload), "calibrate 41");
    check(softrig_unpack_calibrate(&out, view(&payload)) == 0, "calibrate 41");
    check(out.session == in.session, "calibrate 41");
    check(out.without == in.without, "calibrate 41");
}

static void payload_42(void)
{
    static held payload, packed;
    softrig_clock_request in, out;
    in.host_us = 0u;
    hex(&payload, "00000000");
    check(same(packed.at, softrig_pack_clock_request(&in, packed.at, HELD_MAX), &payload), "clock_request 42");
    check(softrig_unpack_clock_request(&out, view(&payload)) == 0, "clock_request 42");
    check(out.host_us == in.host_us, "clock_request 42");
}

static void payload_43(void)
{
    static held payload, packed;
    softrig_clock_request in, out;
    in.host_us = 4294967295u;
    hex(&payload, "ffffffff");
    check(same(packed.at, softrig_pack_clock_request(&in, packed.at, HELD_MAX), &payload), "clock_request 43");
    check(softrig_unpack_clock_request(&out, view(&payload)) == 0, "clock_request 43");
    check(out.host_us == in.host_us, "clock_request 43");
}

static void payload_44(void)
{
    static held payload, packed;
    softrig_clock_request in, out;
    in.host_us = 3454992675u;
    hex(&payload, "2301efcd");
    check(same(packed.at, softrig_pack_clock_request(&in, packed.at, HELD_MAX), &payload), "clock_request 44");
    check(softrig_unpack_clock_request(&out, view(&payload)) == 0, "clock_request 44");
    check(out.host_us == in.host_us, "clock_request 44");
}

static void payload_45(void)
{
    static held bytes, payload, packed;
    softrig_program in, out;
    in.header = view(hex(&bytes, ""));
    hex(&payload, "");
    check(same(packed.at, softrig_pack_program(&in, packed.at, HELD_MAX), &payload), "program 45");
    check(softrig_unpack_program(&out, view(&payload)) == 0, "program 45");
    check(same_view(out.header, &bytes), "program 45");
}

static void payload_46(void)
{
    static held bytes, payload, packed;
    softrig_program in, out;
    in.header = view(hex(&bytes, "ffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff"));
    hex(&payload, "ffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff");
    check(same(packed.at, softrig_pack_program(&in, packed.at, HELD_MAX), &payload), "program 46");
    check(softrig_unpack_program(&out, view(&payload)) == 0, "program 46");
    check(same_view(out.header, &bytes), "program 46");
}

static void payload_47(void)
{
    static held bytes, payload, packed;
    softrig_program in, out;
    in.header = view(hex(&bytes, "00017f80ff0053544f5000"));
    hex(&payload, "00017f80ff0053544f5000");
    check(same(packed.at, softrig_pack_program(&in, packed.at, HELD_MAX), &payload), "program 47");
    check(softrig_unpack_program(&out, view(&payload)) == 0, "program 47");
    check(same_view(out.header, &bytes), "program 47");
}

static void payload_48(void)
{
    static held bytes, payload, packed;
    softrig_code in, out;
    in.offset = 0u;
    in.code = view(hex(&bytes, ""));
    hex(&payload, "0000");
    check(same(packed.at, softrig_pack_code(&in, packed.at, HELD_MAX), &payload), "code 48");
    check(softrig_unpack_code(&out, view(&payload)) == 0, "code 48");
    check(out.offset == in.offset, "code 48");
    check(same_view(out.code, &bytes), "code 48");
}

static void payload_49(void)
{
    static held bytes, payload, packed;
    softrig_code in, out;
    in.offset = 65535u;
    in.code = view(hex(&bytes, "ffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff"));
    hex(&payload, "ffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff");
    check(same(packed.at, softrig_pack_code(&in, packed.at, HELD_MAX), &payload), "code 49");
    check(softrig_unpack_code(&out, view(&payload)) == 0, "code 49");
    check(out.offset == in.offset, "code 49");
    check(same_view(out.code, &bytes), "code 49");
}

static void payload_50(void)
{
    static held bytes, payload, packed;
    softrig_code in, out;
    in.offset = 291u;
    in.code = view(hex(&bytes, "00017f80ff0053544f5000"));
    hex(&payload, "230100017f80ff0053544f5000");
    check(same(packed.at, softrig_pack_code(&in, packed.at, HELD_MAX), &payload), "code 50");
    check(softrig_unpack_code(&out, view(&payload)) == 0, "code 50");
    check(out.offset == in.offset, "code 50");
    check(same_view(out.code, &bytes), "code 50");
}

static void payload_51(void)
{
    static held payload, packed;
    softrig_start in, out;
    in.at_ms = 0u;
    in.paused = 0u;
    hex(&payload, "0000000000");
    check(same(packed.at, softrig_pack_start(&in, packed.at, HELD_MAX), &payload), "start 51");
    check(softrig_unpack_start(&out, view(&payload)) == 0, "start 51");
    check(out.at_ms == in.at_ms, "start 51");
    check(out.paused == in.paused, "start 51");
}

static void payload_52(void)
{
    static held payload, packed;
    softrig_start in, out;
    in.at_ms = 4294967295u;
    in.paused = 1u;
    hex(&payload, "ffffffff01");
    check(same(packed.at, softrig_pack_start(&in, packed.at, HELD_MAX), &payload), "start 52");
    check(softrig_unpack_start(&out, view(&payload)) == 0, "start 52");
    check(out.at_ms == in.at_ms, "start 52");
    check(out.paused == in.paused, "start 52");
}

static void payload_53(void)
{
    static held payload, packed;
    softrig_start in, out;
    in.at_ms = 3454992675u;
    in.paused = 0u;
    hex(&payload, "2301efcd00");
    check(same(packed.at, softrig_pack_start(&in, packed.at, HELD_MAX), &payload), "start 53");
    check(softrig_unpack_start(&out, view(&payload)) == 0, "start 53");
    check(out.at_ms == in.at_ms, "start 53");
    check(out.paused == in.paused, "start 53");
}

static void payload_54(void)
{
    static held payload, packed;
    softrig_move in, out;
    in.joints = 0u;
    in.target_centi = -32768;
    in.over_ms = 0u;
    in.hold_ms = 0u;
    hex(&payload, "000000000080000000000000");
    check(same(packed.at, softrig_pack_move(&in, packed.at, HELD_MAX), &payload), "move 54");
    check(softrig_unpack_move(&out, view(&payload)) == 0, "move 54");
    check(out.joints == in.joints, "move 54");
    check(out.target_centi == in.target_centi, "move 54");
    check(out.over_ms == in.over_ms, "move 54");
    check(out.hold_ms == in.hold_ms, "move 54");
}

static void payload_55(void)
{
    static held payload, packed;
    softrig_move in, out;
    in.joints = 4294967295u;
    in.target_centi = 32767;
    in.over_ms = 65535u;
    in.hold_ms = 4294967295u;
    hex(&payload, "ffffffffff7fffffffffffff");
    check(same(packed.at, softrig_pack_move(&in, packed.at, HELD_MAX), &payload), "move 55");
    check(softrig_unpack_move(&out, view(&payload)) == 0, "move 55");
    check(out.joints == in.joints, "move 55");
    check(out.target_centi == in.target_centi, "move 55");
    check(out.over_ms == in.over_ms, "move 55");
    check(out.hold_ms == in.hold_ms, "move 55");
}

static void payload_56(void)
{
    static held payload, packed;
    softrig_move in, out;
    in.joints = 3454992675u;
    in.target_centi = 28690;
    in.over_ms = 32913u;
    in.hold_ms = 2042486820u;
    hex(&payload, "2301efcd1270918024e0bd79");
    check(same(packed.at, softrig_pack_move(&in, packed.at, HELD_MAX), &payload), "move 56");
    check(softrig_unpack_move(&out, view(&payload)) == 0, "move 56");
    check(out.joints == in.joints, "move 56");
    check(out.target_centi == in.target_centi, "move 56");
    check(out.over_ms == in.over_ms, "move 56");
    check(out.hold_ms == in.hold_ms, "move 56");
}

static void payload_57(void)
{
    static held payload, packed;
    softrig_orient in, out;
    in.target_centideg = -32768;
    in.time_ms = 0u;
    in.hold_ms = 0u;
    hex(&payload, "0080000000000000");
    check(same(packed.at, softrig_pack_orient(&in, packed.at, HELD_MAX), &payload), "orient 57");
    check(softrig_unpack_orient(&out, view(&payload)) == 0, "orient 57");
    check(out.target_centideg == in.target_centideg, "orient 57");
    check(out.time_ms == in.time_ms, "orient 57");
    check(out.hold_ms == in.hold_ms, "orient 57");
}

static void payload_58(void)
{
    static held payload, packed;
    softrig_orient in, out;
    in.target_centideg = 32767;
    in.time_ms = 65535u;
    in.hold_ms = 4294967295u;
    hex(&payload, "ff7fffffffffffff");
    check(same(packed.at, softrig_pack_orient(&in, packed.at, HELD_MAX), &payload), "orient 58");
    check(softrig_unpack_orient(&out, view(&payload)) == 0, "orient 58");
    check(out.target_centideg == in.target_centideg, "orient 58");
    check(out.time_ms == in.time_ms, "orient 58");
    check(out.hold_ms == in.hold_ms, "orient 58");
}

static void payload_59(void)
{
    static held payload, packed;
    softrig_orient in, out;
    in.target_centideg = -32477;
    in.time_ms = 49224u;
    in.hold_ms = 3168727058u;
    hex(&payload, "238148c012f0debc");
    check(same(packed.at, softrig_pack_orient(&in, packed.at, HELD_MAX), &payload), "orient 59");
    check(softrig_unpack_orient(&out, view(&payload)) == 0, "orient 59");
    check(out.target_centideg == in.target_centideg, "orient 59");
    check(out.time_ms == in.time_ms, "orient 59");
    check(out.hold_ms == in.hold_ms, "orient 59");
}

static void payload_60(void)
{
    static held payload, packed;
    softrig_press in, out;
    in.target_mn = 0u;
    in.over_ms = 0u;
    in.time_ms = 0u;
    in.hold_ms = 0u;
    hex(&payload, "000000000000000000000000");
    check(same(packed.at, softrig_pack_press(&in, packed.at, HELD_MAX), &payload), "press 60");
    check(softrig_unpack_press(&out, view(&payload)) == 0, "press 60");
    check(out.target_mn == in.target_mn, "press 60");
    check(out.over_ms == in.over_ms, "press 60");
    check(out.time_ms == in.time_ms, "press 60");
    check(out.hold_ms == in.hold_ms, "press 60");
}

static void payload_61(void)
{
    static held payload, packed;
    softrig_press in, out;
    in.target_mn = 65535u;
    in.over_ms = 65535u;
    in.time_ms = 4294967295u;
    in.hold_ms = 4294967295u;
    hex(&payload, "ffffffffffffffffffffffff");
    check(same(packed.at, softrig_pack_press(&in, packed.at, HELD_MAX), &payload), "press 61");
    check(softrig_unpack_press(&out, view(&payload)) == 0, "press 61");
    check(out.target_mn == in.target_mn, "press 61");
    check(out.over_ms == in.over_ms, "press 61");
    check(out.time_ms == in.time_ms, "press 61");
    check(out.hold_ms == in.hold_ms, "press 61");
}

static void payload_62(void)
{
    static held payload, packed;
    softrig_press in, out;
    in.target_mn = 291u;
    in.over_ms = 49224u;
    in.time_ms = 3168727058u;
    in.hold_ms = 2042486820u;
    hex(&payload, "230148c012f0debc24e0bd79");
    check(same(packed.at, softrig_pack_press(&in, packed.at, HELD_MAX), &payload), "press 62");
    check(softrig_unpack_press(&out, view(&payload)) == 0, "press 62");
    check(out.target_mn == in.target_mn, "press 62");
    check(out.over_ms == in.over_ms, "press 62");
    check(out.time_ms == in.time_ms, "press 62");
    check(out.hold_ms == in.hold_ms, "press 62");
}

static void payload_63(void)
{
    static held payload, packed;
    softrig_pause in, out;
    in.how = 0u;
    hex(&payload, "00");
    check(same(packed.at, softrig_pack_pause(&in, packed.at, HELD_MAX), &payload), "pause 63");
    check(softrig_unpack_pause(&out, view(&payload)) == 0, "pause 63");
    check(out.how == in.how, "pause 63");
}

static void payload_64(void)
{
    static held payload, packed;
    softrig_pause in, out;
    in.how = 255u;
    hex(&payload, "ff");
    check(same(packed.at, softrig_pack_pause(&in, packed.at, HELD_MAX), &payload), "pause 64");
    check(softrig_unpack_pause(&out, view(&payload)) == 0, "pause 64");
    check(out.how == in.how, "pause 64");
}

static void payload_65(void)
{
    static held payload, packed;
    softrig_pause in, out;
    in.how = 35u;
    hex(&payload, "23");
    check(same(packed.at, softrig_pack_pause(&in, packed.at, HELD_MAX), &payload), "pause 65");
    check(softrig_unpack_pause(&out, view(&payload)) == 0, "pause 65");
    check(out.how == in.how, "pause 65");
}

static void payload_66(void)
{
    static held payload, packed;
    softrig_ok in, out;
    in.request = 0u;
    hex(&payload, "00");
    check(same(packed.at, softrig_pack_ok(&in, packed.at, HELD_MAX), &payload), "ok 66");
    check(softrig_unpack_ok(&out, view(&payload)) == 0, "ok 66");
    check(out.request == in.request, "ok 66");
}

static void payload_67(void)
{
    static held payload, packed;
    softrig_ok in, out;
    in.request = 255u;
    hex(&payload, "ff");
    check(same(packed.at, softrig_pack_ok(&in, packed.at, HELD_MAX), &payload), "ok 67");
    check(softrig_unpack_ok(&out, view(&payload)) == 0, "ok 67");
    check(out.request == in.request, "ok 67");
}

static void payload_68(void)
{
    static held payload, packed;
    softrig_ok in, out;
    in.request = 35u;
    hex(&payload, "23");
    check(same(packed.at, softrig_pack_ok(&in, packed.at, HELD_MAX), &payload), "ok 68");
    check(softrig_unpack_ok(&out, view(&payload)) == 0, "ok 68");
    check(out.request == in.request, "ok 68");
}

static void payload_69(void)
{
    static held payload, packed;
    softrig_refused in, out;
    in.request = 0u;
    in.code = 0u;
    in.channel = 0u;
    in.value = -2147483647 - 1;
    in.limit = -2147483647 - 1;
    hex(&payload, "000000000000008000000080");
    check(same(packed.at, softrig_pack_refused(&in, packed.at, HELD_MAX), &payload), "refused 69");
    check(softrig_unpack_refused(&out, view(&payload)) == 0, "refused 69");
    check(out.request == in.request, "refused 69");
    check(out.code == in.code, "refused 69");
    check(out.channel == in.channel, "refused 69");
    check(out.value == in.value, "refused 69");
    check(out.limit == in.limit, "refused 69");
}

static void payload_70(void)
{
    static held payload, packed;
    softrig_refused in, out;
    in.request = 255u;
    in.code = 65535u;
    in.channel = 255u;
    in.value = 2147483647;
    in.limit = 2147483647;
    hex(&payload, "ffffffffffffff7fffffff7f");
    check(same(packed.at, softrig_pack_refused(&in, packed.at, HELD_MAX), &payload), "refused 70");
    check(softrig_unpack_refused(&out, view(&payload)) == 0, "refused 70");
    check(out.request == in.request, "refused 70");
    check(out.code == in.code, "refused 70");
    check(out.channel == in.channel, "refused 70");
    check(out.value == in.value, "refused 70");
    check(out.limit == in.limit, "refused 70");
}

static void payload_71(void)
{
    static held payload, packed;
    softrig_refused in, out;
    in.request = 35u;
    in.code = 32913u;
    in.channel = 36u;
    in.value = 1021243410;
    in.limit = -104996828;
    hex(&payload, "2391802412f0de3c24e0bdf9");
    check(same(packed.at, softrig_pack_refused(&in, packed.at, HELD_MAX), &payload), "refused 71");
    check(softrig_unpack_refused(&out, view(&payload)) == 0, "refused 71");
    check(out.request == in.request, "refused 71");
    check(out.code == in.code, "refused 71");
    check(out.channel == in.channel, "refused 71");
    check(out.value == in.value, "refused 71");
    check(out.limit == in.limit, "refused 71");
}

static void payload_72(void)
{
    static held payload, packed;
    softrig_status in, out;
    in.request = 0u;
    in.state = 0u;
    in.code = 0u;
    in.uptime_ms = 0u;
    in.lease_ms = 0u;
    in.step = 0u;
    in.paused = 0u;
    in.coils = 0u;
    in.supply_mv = 0u;
    in.current_ma = 0u;
    in.board_decidegc = -32768;
    in.roll_decideg = -32768;
    in.pitch_decideg = -32768;
    in.down = 0u;
    in.dropped = 0u;
    in.forged = 0u;
    in.repeated = 0u;
    in.overruns = 0u;
    hex(&payload, "000000000000000000000000000000000000000000008000800080000000000000000000");
    check(same(packed.at, softrig_pack_status(&in, packed.at, HELD_MAX), &payload), "status 72");
    check(softrig_unpack_status(&out, view(&payload)) == 0, "status 72");
    check(out.request == in.request, "status 72");
    check(out.state == in.state, "status 72");
    check(out.code == in.code, "status 72");
    check(out.uptime_ms == in.uptime_ms, "status 72");
    check(out.lease_ms == in.lease_ms, "status 72");
    check(out.step == in.step, "status 72");
    check(out.paused == in.paused, "status 72");
    check(out.coils == in.coils, "status 72");
    check(out.supply_mv == in.supply_mv, "status 72");
    check(out.current_ma == in.current_ma, "status 72");
    check(out.board_decidegc == in.board_decidegc, "status 72");
    check(out.roll_decideg == in.roll_decideg, "status 72");
    check(out.pitch_decideg == in.pitch_decideg, "status 72");
    check(out.down == in.down, "status 72");
    check(out.dropped == in.dropped, "status 72");
    check(out.forged == in.forged, "status 72");
    check(out.repeated == in.repeated, "status 72");
    check(out.overruns == in.overruns, "status 72");
}

static void payload_73(void)
{
    static held payload, packed;
    softrig_status in, out;
    in.request = 255u;
    in.state = 255u;
    in.code = 65535u;
    in.uptime_ms = 4294967295u;
    in.lease_ms = 65535u;
    in.step = 65535u;
    in.paused = 1u;
    in.coils = 4294967295u;
    in.supply_mv = 65535u;
    in.current_ma = 65535u;
    in.board_decidegc = 32767;
    in.roll_decideg = 32767;
    in.pitch_decideg = 32767;
    in.down = 255u;
    in.dropped = 65535u;
    in.forged = 65535u;
    in.repeated = 65535u;
    in.overruns = 65535u;
    hex(&payload, "ffffffffffffffffffffffff01ffffffffffffffffff7fff7fff7fffffffffffffffffff");
    check(same(packed.at, softrig_pack_status(&in, packed.at, HELD_MAX), &payload), "status 73");
    check(softrig_unpack_status(&out, view(&payload)) == 0, "status 73");
    check(out.request == in.request, "status 73");
    check(out.state == in.state, "status 73");
    check(out.code == in.code, "status 73");
    check(out.uptime_ms == in.uptime_ms, "status 73");
    check(out.lease_ms == in.lease_ms, "status 73");
    check(out.step == in.step, "status 73");
    check(out.paused == in.paused, "status 73");
    check(out.coils == in.coils, "status 73");
    check(out.supply_mv == in.supply_mv, "status 73");
    check(out.current_ma == in.current_ma, "status 73");
    check(out.board_decidegc == in.board_decidegc, "status 73");
    check(out.roll_decideg == in.roll_decideg, "status 73");
    check(out.pitch_decideg == in.pitch_decideg, "status 73");
    check(out.down == in.down, "status 73");
    check(out.dropped == in.dropped, "status 73");
    check(out.forged == in.forged, "status 73");
    check(out.repeated == in.repeated, "status 73");
    check(out.overruns == in.overruns, "status 73");
}

static void payload_74(void)
{
    static held payload, packed;
    softrig_status in, out;
    in.request = 35u;
    in.state = 145u;
    in.code = 49224u;
    in.uptime_ms = 3168727058u;
    in.lease_ms = 57380u;
    in.step = 291u;
    in.paused = 0u;
    in.coils = 2042486820u;
    in.supply_mv = 49224u;
    in.current_ma = 61458u;
    in.board_decidegc = 145;
    in.roll_decideg = 24612;
    in.pitch_decideg = -32477;
    in.down = 72u;
    in.dropped = 57380u;
    in.forged = 291u;
    in.repeated = 49224u;
    in.overruns = 61458u;
    hex(&payload, "239148c012f0debc24e023010024e0bd7948c012f09100246023814824e0230148c012f0");
    check(same(packed.at, softrig_pack_status(&in, packed.at, HELD_MAX), &payload), "status 74");
    check(softrig_unpack_status(&out, view(&payload)) == 0, "status 74");
    check(out.request == in.request, "status 74");
    check(out.state == in.state, "status 74");
    check(out.code == in.code, "status 74");
    check(out.uptime_ms == in.uptime_ms, "status 74");
    check(out.lease_ms == in.lease_ms, "status 74");
    check(out.step == in.step, "status 74");
    check(out.paused == in.paused, "status 74");
    check(out.coils == in.coils, "status 74");
    check(out.supply_mv == in.supply_mv, "status 74");
    check(out.current_ma == in.current_ma, "status 74");
    check(out.board_decidegc == in.board_decidegc, "status 74");
    check(out.roll_decideg == in.roll_decideg, "status 74");
    check(out.pitch_decideg == in.pitch_decideg, "status 74");
    check(out.down == in.down, "status 74");
    check(out.dropped == in.dropped, "status 74");
    check(out.forged == in.forged, "status 74");
    check(out.repeated == in.repeated, "status 74");
    check(out.overruns == in.overruns, "status 74");
}

static void payload_75(void)
{
    static held bytes, payload, packed;
    softrig_faults in, out;
    in.request = 0u;
    in.start = 0u;
    in.count = 0u;
    in.records = view(hex(&bytes, ""));
    hex(&payload, "000000000000");
    check(same(packed.at, softrig_pack_faults(&in, packed.at, HELD_MAX), &payload), "faults 75");
    check(softrig_unpack_faults(&out, view(&payload)) == 0, "faults 75");
    check(out.request == in.request, "faults 75");
    check(out.start == in.start, "faults 75");
    check(out.count == in.count, "faults 75");
    check(same_view(out.records, &bytes), "faults 75");
}

static void payload_76(void)
{
    static held bytes, payload, packed;
    softrig_faults in, out;
    in.request = 255u;
    in.start = 4294967295u;
    in.count = 255u;
    in.records = view(hex(&bytes, "ffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff"));
    hex(&payload, "ffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff");
    check(same(packed.at, softrig_pack_faults(&in, packed.at, HELD_MAX), &payload), "faults 76");
    check(softrig_unpack_faults(&out, view(&payload)) == 0, "faults 76");
    check(out.request == in.request, "faults 76");
    check(out.start == in.start, "faults 76");
    check(out.count == in.count, "faults 76");
    check(same_view(out.records, &bytes), "faults 76");
}

static void payload_77(void)
{
    static held bytes, payload, packed;
    softrig_faults in, out;
    in.request = 35u;
    in.start = 3874979985u;
    in.count = 35u;
    in.records = view(hex(&bytes, "00017f80ff0053544f5000"));
    hex(&payload, "239180f7e62300017f80ff0053544f5000");
    check(same(packed.at, softrig_pack_faults(&in, packed.at, HELD_MAX), &payload), "faults 77");
    check(softrig_unpack_faults(&out, view(&payload)) == 0, "faults 77");
    check(out.request == in.request, "faults 77");
    check(out.start == in.start, "faults 77");
    check(out.count == in.count, "faults 77");
    check(same_view(out.records, &bytes), "faults 77");
}

static void payload_78(void)
{
    static held bytes, payload, packed;
    softrig_settings in, out;
    in.request = 0u;
    in.source = 0u;
    in.node = 0u;
    in.board_offset_decidegc = -32768;
    in.resistances = view(hex(&bytes, ""));
    hex(&payload, "0000000080");
    check(same(packed.at, softrig_pack_settings(&in, packed.at, HELD_MAX), &payload), "settings 78");
    check(softrig_unpack_settings(&out, view(&payload)) == 0, "settings 78");
    check(out.request == in.request, "settings 78");
    check(out.source == in.source, "settings 78");
    check(out.node == in.node, "settings 78");
    check(out.board_offset_decidegc == in.board_offset_decidegc, "settings 78");
    check(same_view(out.resistances, &bytes), "settings 78");
}

static void payload_79(void)
{
    static held bytes, payload, packed;
    softrig_settings in, out;
    in.request = 255u;
    in.source = 255u;
    in.node = 255u;
    in.board_offset_decidegc = 32767;
    in.resistances = view(hex(&bytes, "ffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff"));
    hex(&payload, "ffffffff7fffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff");
    check(same(packed.at, softrig_pack_settings(&in, packed.at, HELD_MAX), &payload), "settings 79");
    check(softrig_unpack_settings(&out, view(&payload)) == 0, "settings 79");
    check(out.request == in.request, "settings 79");
    check(out.source == in.source, "settings 79");
    check(out.node == in.node, "settings 79");
    check(out.board_offset_decidegc == in.board_offset_decidegc, "settings 79");
    check(same_view(out.resistances, &bytes), "settings 79");
}

static void payload_80(void)
{
    static held bytes, payload, packed;
    softrig_settings in, out;
    in.request = 35u;
    in.source = 145u;
    in.node = 72u;
    in.board_offset_decidegc = 24612;
    in.resistances = view(hex(&bytes, "00017f80ff0053544f5000"));
    hex(&payload, "239148246000017f80ff0053544f5000");
    check(same(packed.at, softrig_pack_settings(&in, packed.at, HELD_MAX), &payload), "settings 80");
    check(softrig_unpack_settings(&out, view(&payload)) == 0, "settings 80");
    check(out.request == in.request, "settings 80");
    check(out.source == in.source, "settings 80");
    check(out.node == in.node, "settings 80");
    check(out.board_offset_decidegc == in.board_offset_decidegc, "settings 80");
    check(same_view(out.resistances, &bytes), "settings 80");
}

static void payload_81(void)
{
    static held bytes, payload, packed;
    softrig_coils in, out;
    in.request = 0u;
    in.channels = view(hex(&bytes, ""));
    hex(&payload, "00");
    check(same(packed.at, softrig_pack_coils(&in, packed.at, HELD_MAX), &payload), "coils 81");
    check(softrig_unpack_coils(&out, view(&payload)) == 0, "coils 81");
    check(out.request == in.request, "coils 81");
    check(same_view(out.channels, &bytes), "coils 81");
}

static void payload_82(void)
{
    static held bytes, payload, packed;
    softrig_coils in, out;
    in.request = 255u;
    in.channels = view(hex(&bytes, "ffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff"));
    hex(&payload, "ffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff");
    check(same(packed.at, softrig_pack_coils(&in, packed.at, HELD_MAX), &payload), "coils 82");
    check(softrig_unpack_coils(&out, view(&payload)) == 0, "coils 82");
    check(out.request == in.request, "coils 82");
    check(same_view(out.channels, &bytes), "coils 82");
}

static void payload_83(void)
{
    static held bytes, payload, packed;
    softrig_coils in, out;
    in.request = 35u;
    in.channels = view(hex(&bytes, "00017f80ff0053544f5000"));
    hex(&payload, "2300017f80ff0053544f5000");
    check(same(packed.at, softrig_pack_coils(&in, packed.at, HELD_MAX), &payload), "coils 83");
    check(softrig_unpack_coils(&out, view(&payload)) == 0, "coils 83");
    check(out.request == in.request, "coils 83");
    check(same_view(out.channels, &bytes), "coils 83");
}

static void payload_84(void)
{
    static held payload, packed;
    softrig_event in, out;
    in.event = 0u;
    in.code = 0u;
    in.step = 0u;
    in.channel = 0u;
    in.value = -2147483647 - 1;
    in.now_ms = 0u;
    hex(&payload, "0000000000000000008000000000");
    check(same(packed.at, softrig_pack_event(&in, packed.at, HELD_MAX), &payload), "event 84");
    check(softrig_unpack_event(&out, view(&payload)) == 0, "event 84");
    check(out.event == in.event, "event 84");
    check(out.code == in.code, "event 84");
    check(out.step == in.step, "event 84");
    check(out.channel == in.channel, "event 84");
    check(out.value == in.value, "event 84");
    check(out.now_ms == in.now_ms, "event 84");
}

static void payload_85(void)
{
    static held payload, packed;
    softrig_event in, out;
    in.event = 255u;
    in.code = 65535u;
    in.step = 65535u;
    in.channel = 255u;
    in.value = 2147483647;
    in.now_ms = 4294967295u;
    hex(&payload, "ffffffffffffffffff7fffffffff");
    check(same(packed.at, softrig_pack_event(&in, packed.at, HELD_MAX), &payload), "event 85");
    check(softrig_unpack_event(&out, view(&payload)) == 0, "event 85");
    check(out.event == in.event, "event 85");
    check(out.code == in.code, "event 85");
    check(out.step == in.step, "event 85");
    check(out.channel == in.channel, "event 85");
    check(out.value == in.value, "event 85");
    check(out.now_ms == in.now_ms, "event 85");
}

static void payload_86(void)
{
    static held payload, packed;
    softrig_event in, out;
    in.event = 35u;
    in.code = 32913u;
    in.step = 57380u;
    in.channel = 35u;
    in.value = 1727496337;
    in.now_ms = 3454992675u;
    hex(&payload, "23918024e0239180f7662301efcd");
    check(same(packed.at, softrig_pack_event(&in, packed.at, HELD_MAX), &payload), "event 86");
    check(softrig_unpack_event(&out, view(&payload)) == 0, "event 86");
    check(out.event == in.event, "event 86");
    check(out.code == in.code, "event 86");
    check(out.step == in.step, "event 86");
    check(out.channel == in.channel, "event 86");
    check(out.value == in.value, "event 86");
    check(out.now_ms == in.now_ms, "event 86");
}

static void payload_87(void)
{
    static held bytes, payload, packed;
    softrig_telemetry in, out;
    in.slot = 0u;
    in.form = 0u;
    in.count = 0u;
    in.now_ms = 0u;
    in.values = view(hex(&bytes, ""));
    hex(&payload, "00000000000000");
    check(same(packed.at, softrig_pack_telemetry(&in, packed.at, HELD_MAX), &payload), "telemetry 87");
    check(softrig_unpack_telemetry(&out, view(&payload)) == 0, "telemetry 87");
    check(out.slot == in.slot, "telemetry 87");
    check(out.form == in.form, "telemetry 87");
    check(out.count == in.count, "telemetry 87");
    check(out.now_ms == in.now_ms, "telemetry 87");
    check(same_view(out.values, &bytes), "telemetry 87");
}

static void payload_88(void)
{
    static held bytes, payload, packed;
    softrig_telemetry in, out;
    in.slot = 4u;
    in.form = 255u;
    in.count = 255u;
    in.now_ms = 4294967295u;
    in.values = view(hex(&bytes, "ffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff"));
    hex(&payload, "04ffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff");
    check(same(packed.at, softrig_pack_telemetry(&in, packed.at, HELD_MAX), &payload), "telemetry 88");
    check(softrig_unpack_telemetry(&out, view(&payload)) == 0, "telemetry 88");
    check(out.slot == in.slot, "telemetry 88");
    check(out.form == in.form, "telemetry 88");
    check(out.count == in.count, "telemetry 88");
    check(out.now_ms == in.now_ms, "telemetry 88");
    check(same_view(out.values, &bytes), "telemetry 88");
}

static void payload_89(void)
{
    static held bytes, payload, packed;
    softrig_telemetry in, out;
    in.slot = 0u;
    in.form = 145u;
    in.count = 72u;
    in.now_ms = 2042486820u;
    in.values = view(hex(&bytes, "00017f80ff0053544f5000"));
    hex(&payload, "00914824e0bd7900017f80ff0053544f5000");
    check(same(packed.at, softrig_pack_telemetry(&in, packed.at, HELD_MAX), &payload), "telemetry 89");
    check(softrig_unpack_telemetry(&out, view(&payload)) == 0, "telemetry 89");
    check(out.slot == in.slot, "telemetry 89");
    check(out.form == in.form, "telemetry 89");
    check(out.count == in.count, "telemetry 89");
    check(out.now_ms == in.now_ms, "telemetry 89");
    check(same_view(out.values, &bytes), "telemetry 89");
}

static void payload_90(void)
{
    static held payload, packed;
    softrig_beacon in, out;
    in.state = 0u;
    in.code = 0u;
    in.step = 0u;
    in.supply_mv = 0u;
    in.current_ma = 0u;
    hex(&payload, "0000000000000000");
    check(same(packed.at, softrig_pack_beacon(&in, packed.at, HELD_MAX), &payload), "beacon 90");
    check(softrig_unpack_beacon(&out, view(&payload)) == 0, "beacon 90");
    check(out.state == in.state, "beacon 90");
    check(out.code == in.code, "beacon 90");
    check(out.step == in.step, "beacon 90");
    check(out.supply_mv == in.supply_mv, "beacon 90");
    check(out.current_ma == in.current_ma, "beacon 90");
}

static void payload_91(void)
{
    static held payload, packed;
    softrig_beacon in, out;
    in.state = 255u;
    in.code = 255u;
    in.step = 65535u;
    in.supply_mv = 65535u;
    in.current_ma = 65535u;
    hex(&payload, "ffffffffffffffff");
    check(same(packed.at, softrig_pack_beacon(&in, packed.at, HELD_MAX), &payload), "beacon 91");
    check(softrig_unpack_beacon(&out, view(&payload)) == 0, "beacon 91");
    check(out.state == in.state, "beacon 91");
    check(out.code == in.code, "beacon 91");
    check(out.step == in.step, "beacon 91");
    check(out.supply_mv == in.supply_mv, "beacon 91");
    check(out.current_ma == in.current_ma, "beacon 91");
}

static void payload_92(void)
{
    static held payload, packed;
    softrig_beacon in, out;
    in.state = 35u;
    in.code = 145u;
    in.step = 49224u;
    in.supply_mv = 61458u;
    in.current_ma = 32913u;
    hex(&payload, "239148c012f09180");
    check(same(packed.at, softrig_pack_beacon(&in, packed.at, HELD_MAX), &payload), "beacon 92");
    check(softrig_unpack_beacon(&out, view(&payload)) == 0, "beacon 92");
    check(out.state == in.state, "beacon 92");
    check(out.code == in.code, "beacon 92");
    check(out.step == in.step, "beacon 92");
    check(out.supply_mv == in.supply_mv, "beacon 92");
    check(out.current_ma == in.current_ma, "beacon 92");
}

static void payload_93(void)
{
    static held payload, packed;
    softrig_beacon_coils in, out;
    in.group = 0u;
    in.duty_a_percent = 0u;
    in.duty_b_percent = 0u;
    in.temperature_a_decidegc = -32768;
    in.temperature_b_decidegc = -32768;
    hex(&payload, "00000000800080");
    check(same(packed.at, softrig_pack_beacon_coils(&in, packed.at, HELD_MAX), &payload), "beacon_coils 93");
    check(softrig_unpack_beacon_coils(&out, view(&payload)) == 0, "beacon_coils 93");
    check(out.group == in.group, "beacon_coils 93");
    check(out.duty_a_percent == in.duty_a_percent, "beacon_coils 93");
    check(out.duty_b_percent == in.duty_b_percent, "beacon_coils 93");
    check(out.temperature_a_decidegc == in.temperature_a_decidegc, "beacon_coils 93");
    check(out.temperature_b_decidegc == in.temperature_b_decidegc, "beacon_coils 93");
}

static void payload_94(void)
{
    static held payload, packed;
    softrig_beacon_coils in, out;
    in.group = 15u;
    in.duty_a_percent = 100u;
    in.duty_b_percent = 100u;
    in.temperature_a_decidegc = 32767;
    in.temperature_b_decidegc = 32767;
    hex(&payload, "0f6464ff7fff7f");
    check(same(packed.at, softrig_pack_beacon_coils(&in, packed.at, HELD_MAX), &payload), "beacon_coils 94");
    check(softrig_unpack_beacon_coils(&out, view(&payload)) == 0, "beacon_coils 94");
    check(out.group == in.group, "beacon_coils 94");
    check(out.duty_a_percent == in.duty_a_percent, "beacon_coils 94");
    check(out.duty_b_percent == in.duty_b_percent, "beacon_coils 94");
    check(out.temperature_a_decidegc == in.temperature_a_decidegc, "beacon_coils 94");
    check(out.temperature_b_decidegc == in.temperature_b_decidegc, "beacon_coils 94");
}

static void payload_95(void)
{
    static held payload, packed;
    softrig_beacon_coils in, out;
    in.group = 3u;
    in.duty_a_percent = 30u;
    in.duty_b_percent = 65u;
    in.temperature_a_decidegc = 24612;
    in.temperature_b_decidegc = -32477;
    hex(&payload, "031e4124602381");
    check(same(packed.at, softrig_pack_beacon_coils(&in, packed.at, HELD_MAX), &payload), "beacon_coils 95");
    check(softrig_unpack_beacon_coils(&out, view(&payload)) == 0, "beacon_coils 95");
    check(out.group == in.group, "beacon_coils 95");
    check(out.duty_a_percent == in.duty_a_percent, "beacon_coils 95");
    check(out.duty_b_percent == in.duty_b_percent, "beacon_coils 95");
    check(out.temperature_a_decidegc == in.temperature_a_decidegc, "beacon_coils 95");
    check(out.temperature_b_decidegc == in.temperature_b_decidegc, "beacon_coils 95");
}

static void payload_96(void)
{
    static held payload, packed;
    softrig_clock in, out;
    in.host_us = 0u;
    in.received_ms = 0u;
    in.sent_ms = 0u;
    hex(&payload, "000000000000000000000000");
    check(same(packed.at, softrig_pack_clock(&in, packed.at, HELD_MAX), &payload), "clock 96");
    check(softrig_unpack_clock(&out, view(&payload)) == 0, "clock 96");
    check(out.host_us == in.host_us, "clock 96");
    check(out.received_ms == in.received_ms, "clock 96");
    check(out.sent_ms == in.sent_ms, "clock 96");
}

static void payload_97(void)
{
    static held payload, packed;
    softrig_clock in, out;
    in.host_us = 4294967295u;
    in.received_ms = 4294967295u;
    in.sent_ms = 4294967295u;
    hex(&payload, "ffffffffffffffffffffffff");
    check(same(packed.at, softrig_pack_clock(&in, packed.at, HELD_MAX), &payload), "clock 97");
    check(softrig_unpack_clock(&out, view(&payload)) == 0, "clock 97");
    check(out.host_us == in.host_us, "clock 97");
    check(out.received_ms == in.received_ms, "clock 97");
    check(out.sent_ms == in.sent_ms, "clock 97");
}

static void payload_98(void)
{
    static held payload, packed;
    softrig_clock in, out;
    in.host_us = 3454992675u;
    in.received_ms = 3168727058u;
    in.sent_ms = 2042486820u;
    hex(&payload, "2301efcd12f0debc24e0bd79");
    check(same(packed.at, softrig_pack_clock(&in, packed.at, HELD_MAX), &payload), "clock 98");
    check(softrig_unpack_clock(&out, view(&payload)) == 0, "clock 98");
    check(out.host_us == in.host_us, "clock 98");
    check(out.received_ms == in.received_ms, "clock 98");
    check(out.sent_ms == in.sent_ms, "clock 98");
}

int main(void)
{
    payload_0();
    payload_1();
    payload_2();
    payload_3();
    payload_4();
    payload_5();
    payload_6();
    payload_7();
    payload_8();
    payload_9();
    payload_10();
    payload_11();
    payload_12();
    payload_13();
    payload_14();
    payload_15();
    payload_16();
    payload_17();
    payload_18();
    payload_19();
    payload_20();
    payload_21();
    payload_22();
    payload_23();
    payload_24();
    payload_25();
    payload_26();
    payload_27();
    payload_28();
    payload_29();
    payload_30();
    payload_31();
    payload_32();
    payload_33();
    payload_34();
    payload_35();
    payload_36();
    payload_37();
    payload_38();
    payload_39();
    payload_40();
    payload_41();
    payload_42();
    payload_43();
    payload_44();
    payload_45();
    payload_46();
    payload_47();
    payload_48();
    payload_49();
    payload_50();
    payload_51();
    payload_52();
    payload_53();
    payload_54();
    payload_55();
    payload_56();
    payload_57();
    payload_58();
    payload_59();
    payload_60();
    payload_61();
    payload_62();
    payload_63();
    payload_64();
    payload_65();
    payload_66();
    payload_67();
    payload_68();
    payload_69();
    payload_70();
    payload_71();
    payload_72();
    payload_73();
    payload_74();
    payload_75();
    payload_76();
    payload_77();
    payload_78();
    payload_79();
    payload_80();
    payload_81();
    payload_82();
    payload_83();
    payload_84();
    payload_85();
    payload_86();
    payload_87();
    payload_88();
    payload_89();
    payload_90();
    payload_91();
    payload_92();
    payload_93();
    payload_94();
    payload_95();
    payload_96();
    payload_97();
    payload_98();
    { static const whole told = {0, 1, 0, 0, 0, 0u, 0u, 0, "", "239180f7e62301efcd12f0debc24e0bd79", "20010000239180f7e62301efcd12f0debc24e0bd7992d7a9ee", "0320010116239180f7e62301efcd12f0debc24e0bd7992d7a9ee00"}; frame(&told, "hello"); }
    { static const whole told = {0, 2, 0, 0, 0, 0u, 0u, 1, "", "2301efcd12f0debc24e0bd7948c07bf3918024122391480f12f09180f7e62301efcd12f09180f7e62301efcd12f0debc24e0bd7900017f80ff0053544f5000", "200200002301efcd12f0debc24e0bd7948c07bf3918024122391480f12f09180f7e62301efcd12f09180f7e62301efcd12f0debc24e0bd7900017f80ff0053544f500032ae7a7c", "03200201352301efcd12f0debc24e0bd7948c07bf3918024122391480f12f09180f7e62301efcd12f09180f7e62301efcd12f0debc24e0bd7905017f80ff0553544f500532ae7a7c00"}; frame(&told, "identity"); }
    { static const whole told = {2, 2, 0, 0, 9, 0u, 0u, 1, "", "2301efcd12f0debc24e0bd7948c07bf3918024122391480f12f09180f7e62301efcd12f09180f7e62301efcd12f0debc24e0bd7900017f80ff0053544f5000", "22020000092301efcd12f0debc24e0bd7948c07bf3918024122391480f12f09180f7e62301efcd12f09180f7e62301efcd12f0debc24e0bd7900017f80ff0053544f5000435cac63", "0322020136092301efcd12f0debc24e0bd7948c07bf3918024122391480f12f09180f7e62301efcd12f09180f7e62301efcd12f0debc24e0bd7905017f80ff0553544f5005435cac6300"}; frame(&told, "identity"); }
    { static const whole told = {0, 7, 0, 0, 0, 0u, 0u, 0, "", "", "20070000a7663984", "0320070105a766398400"}; frame(&told, "sync"); }
    { static const whole told = {0, 16, 200, 7, 0, 894227724u, 200u, 0, "", "2301efcd182301", "2010c8072301efcd182301144ff745", "102010c8072301efcd182301144ff74500"}; frame(&told, "alive"); }
    { static const whole told = {1, 18, 0, 0, 0, 894227724u, 0u, 0, "", "", "2112000010ec83ed", "032112010510ec83ed00"}; frame(&told, "disarm"); }
    { static const whole told = {1, 20, 3, 255, 0, 894227724u, 3u, 0, "", "2301efcd72039180", "211403ff2301efcd720391803b3fbfbe", "11211403ff2301efcd720391803b3fbfbe00"}; frame(&told, "fire"); }
    { static const whole told = {3, 20, 255, 0, 126, 894227724u, 255u, 0, "", "2301efcd72039180", "2314ff007e2301efcd720391808d002241", "042314ff0b7e2301efcd720391808d03224100"}; frame(&told, "fire"); }
    { static const whole told = {5, 20, 3, 255, 0, 894227724u, 3u, 0, "d6ed30e4cc2152c40d9dbbcb4fe56153db2fd42554bf2abf82b5c5c187299ab2", "2301efcd72039180", "251403ff2301efcd72039180d0467ec253bf65cdae60f680", "19251403ff2301efcd72039180d0467ec253bf65cdae60f68000"}; frame(&told, "fire"); }
    { static const whole told = {7, 20, 3, 255, 1, 894227724u, 259u, 0, "d6ed30e4cc2152c40d9dbbcb4fe56153db2fd42554bf2abf82b5c5c187299ab2", "2301efcd72039180", "271403ff012301efcd720391804dfa0d0598e99bb39d61bcb9", "1a271403ff012301efcd720391804dfa0d0598e99bb39d61bcb900"}; frame(&told, "fire"); }
    { static const whole told = {5, 65, 112, 1, 0, 894227724u, 70000u, 1, "d6ed30e4cc2152c40d9dbbcb4fe56153db2fd42554bf2abf82b5c5c187299ab2", "2391802412f0de3c24e0bdf9", "254170012391802412f0de3c24e0bdf93ef6afbdd42e33a0612b719e", "1d254170012391802412f0de3c24e0bdf93ef6afbdd42e33a0612b719e00"}; frame(&told, "refused"); }
    { static const whole told = {0, 80, 17, 0, 0, 3237998146u, 17u, 1, "", "00914824e0bd7900017f80ff0053544f5000", "2050110000914824e0bd7900017f80ff0053544f50008c6a45ab", "042050110107914824e0bd7905017f80ff0553544f50058c6a45ab00"}; frame(&told, "telemetry"); }
    { static const whole told = {1, 33, 1, 2, 0, 894227724u, 1u, 0, "", "0000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000", "2121010200000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000005454319b", "052121010201010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101055454319b00"}; frame(&told, "code"); }
    { static const whole told = {1, 33, 1, 2, 0, 894227724u, 1u, 0, "", "0000010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101", "21210102000001010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010149ff473a", "052121010201ef01010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010149ff473a00"}; frame(&told, "code"); }
    { static const whole told = {1, 33, 1, 2, 0, 894227724u, 1u, 0, "", "0000ffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff", "212101020000ffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffc0130b99", "052121010201efffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffc0130b9900"}; frame(&told, "code"); }
    { static const whole told = {7, 33, 1, 2, 126, 894227724u, 1u, 0, "d6ed30e4cc2152c40d9dbbcb4fe56153db2fd42554bf2abf82b5c5c187299ab2", "0000010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101", "272101027e0000010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101caf9a55e5282eab9891cf9f9", "06272101027e01f7010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101caf9a55e5282eab9891cf9f900"}; frame(&told, "code"); }
    stream("11201403ff2301efcd720391803b3fbfbe00", "", 0, "bit 0 of byte 0 is flipped");
    stream("11211603ff2301efcd720391803b3fbfbe00", "", 0, "bit 1 of byte 1 is flipped");
    stream("11211407ff2301efcd720391803b3fbfbe00", "", 0, "bit 2 of byte 2 is flipped");
    stream("11211403f72301efcd720391803b3fbfbe00", "", 0, "bit 3 of byte 3 is flipped");
    stream("11211403ff3301efcd720391803b3fbfbe00", "", 0, "bit 4 of byte 4 is flipped");
    stream("11211403ff2321efcd720391803b3fbfbe00", "", 0, "bit 5 of byte 5 is flipped");
    stream("11211403ff2301afcd720391803b3fbfbe00", "", 0, "bit 6 of byte 6 is flipped");
    stream("11211403ff2301ef4d720391803b3fbfbe00", "", 0, "bit 7 of byte 7 is flipped");
    stream("11211403ff2301efcd730391803b3fbfbe00", "", 0, "bit 0 of byte 8 is flipped");
    stream("11211403ff2301efcd720191803b3fbfbe00", "", 0, "bit 1 of byte 9 is flipped");
    stream("11211403ff2301efcd720395803b3fbfbe00", "", 0, "bit 2 of byte 10 is flipped");
    stream("11211403ff2301efcd720391883b3fbfbe00", "", 0, "bit 3 of byte 11 is flipped");
    stream("11211403ff2301efcd720391802b3fbfbe00", "", 0, "bit 4 of byte 12 is flipped");
    stream("11211403ff2301efcd720391803b1fbfbe00", "", 0, "bit 5 of byte 13 is flipped");
    stream("11211403ff2301efcd720391803b3fffbe00", "", 0, "bit 6 of byte 14 is flipped");
    stream("11211403ff2301efcd720391803b3fbf3e00", "", 0, "bit 7 of byte 15 is flipped");
    stream("11211403ff2301efcd72039180aaaed71000", "", 0, "made for another session");
    stream("11211403ff2301efcd72039180aaaed71000", "", 0, "made for another dictionary");
    stream("11211403ff2301efcd72039180f0549d2500", "", 0, "sealed like a greeting");
    stream("11211403ff2301efcd72039180622106d500", "", 0, "sealed like an open frame");
    stream("042050110107914824e0bd7905017f80ff0553544f50057e8b4eca00", "", 0, "an open frame sealed like one of the session");
    stream("11111403ff2301efcd720391803f0996aa00", "", 0, "of version 1");
    stream("11291403ff2301efcd72039180c549b3b800", "", 0, "with the reserved flag");
    stream("09221403ff028394fd00", "", 0, "says that a node follows, and nothing does");
    stream("05241403ff01010101010105c82de82a00", "", 0, "says that a tag follows, and none does");
    stream("10211403ff2301efcd720391803b3fbf00", "", 0, "one byte too short");
    stream("07211403ff230100", "", 0, "no payload and half a CRC");
    stream("ff211403ff0101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101017049ea2000", "", 0, "one byte too long");
    stream("fe211403ff2301efcd720391803b3fbfbe00", "", 0, "a run that ends beyond the frame");
    stream("11211403ff2301efcd720391803b3fbf00", "", 0, "a last run that is cut");
    stream("0100", "", 0, "nothing but a run of none");
    stream("53544f5100", "", 0, "four bytes that are no stop");
    stream("11211403ff2301efcd720391803b3fbfbe000320010116239180f7e62301efcd12f0debc24e0bd7992d7a9ee00", "20 1 ", 0, "two frames");
    stream("000011211403ff2301efcd720391803b3fbfbe00000320010116239180f7e62301efcd12f0debc24e0bd7992d7a9ee00", "20 1 ", 0, "zeros between frames mean nothing");
    stream("a55a11211403ff2301efcd720391803b3fbfbe000320010116239180f7e62301efcd12f0debc24e0bd7992d7a9ee00", "1 ", 0, "noise costs the frame that it runs into");
    stream("11211403ff2301efcd0320010116239180f7e62301efcd12f0debc24e0bd7992d7a9ee000320010116239180f7e62301efcd12f0debc24e0bd7992d7a9ee00", "1 ", 0, "half a frame costs no more than the next");
    stream("ffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff0011211403ff2301efcd720391803b3fbfbe00", "20 ", 0, "a line that was open before the first frame");
    stream("0053544f5000", "", 1, "a stop");
    stream("11211403ff2301efcd0053544f500011211403ff2301efcd720391803b3fbfbe00", "20 ", 1, "a stop in the middle of a frame");
    stream("0053544f500053544f5000", "", 2, "two stops that share a zero");
    stream("11211403ff2301efcd720391803b3fbfbe0053544f50000320010116239180f7e62301efcd12f0debc24e0bd7992d7a9ee00", "20 1 ", 1, "a stop straight after a frame, whose zero it may use");
    stream("05212104ff010105017f80ff0553544f5005da15a34c00", "33 ", 0, "the letters in a payload are no stop");
    segments(139463688u, 20, 3, 1, 0, 0, "201401022301efcd72039180a4875646", "0880201401022301ef0801cd72039180a48703425646", "CAN fire");
    segments(139590640u, 20, 126, 126, 0, 1, "201401022301efcd72039180a4875646", "14c010201401022301efcd72039180a48756460000", "CAN fire");
    segments(142871560u, 33, 3, 1, 0, 0, "202101020000010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101440f303a", "088020210102000001080101010101010101080201010101010101080301010101010101080401010101010101080501010101010101080601010101010101080701010101010101080801010101010101080901010101010101080a01010101010101080b01010101010101080c01010101010101080d01010101010101080e01010101010101080f01010101010101081001010101010101081101010101010101081201010101010101081301010101010101081401010101010101081501010101010101081601010101010101081701010101010101081801010101010101081901010101010101081a01010101010101081b01010101010101081c01010101010101081d01010101010101081e01010101010101081f0101010101010108200101010101010108210101010101010107620101440f303a", "CAN code");
    segments(142871560u, 33, 3, 1, 0, 1, "202101020000010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101440f303a", "4080f4202101020000010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010140010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101014002010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101404301010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101440f303a00000000000000", "CAN code");
    segments(423761912u, 80, 5, 127, 1, 0, "2050010200914824e0bd7900017f80ff0053544f500058c7373f", "088020500102009148080124e0bd7900017f080280ff0053544f5006430058c7373f", "CAN telemetry");
    segments(269095992u, 2, 5, 7, 1, 1, "200201022301efcd12f0debc24e0bd7948c07bf3918024122391480f12f09180f7e62301efcd12f09180f7e62301efcd12f0debc24e0bd7900017f80ff0053544f5000bfa18b39", "408047200201022301efcd12f0debc24e0bd7948c07bf3918024122391480f12f09180f7e62301efcd12f09180f7e62301efcd12f0debc24e0bd7900017f80ff000c4153544f5000bfa18b390000", "CAN identity");
    segments(202774520u, 5, 5, 127, 1, 0, "2005010223918024e0bd7948c07bf3e7b320b6", "088020050102239180080124e0bd7948c07b0642f3e7b320b6", "CAN stopped");
    key("000102030405060708090a0b0c0d0e0f101112131415161718191a1b1c1d1e1f", "0278563412000000000403020108070605", 2711790500u, 2779162536u, 3237998146u, "d6ed30e4cc2152c40d9dbbcb4fe56153db2fd42554bf2abf82b5c5c187299ab2", 1322359566u, 1529411322u, "251403ff2301efcd72039180", 259u, "f7a1b0eb22573f9a");
    printf("%d checks, %d failed\n", checks, failures);
    return failures != 0;
}
