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
        if (size > 0 && softrig_unseal(decoder.body, (size_t)size, @DICTIONARY_CRC@u,
                                       softrig_session_seed(@DICTIONARY_CRC@u, @SESSION@u), &found) == 0)
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

@MESSAGES@
int main(void)
{
@CALLS@
    printf("%d checks, %d failed\n", checks, failures);
    return failures != 0;
}
