/* softrig.h: the wire protocol of softrig, version 2, for clients in C99 or C++11: one file, no library, no heap.
 *
 * Made by docs/generate.py from protocol/messages.py: change that and run `make docs`.
 * What the bytes mean stands in docs/protocol.md; docs/vectors.json has bytes to test against, docs/c/vectors.c does so.
 *
 *     softrig_fire order = {1, 600, 500};
 *     uint8_t payload[SOFTRIG_PAYLOAD_MAX], wire[SOFTRIG_FRAME_MAX];
 *     int size = softrig_pack_fire(&order, payload, sizeof payload);
 *     softrig_frame frame = {SOFTRIG_RELIABLE, SOFTRIG_KIND_FIRE, seq, ack, 0, {payload, (size_t)size}};
 *     int length = softrig_encode(&frame, softrig_session_seed(dictionary_crc, session), wire, sizeof wire);
 *
 * Functions that return a count or 0 for success return -1 when an argument is outside its range, a buffer is too small
 * or the bytes are damaged; they never write or read beyond a buffer.
 */
#ifndef SOFTRIG_H
#define SOFTRIG_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define SOFTRIG_VERSION 2
#define SOFTRIG_RELIABLE 1u /* flags */
#define SOFTRIG_NODE 2u
#define SOFTRIG_SEALED 4u
#define SOFTRIG_RESERVED 8u
#define SOFTRIG_HEAD_BYTES 4u
#define SOFTRIG_TAG_BYTES 8u
#define SOFTRIG_CRC_BYTES 4u
#define SOFTRIG_BODY_MIN 8u
#define SOFTRIG_BODY_MAX 253u
#define SOFTRIG_PAYLOAD_MAX 236u
#define SOFTRIG_FRAME_MAX 255u /* on the wire: stuffed, with the zero that ends it */
#define SOFTRIG_GREETINGS_BELOW 16u
#define SOFTRIG_OPEN_FROM 80u
#define SOFTRIG_OPEN_BELOW 96u
#define SOFTRIG_WINDOW 32u
#define SOFTRIG_START_AT_ONCE 0u
#define SOFTRIG_START_AT_SYNC 4294967295u
#define SOFTRIG_STOP_BYTES 6u
#define SOFTRIG_STOP {0x00, 0x53, 0x54, 0x4F, 0x50, 0x00} /* initialises uint8_t[SOFTRIG_STOP_BYTES] */

enum {
    SOFTRIG_KIND_HELLO = 0x01,
    SOFTRIG_KIND_IDENTITY = 0x02,
    SOFTRIG_KIND_DICTIONARY = 0x03,
    SOFTRIG_KIND_DICTIONARY_PAGE = 0x04,
    SOFTRIG_KIND_STOPPED = 0x05,
    SOFTRIG_KIND_NAK = 0x06,
    SOFTRIG_KIND_SYNC = 0x07,
    SOFTRIG_KIND_WATCH = 0x08,
    SOFTRIG_KIND_ALIVE = 0x10,
    SOFTRIG_KIND_ARM = 0x11,
    SOFTRIG_KIND_DISARM = 0x12,
    SOFTRIG_KIND_CLEAR = 0x13,
    SOFTRIG_KIND_FIRE = 0x14,
    SOFTRIG_KIND_STATUS_REQUEST = 0x15,
    SOFTRIG_KIND_SUBSCRIBE = 0x16,
    SOFTRIG_KIND_FAULTS_REQUEST = 0x17,
    SOFTRIG_KIND_CLEAR_FAULTS = 0x1B,
    SOFTRIG_KIND_SETTINGS_REQUEST = 0x19,
    SOFTRIG_KIND_SET = 0x1A,
    SOFTRIG_KIND_CALIBRATE = 0x1C,
    SOFTRIG_KIND_COILS_REQUEST = 0x18,
    SOFTRIG_KIND_SERVICE = 0x1D,
    SOFTRIG_KIND_CLOCK_REQUEST = 0x1E,
    SOFTRIG_KIND_PROGRAM = 0x20,
    SOFTRIG_KIND_CODE = 0x21,
    SOFTRIG_KIND_START = 0x22,
    SOFTRIG_KIND_CANCEL = 0x23,
    SOFTRIG_KIND_MOVE = 0x24,
    SOFTRIG_KIND_ORIENT = 0x25,
    SOFTRIG_KIND_PRESS = 0x26,
    SOFTRIG_KIND_PAUSE = 0x27,
    SOFTRIG_KIND_OK = 0x40,
    SOFTRIG_KIND_REFUSED = 0x41,
    SOFTRIG_KIND_STATUS = 0x42,
    SOFTRIG_KIND_FAULTS = 0x43,
    SOFTRIG_KIND_SETTINGS = 0x44,
    SOFTRIG_KIND_COILS = 0x45,
    SOFTRIG_KIND_EVENT = 0x4F,
    SOFTRIG_KIND_TELEMETRY = 0x50,
    SOFTRIG_KIND_BEACON = 0x58,
    SOFTRIG_KIND_BEACON_COILS = 0x59,
    SOFTRIG_KIND_CLOCK = 0x5E
};

enum {
    SOFTRIG_STATES_BOOT = 0,
    SOFTRIG_STATES_IDLE = 1,
    SOFTRIG_STATES_ARMED = 2,
    SOFTRIG_STATES_RUNNING = 3,
    SOFTRIG_STATES_TRIPPED = 4
};

enum {
    SOFTRIG_EVENTS_STARTED = 1,
    SOFTRIG_EVENTS_STEP = 2,
    SOFTRIG_EVENTS_FINISHED = 3,
    SOFTRIG_EVENTS_ABORTED = 4,
    SOFTRIG_EVENTS_TRIPPED = 5,
    SOFTRIG_EVENTS_DISARMED = 6,
    SOFTRIG_EVENTS_CLEARED = 7,
    SOFTRIG_EVENTS_CUT_OFF = 8,
    SOFTRIG_EVENTS_LOST = 9,
    SOFTRIG_EVENTS_DEFAULTS = 10,
    SOFTRIG_EVENTS_ACCEPTED = 11,
    SOFTRIG_EVENTS_STEP_DONE = 12,
    SOFTRIG_EVENTS_PAUSED = 13,
    SOFTRIG_EVENTS_RESUMED = 14,
    SOFTRIG_EVENTS_NOTED = 15,
    SOFTRIG_EVENTS_CAUGHT = 16
};

enum {
    SOFTRIG_ROLES_VIEWER = 0,
    SOFTRIG_ROLES_HOLDER = 1
};

enum {
    SOFTRIG_SECURED_NO = 0,
    SOFTRIG_SECURED_PAIRED = 1,
    SOFTRIG_SECURED_DAMAGED = 2
};

enum {
    SOFTRIG_PARTS_DEFINITIONS = 0,
    SOFTRIG_PARTS_HELP = 1
};

enum {
    SOFTRIG_PAUSES_PAUSE = 0,
    SOFTRIG_PAUSES_RESUME = 1,
    SOFTRIG_PAUSES_STEP = 2
};

enum {
    SOFTRIG_CAUSES_POWER_ON = 1,
    SOFTRIG_CAUSES_RESET = 3
};

enum {
    SOFTRIG_SETTING_NAMES_NODE = 0,
    SOFTRIG_SETTING_NAMES_BOARD_OFFSET_DECIDEGC = 1,
    SOFTRIG_SETTING_NAMES_RESISTANCE_MOHM = 2
};

enum {
    SOFTRIG_SETTING_SOURCES_DEFAULTS = 0,
    SOFTRIG_SETTING_SOURCES_STORED = 1,
    SOFTRIG_SETTING_SOURCES_DAMAGED = 2
};

enum {
    SOFTRIG_CODES_R01 = 1,
    SOFTRIG_CODES_R02 = 2,
    SOFTRIG_CODES_R03 = 3,
    SOFTRIG_CODES_R04 = 4,
    SOFTRIG_CODES_R05 = 5,
    SOFTRIG_CODES_R06 = 6,
    SOFTRIG_CODES_R07 = 7,
    SOFTRIG_CODES_R08 = 8,
    SOFTRIG_CODES_R09 = 9,
    SOFTRIG_CODES_R10 = 10,
    SOFTRIG_CODES_R11 = 11,
    SOFTRIG_CODES_R12 = 12,
    SOFTRIG_CODES_R13 = 13,
    SOFTRIG_CODES_R14 = 14,
    SOFTRIG_CODES_R15 = 15,
    SOFTRIG_CODES_R16 = 16,
    SOFTRIG_CODES_R17 = 17,
    SOFTRIG_CODES_R18 = 18,
    SOFTRIG_CODES_R19 = 19,
    SOFTRIG_CODES_R20 = 20,
    SOFTRIG_CODES_R21 = 21,
    SOFTRIG_CODES_R22 = 22,
    SOFTRIG_CODES_R23 = 23,
    SOFTRIG_CODES_R24 = 24,
    SOFTRIG_CODES_R25 = 25,
    SOFTRIG_CODES_R26 = 26,
    SOFTRIG_CODES_R27 = 27,
    SOFTRIG_CODES_R28 = 28,
    SOFTRIG_CODES_R29 = 29,
    SOFTRIG_CODES_R30 = 30,
    SOFTRIG_CODES_R31 = 31,
    SOFTRIG_CODES_R32 = 32,
    SOFTRIG_CODES_R33 = 33,
    SOFTRIG_CODES_R34 = 34,
    SOFTRIG_CODES_R35 = 35,
    SOFTRIG_CODES_R36 = 36,
    SOFTRIG_CODES_R37 = 37,
    SOFTRIG_CODES_R38 = 38,
    SOFTRIG_CODES_F01 = 101,
    SOFTRIG_CODES_F02 = 102,
    SOFTRIG_CODES_F03 = 103,
    SOFTRIG_CODES_F04 = 104,
    SOFTRIG_CODES_F05 = 105,
    SOFTRIG_CODES_F06 = 106,
    SOFTRIG_CODES_F07 = 107,
    SOFTRIG_CODES_F08 = 108,
    SOFTRIG_CODES_F09 = 109,
    SOFTRIG_CODES_F10 = 110,
    SOFTRIG_CODES_F11 = 111,
    SOFTRIG_CODES_F12 = 112,
    SOFTRIG_CODES_F13 = 113,
    SOFTRIG_CODES_F14 = 114,
    SOFTRIG_CODES_F15 = 115,
    SOFTRIG_CODES_F16 = 116,
    SOFTRIG_CODES_F17 = 117,
    SOFTRIG_CODES_F18 = 118,
    SOFTRIG_CODES_F19 = 119,
    SOFTRIG_CODES_F20 = 120,
    SOFTRIG_CODES_F21 = 121,
    SOFTRIG_CODES_F22 = 122,
    SOFTRIG_CODES_F23 = 123,
    SOFTRIG_CODES_F24 = 124,
    SOFTRIG_CODES_F25 = 125,
    SOFTRIG_CODES_F26 = 126,
    SOFTRIG_CODES_F27 = 127,
    SOFTRIG_CODES_F28 = 128,
    SOFTRIG_CODES_F29 = 129,
    SOFTRIG_CODES_F30 = 130
};

/* Bytes that belong to somebody else. */
typedef struct softrig_bytes {
    const uint8_t *at;
    size_t size;
} softrig_bytes;

/* A frame: what the body says. `payload` lies in the buffer that it was decoded from. */
typedef struct softrig_frame {
    uint8_t flags;
    uint8_t kind;
    uint8_t seq;
    uint8_t ack;
    uint8_t node;
    softrig_bytes payload;
} softrig_frame;

/* ---- little endian ---- */

static inline void softrig_put16(uint8_t *out, uint16_t value)
{
    out[0] = (uint8_t)(value & 0xFFu);
    out[1] = (uint8_t)(value >> 8);
}

static inline void softrig_put32(uint8_t *out, uint32_t value)
{
    softrig_put16(out, (uint16_t)(value & 0xFFFFu));
    softrig_put16(out + 2, (uint16_t)(value >> 16));
}

static inline uint16_t softrig_get16(const uint8_t *in)
{
    return (uint16_t)(in[0] | (uint16_t)(in[1] << 8));
}

static inline uint32_t softrig_get32(const uint8_t *in)
{
    return softrig_get16(in) | (uint32_t)softrig_get16(in + 2) << 16;
}

static inline int8_t softrig_signed8(uint8_t value)
{
    return (int8_t)(value < 0x80u ? value : (int)value - 0x100);
}

static inline int16_t softrig_signed16(uint16_t value)
{
    return (int16_t)(value < 0x8000u ? value : (int32_t)value - 0x10000);
}

static inline int32_t softrig_signed32(uint32_t value)
{
    return value < 0x80000000u ? (int32_t)value : -1 - (int32_t)(0xFFFFFFFFu - value);
}

/* ---- CRC-32, as in zip and Ethernet, started from the CRC of what stands before ---- */

static inline uint32_t softrig_crc32(const uint8_t *data, size_t size, uint32_t start)
{
    uint32_t crc = start ^ 0xFFFFFFFFu;
    size_t i;
    int bit;
    for (i = 0; i < size; i++) {
        crc ^= data[i];
        for (bit = 0; bit < 8; bit++)
            crc = crc >> 1 ^ (0xEDB88320u & (0u - (crc & 1u)));
    }
    return crc ^ 0xFFFFFFFFu;
}

/* What the CRC of the frames of a session starts from. */
static inline uint32_t softrig_session_seed(uint32_t dictionary_crc, uint32_t session)
{
    uint8_t number[4];
    softrig_put32(number, session);
    return softrig_crc32(number, sizeof number, dictionary_crc);
}

/* What the CRC of a frame of this kind starts from. */
static inline uint32_t softrig_seed_of(uint8_t kind, uint32_t dictionary_crc, uint32_t session_seed)
{
    if (kind < SOFTRIG_GREETINGS_BELOW)
        return 0;
    return kind >= SOFTRIG_OPEN_FROM && kind < SOFTRIG_OPEN_BELOW ? dictionary_crc : session_seed;
}

/* ---- COBS ---- */

/* Stuff a body of at most SOFTRIG_BODY_MAX bytes and end it with a zero; return the bytes on the wire. */
static inline int softrig_stuff(const uint8_t *body, size_t size, uint8_t *wire, size_t room)
{
    size_t i, run = 0, at = 1;
    if (size > SOFTRIG_BODY_MAX || room < size + 2)
        return -1;
    for (i = 0; i < size; i++) {
        if (body[i] != 0) {
            wire[at++] = body[i];
        } else {
            wire[run] = (uint8_t)(at - run);
            run = at++;
        }
    }
    wire[run] = (uint8_t)(at - run);
    wire[at++] = 0;
    return (int)at;
}

/* Undo the stuffing of a frame without the zero that ended it, into `body`; return the bytes of the body. */
static inline int softrig_unstuff(const uint8_t *wire, size_t size, uint8_t *body, size_t room)
{
    size_t at = 0, length = 0;
    while (at < size) {
        size_t end = at + wire[at], zero = at > 0 ? 1 : 0;
        if (end == at || end > size || length + zero + (end - at - 1) > room)
            return -1;
        if (zero)
            body[length++] = 0;
        memcpy(body + length, wire + at + 1, end - at - 1);
        length += end - at - 1;
        at = end;
    }
    return (int)length;
}

/* ---- SHA-256 (FIPS 180-4) and HMAC (RFC 2104), for robots with a pairing key ---- */

typedef struct softrig_sha256 {
    uint32_t state[8];
    uint8_t block[64];
    uint64_t size;
} softrig_sha256;

static inline uint32_t softrig_turned(uint32_t value, unsigned bits)
{
    return value >> bits | value << (32u - bits);
}

static inline void softrig_sha256_begin(softrig_sha256 *sha)
{
    static const uint32_t first[8] = {0x6A09E667u, 0xBB67AE85u, 0x3C6EF372u, 0xA54FF53Au,
                                      0x510E527Fu, 0x9B05688Cu, 0x1F83D9ABu, 0x5BE0CD19u};
    memcpy(sha->state, first, sizeof first);
    sha->size = 0;
}

static inline void softrig_sha256_block(softrig_sha256 *sha)
{
    static const uint32_t k[64] = {
        0x428A2F98u, 0x71374491u, 0xB5C0FBCFu, 0xE9B5DBA5u, 0x3956C25Bu, 0x59F111F1u,
        0x923F82A4u, 0xAB1C5ED5u, 0xD807AA98u, 0x12835B01u, 0x243185BEu, 0x550C7DC3u,
        0x72BE5D74u, 0x80DEB1FEu, 0x9BDC06A7u, 0xC19BF174u, 0xE49B69C1u, 0xEFBE4786u,
        0x0FC19DC6u, 0x240CA1CCu, 0x2DE92C6Fu, 0x4A7484AAu, 0x5CB0A9DCu, 0x76F988DAu,
        0x983E5152u, 0xA831C66Du, 0xB00327C8u, 0xBF597FC7u, 0xC6E00BF3u, 0xD5A79147u,
        0x06CA6351u, 0x14292967u, 0x27B70A85u, 0x2E1B2138u, 0x4D2C6DFCu, 0x53380D13u,
        0x650A7354u, 0x766A0ABBu, 0x81C2C92Eu, 0x92722C85u, 0xA2BFE8A1u, 0xA81A664Bu,
        0xC24B8B70u, 0xC76C51A3u, 0xD192E819u, 0xD6990624u, 0xF40E3585u, 0x106AA070u,
        0x19A4C116u, 0x1E376C08u, 0x2748774Cu, 0x34B0BCB5u, 0x391C0CB3u, 0x4ED8AA4Au,
        0x5B9CCA4Fu, 0x682E6FF3u, 0x748F82EEu, 0x78A5636Fu, 0x84C87814u, 0x8CC70208u,
        0x90BEFFFAu, 0xA4506CEBu, 0xBEF9A3F7u, 0xC67178F2u
    };
    uint32_t w[64], s[8], a, b;
    unsigned i;
    for (i = 0; i < 64; i++) {
        if (i < 16) {
            const uint8_t *in = sha->block + 4 * i;
            w[i] = (uint32_t)in[0] << 24 | (uint32_t)in[1] << 16 | (uint32_t)in[2] << 8 | in[3];
        } else {
            a = softrig_turned(w[i - 15], 7) ^ softrig_turned(w[i - 15], 18) ^ w[i - 15] >> 3;
            b = softrig_turned(w[i - 2], 17) ^ softrig_turned(w[i - 2], 19) ^ w[i - 2] >> 10;
            w[i] = w[i - 16] + a + w[i - 7] + b;
        }
    }
    memcpy(s, sha->state, sizeof s);
    for (i = 0; i < 64; i++) {
        a = softrig_turned(s[4], 6) ^ softrig_turned(s[4], 11) ^ softrig_turned(s[4], 25);
        a += s[7] + ((s[4] & s[5]) ^ (~s[4] & s[6])) + k[i] + w[i];
        b = softrig_turned(s[0], 2) ^ softrig_turned(s[0], 13) ^ softrig_turned(s[0], 22);
        b += (s[0] & s[1]) ^ (s[0] & s[2]) ^ (s[1] & s[2]);
        memmove(s + 1, s, 7 * sizeof *s);
        s[4] += a;
        s[0] = a + b;
    }
    for (i = 0; i < 8; i++)
        sha->state[i] += s[i];
}

static inline void softrig_sha256_add(softrig_sha256 *sha, const uint8_t *data, size_t size)
{
    size_t i;
    for (i = 0; i < size; i++) {
        sha->block[sha->size++ & 63u] = data[i];
        if ((sha->size & 63u) == 0)
            softrig_sha256_block(sha);
    }
}

static inline void softrig_sha256_end(softrig_sha256 *sha, uint8_t digest[32])
{
    static const uint8_t one = 0x80, zero = 0;
    uint64_t bits = sha->size * 8u;
    uint8_t length[8];
    unsigned i;
    softrig_sha256_add(sha, &one, 1);
    while ((sha->size & 63u) != 56u)
        softrig_sha256_add(sha, &zero, 1);
    for (i = 0; i < 8; i++)
        length[i] = (uint8_t)(bits >> (56u - 8u * i) & 0xFFu);
    softrig_sha256_add(sha, length, sizeof length);
    for (i = 0; i < 32; i++)
        digest[i] = (uint8_t)(sha->state[i / 4] >> (24u - 8u * (i % 4)) & 0xFFu);
}

/* HMAC-SHA256 over `head` and `body` with a key of at most 64 bytes; return 0. */
static inline int softrig_hmac(softrig_bytes key, softrig_bytes head, softrig_bytes body, uint8_t digest[32])
{
    softrig_sha256 sha;
    uint8_t pad[64];
    unsigned side, i;
    if (key.size > sizeof pad)
        return -1;
    for (side = 0; side < 2; side++) {
        for (i = 0; i < sizeof pad; i++)
            pad[i] = (uint8_t)((i < key.size ? key.at[i] : 0u) ^ (side ? 0x5Cu : 0x36u));
        softrig_sha256_begin(&sha);
        softrig_sha256_add(&sha, pad, sizeof pad);
        if (side) {
            softrig_sha256_add(&sha, digest, 32);
        } else {
            softrig_sha256_add(&sha, head.at, head.size);
            softrig_sha256_add(&sha, body.at, body.size);
        }
        softrig_sha256_end(&sha, digest);
    }
    return 0;
}

/* Make the key of a session from the pairing key, the payload of `hello`, and what `identity` said; return 0. */
static inline int softrig_session_key(softrig_bytes pairing_key, softrig_bytes hello, uint32_t nonce_a, uint32_t nonce_b,
                                      uint32_t dictionary_crc, uint8_t key[32])
{
    static const uint8_t words[] = "softrig session";
    uint8_t head[sizeof words - 1 + SOFTRIG_PAYLOAD_MAX], said[12];
    softrig_bytes both = {head, sizeof words - 1 + hello.size}, body = {said, sizeof said};
    if (hello.size > SOFTRIG_PAYLOAD_MAX)
        return -1;
    memcpy(head, words, sizeof words - 1);
    memcpy(head + sizeof words - 1, hello.at, hello.size);
    softrig_put32(said, nonce_a);
    softrig_put32(said + 4, nonce_b);
    softrig_put32(said + 8, dictionary_crc);
    return softrig_hmac(pairing_key, both, body, key);
}

/* Make the two numbers by which the robot shows in `identity` that it made the same key of the session. */
static inline int softrig_proof(const uint8_t key[32], uint32_t *a, uint32_t *b)
{
    static const uint8_t words[] = "softrig proof";
    softrig_bytes secret = {key, 32}, head = {words, sizeof words - 1}, none = {key, 0};
    uint8_t digest[32];
    int status = softrig_hmac(secret, head, none, digest);
    *a = softrig_get32(digest);
    *b = softrig_get32(digest + 4);
    return status;
}

/* Make the tag of a frame: `number` is its seq counted on beyond 255, `body` all of it that goes before the tag. */
static inline int softrig_tag(const uint8_t key[32], int from_robot, uint32_t number, softrig_bytes body, uint8_t *tag)
{
    uint8_t said[5], digest[32];
    softrig_bytes secret = {key, 32}, head = {said, sizeof said};
    said[0] = from_robot ? 1 : 0;
    softrig_put32(said + 1, number);
    if (softrig_hmac(secret, head, body, digest) != 0)
        return -1;
    memcpy(tag, digest, SOFTRIG_TAG_BYTES);
    return 0;
}

/* ---- bodies ---- */

/* Write a body: with a `key` (of the session, or NULL) it gets a tag; return its bytes. SOFTRIG_NODE and
 * SOFTRIG_SEALED need not be in `flags`. `seed` is that of the frame's kind: softrig_seed_of. */
static inline int softrig_seal(const softrig_frame *frame, uint32_t seed, const uint8_t *key, int from_robot,
                               uint32_t number, uint8_t *body, size_t room)
{
    size_t at = SOFTRIG_HEAD_BYTES;
    unsigned flags = frame->flags & SOFTRIG_RELIABLE;
    size_t size = SOFTRIG_BODY_MIN + (frame->node ? 1u : 0u) + frame->payload.size + (key ? SOFTRIG_TAG_BYTES : 0u);
    if (frame->payload.size > SOFTRIG_PAYLOAD_MAX || size > room)
        return -1;
    flags |= (frame->node ? SOFTRIG_NODE : 0u) | (key ? SOFTRIG_SEALED : 0u);
    body[0] = (uint8_t)(SOFTRIG_VERSION << 4 | flags);
    body[1] = frame->kind;
    body[2] = frame->seq;
    body[3] = frame->ack;
    if (frame->node)
        body[at++] = frame->node;
    if (frame->payload.size)
        memcpy(body + at, frame->payload.at, frame->payload.size);
    at += frame->payload.size;
    if (key) {
        softrig_bytes covered = {body, at};
        if (softrig_tag(key, from_robot, number, covered, body + at) != 0)
            return -1;
        at += SOFTRIG_TAG_BYTES;
    }
    softrig_put32(body + at, softrig_crc32(body, at, seed));
    return (int)(at + SOFTRIG_CRC_BYTES);
}

/* Read a body; `frame->payload` lies in it. The tag of a SOFTRIG_SEALED frame is for softrig_verified. Return 0. */
static inline int softrig_unseal(const uint8_t *body, size_t size, uint32_t dictionary_crc, uint32_t session_seed,
                                 softrig_frame *frame)
{
    size_t from = SOFTRIG_HEAD_BYTES, to;
    if (size < SOFTRIG_BODY_MIN || size > SOFTRIG_BODY_MAX)
        return -1;
    to = size - SOFTRIG_CRC_BYTES;
    frame->flags = (uint8_t)(body[0] & 15u);
    frame->kind = body[1];
    frame->seq = body[2];
    frame->ack = body[3];
    frame->node = 0;
    if (frame->kind >= SOFTRIG_GREETINGS_BELOW && (body[0] >> 4 != SOFTRIG_VERSION || frame->flags & SOFTRIG_RESERVED))
        return -1;
    if (softrig_crc32(body, to, softrig_seed_of(frame->kind, dictionary_crc, session_seed)) != softrig_get32(body + to))
        return -1;
    if (frame->flags & SOFTRIG_NODE) {
        if (from == to)
            return -1;
        frame->node = body[from++];
    }
    if (frame->flags & SOFTRIG_SEALED) {
        if (to - from < SOFTRIG_TAG_BYTES)
            return -1;
        to -= SOFTRIG_TAG_BYTES;
    }
    frame->payload.at = body + from;
    frame->payload.size = to - from;
    return 0;
}

/* Return 0 when a body that softrig_unseal has read carries the tag of this number, in time that tells nothing. */
static inline int softrig_verified(const uint8_t *body, size_t size, const uint8_t key[32], int from_robot,
                                   uint32_t number)
{
    uint8_t tag[SOFTRIG_TAG_BYTES];
    softrig_bytes covered = {body, 0};
    unsigned differing = 0, i;
    if (size < SOFTRIG_BODY_MIN + SOFTRIG_TAG_BYTES || !(body[0] & SOFTRIG_SEALED))
        return -1;
    covered.size = size - SOFTRIG_CRC_BYTES - SOFTRIG_TAG_BYTES;
    if (softrig_tag(key, from_robot, number, covered, tag) != 0)
        return -1;
    for (i = 0; i < SOFTRIG_TAG_BYTES; i++)
        differing |= (unsigned)(tag[i] ^ body[covered.size + i]);
    return differing ? -1 : 0;
}

/* Write a frame of no pairing key as it goes on the wire; return its bytes. */
static inline int softrig_encode(const softrig_frame *frame, uint32_t seed, uint8_t *wire, size_t room)
{
    uint8_t body[SOFTRIG_BODY_MAX];
    int size = softrig_seal(frame, seed, NULL, 0, 0, body, sizeof body);
    return size < 0 ? -1 : softrig_stuff(body, (size_t)size, wire, room);
}

/* ---- what arrives ---- */

/* Collects bytes into bodies, and finds the stop pattern among them. Begin with all zeros. */
typedef struct softrig_decoder {
    uint8_t wire[SOFTRIG_FRAME_MAX];
    uint8_t body[SOFTRIG_BODY_MAX]; /* the last one */
    size_t held;
    int skipping;
    uint32_t dropped; /* damaged ones */
    unsigned stopping; /* bytes of the stop pattern that have just come */
} softrig_decoder;

/* Take a byte; return the bytes of the body that it completed, which lies in decoder->body, else 0. */
static inline int softrig_feed(softrig_decoder *decoder, uint8_t byte)
{
    int size = 0;
    if (byte != 0) {
        if (decoder->held < sizeof decoder->wire - 1)
            decoder->wire[decoder->held++] = byte;
        else
            decoder->skipping = 1;
        return 0;
    }
    if (decoder->skipping || (decoder->held > 0 && !(decoder->held == 4 && memcmp(decoder->wire, "STOP", 4) == 0))) {
        size = decoder->skipping ? -1 : softrig_unstuff(decoder->wire, decoder->held, decoder->body, sizeof decoder->body);
        if (size < (int)SOFTRIG_BODY_MIN) {
            decoder->dropped++;
            size = 0;
        }
    }
    decoder->held = 0;
    decoder->skipping = 0;
    return size;
}

/* Take a byte; return 1 when it completes the stop pattern. A robot looks for it before it decodes anything. */
static inline int softrig_is_stop(softrig_decoder *decoder, uint8_t byte)
{
    static const uint8_t stop[SOFTRIG_STOP_BYTES] = SOFTRIG_STOP;
    if (byte == stop[decoder->stopping])
        decoder->stopping++;
    else
        decoder->stopping = byte == stop[0];
    if (decoder->stopping < SOFTRIG_STOP_BYTES)
        return 0;
    decoder->stopping = 1; /* its last zero may begin the next */
    return 1;
}

/* ---- CAN: bodies in segments; the stop is a standard frame with identifier 0 and the data STOP, and a `sync` is one
 * frame with its identifier and the data SYNC ---- */

#define SOFTRIG_CAN_ALL 127u /* node of every robot, and of every host */
#define SOFTRIG_CAN_HOST 1u /* node of a host that was not given one */
#define SOFTRIG_CAN_CLASSIC 8u /* bytes of data in a frame */
#define SOFTRIG_CAN_FD 64u

/* Return the 29-bit identifier of the frames of a body. */
static inline uint32_t softrig_can_identifier(uint8_t kind, unsigned robot, unsigned host, int from_robot)
{
    uint32_t priority = from_robot ? 3u : 2u;
    if (kind == SOFTRIG_KIND_SYNC)
        priority = 1u;
    else if (kind < SOFTRIG_GREETINGS_BELOW && kind != SOFTRIG_KIND_STOPPED)
        priority = 4u;
    else if (kind >= SOFTRIG_OPEN_FROM && kind < SOFTRIG_OPEN_BELOW)
        priority = 6u;
    return priority << 26 | (uint32_t)kind << 18 | (from_robot ? 1ul << 17 : 0ul) | (uint32_t)robot << 10 | (uint32_t)host << 3;
}

/* Write the data of the next CAN frame of a body; `mtu` is SOFTRIG_CAN_CLASSIC or SOFTRIG_CAN_FD. `at` begins at 0 for
 * each body, `counter` at 0 for each sender. Return the bytes of data, 0 when all of the body has been sent. */
static inline int softrig_can_segment(const uint8_t *body, size_t size, size_t mtu, size_t *at, unsigned *counter, uint8_t *data)
{
    static const uint8_t lengths[] = {12, 16, 20, 24, 32, 48, 64};
    size_t used = 1, left, i;
    if (*at >= size)
        return 0;
    data[0] = (uint8_t)((*at == 0 ? 0x80u : 0u) | (*counter & 0x3Fu));
    if (*at == 0 && mtu == SOFTRIG_CAN_FD)
        data[used++] = (uint8_t)size;
    left = size - *at < mtu - used ? size - *at : mtu - used;
    memcpy(data + used, body + *at, left);
    used += left;
    *at += left;
    *counter = (*counter + 1) & 0x3Fu;
    if (*at == size)
        data[0] |= 0x40u;
    for (i = 0; used > 8 && used != lengths[i];) {
        if (used > lengths[i])
            i++;
        else
            data[used++] = 0;
    }
    return (int)used;
}

/* Puts together what one sender sends, one body at a time. Begin with all zeros. */
typedef struct softrig_can_joiner {
    uint8_t body[SOFTRIG_BODY_MAX + SOFTRIG_CAN_FD];
    size_t held;
    size_t told; /* length of the body, on CAN FD */
    uint32_t identifier;
    unsigned counter;
    int open;
} softrig_can_joiner;

/* Take the data of a CAN frame; return the bytes of the body that it completes, which lies in joiner->body, else 0. */
static inline int softrig_can_join(softrig_can_joiner *joiner, uint32_t identifier, const uint8_t *data, size_t size, int fd)
{
    size_t used = 1;
    if (size < 1 || size > SOFTRIG_CAN_FD)
        return 0;
    if (data[0] & 0x80u) {
        joiner->open = 1;
        joiner->held = 0;
        joiner->identifier = identifier;
        joiner->told = fd && size > 1 ? data[used++] : 0u;
    } else if (joiner->open && identifier == joiner->identifier && (data[0] & 0x7Fu) == joiner->counter) {
        return 0; /* it came twice */
    } else if (!joiner->open || identifier != joiner->identifier || (data[0] & 0x3Fu) != ((joiner->counter + 1) & 0x3Fu)) {
        joiner->open = 0;
        return 0;
    }
    joiner->counter = data[0] & 0x3Fu;
    if (joiner->held + (size - used) > sizeof joiner->body) {
        joiner->open = 0;
        return 0;
    }
    memcpy(joiner->body + joiner->held, data + used, size - used);
    joiner->held += size - used;
    if (!(data[0] & 0x40u))
        return 0;
    joiner->open = 0;
    if (joiner->told > joiner->held || (joiner->told ? joiner->told : joiner->held) > SOFTRIG_BODY_MAX)
        return 0;
    return (int)(joiner->told ? joiner->told : joiner->held);
}

/* ---- messages ---- */

/* 0x01 hello: Opens a session; the answer is identity. Never disturbs a program that is running. */
#define SOFTRIG_HELLO_BYTES 17u
typedef struct softrig_hello {
    uint8_t version; /* Protocol version of the host. */
    uint32_t session; /* Number the host chose for this session. */
    uint32_t attach; /* The session whose lease and program are to be taken over, 0: none. */
    uint32_t nonce_a; /* The host's part of the session key, and */
    uint32_t nonce_b; /* its other half. */
} softrig_hello;

static inline int softrig_pack_hello(const softrig_hello *in, uint8_t *out, size_t room)
{
    if (room < SOFTRIG_HELLO_BYTES)
        return -1;
    out[0] = in->version;
    softrig_put32(out + 1, in->session);
    softrig_put32(out + 5, in->attach);
    softrig_put32(out + 9, in->nonce_a);
    softrig_put32(out + 13, in->nonce_b);
    return (int)SOFTRIG_HELLO_BYTES;
}

static inline int softrig_unpack_hello(softrig_hello *out, softrig_bytes payload)
{
    if (payload.size != SOFTRIG_HELLO_BYTES)
        return -1;
    out->version = payload.at[0];
    out->session = softrig_get32(payload.at + 1);
    out->attach = softrig_get32(payload.at + 5);
    out->nonce_a = softrig_get32(payload.at + 9);
    out->nonce_b = softrig_get32(payload.at + 13);
    return 0;
}

/* 0x02 identity: Who the robot is; answers hello. */
#define SOFTRIG_IDENTITY_BYTES 52u /* at least */
typedef struct softrig_identity {
    uint32_t session; /* The session that said hello. */
    uint32_t boot; /* Number of this start of the firmware; a reset may draw the same again, see uptime_ms. */
    uint32_t uptime_ms; /* Time since this start: less than the host expects after a reset. */
    uint32_t dictionary_crc; /* CRC-32 of the dictionary text: the seed of open frames. */
    uint16_t dictionary_bytes; /* Length of the dictionary text. */
    uint8_t version; /* Protocol version of the robot. */
    uint8_t state; /* State of the robot. SOFTRIG_STATES_... */
    uint8_t role; /* What this session may do: only the holder may give orders. SOFTRIG_ROLES_... */
    uint8_t node; /* The robot's number on a shared line, 0: none. */
    uint8_t secured; /* Whether orders must carry tags; with a damaged key there are none. SOFTRIG_SECURED_... */
    uint8_t slots; /* Credit to begin with: frames that may wait for their acknowledgement. 0 to 32. */
    uint16_t bytes; /* Credit to begin with: bytes of them on the line. */
    uint32_t byte_ns; /* Time of a byte on the line, 0: not known. */
    uint32_t holder; /* The session that holds the lease, or whose program runs, 0: none. */
    uint16_t step; /* Step of the program, 0: none. */
    uint32_t nonce_a; /* The robot's part of the session key, and */
    uint32_t nonce_b; /* its other half. */
    uint32_t proof_a; /* Shows a host that has the pairing key that the robot has it too, 0: not secured, and */
    uint32_t proof_b; /* its other half. */
    softrig_bytes firmware; /* Version of the firmware, text. */
} softrig_identity;

static inline int softrig_pack_identity(const softrig_identity *in, uint8_t *out, size_t room)
{
    if (in->firmware.size > SOFTRIG_PAYLOAD_MAX - SOFTRIG_IDENTITY_BYTES || room < SOFTRIG_IDENTITY_BYTES + in->firmware.size || in->slots > 32)
        return -1;
    softrig_put32(out, in->session);
    softrig_put32(out + 4, in->boot);
    softrig_put32(out + 8, in->uptime_ms);
    softrig_put32(out + 12, in->dictionary_crc);
    softrig_put16(out + 16, in->dictionary_bytes);
    out[18] = in->version;
    out[19] = in->state;
    out[20] = in->role;
    out[21] = in->node;
    out[22] = in->secured;
    out[23] = in->slots;
    softrig_put16(out + 24, in->bytes);
    softrig_put32(out + 26, in->byte_ns);
    softrig_put32(out + 30, in->holder);
    softrig_put16(out + 34, in->step);
    softrig_put32(out + 36, in->nonce_a);
    softrig_put32(out + 40, in->nonce_b);
    softrig_put32(out + 44, in->proof_a);
    softrig_put32(out + 48, in->proof_b);
    if (in->firmware.size)
        memcpy(out + 52, in->firmware.at, in->firmware.size);
    return (int)(SOFTRIG_IDENTITY_BYTES + in->firmware.size);
}

static inline int softrig_unpack_identity(softrig_identity *out, softrig_bytes payload)
{
    if (payload.size < SOFTRIG_IDENTITY_BYTES)
        return -1;
    out->session = softrig_get32(payload.at);
    out->boot = softrig_get32(payload.at + 4);
    out->uptime_ms = softrig_get32(payload.at + 8);
    out->dictionary_crc = softrig_get32(payload.at + 12);
    out->dictionary_bytes = softrig_get16(payload.at + 16);
    out->version = payload.at[18];
    out->state = payload.at[19];
    out->role = payload.at[20];
    out->node = payload.at[21];
    out->secured = payload.at[22];
    out->slots = payload.at[23];
    out->bytes = softrig_get16(payload.at + 24);
    out->byte_ns = softrig_get32(payload.at + 26);
    out->holder = softrig_get32(payload.at + 30);
    out->step = softrig_get16(payload.at + 34);
    out->nonce_a = softrig_get32(payload.at + 36);
    out->nonce_b = softrig_get32(payload.at + 40);
    out->proof_a = softrig_get32(payload.at + 44);
    out->proof_b = softrig_get32(payload.at + 48);
    out->firmware.at = payload.at + 52;
    out->firmware.size = payload.size - SOFTRIG_IDENTITY_BYTES;
    return 0;
}

/* 0x03 dictionary: Asks for a page of the dictionary text. */
#define SOFTRIG_DICTIONARY_BYTES 4u
typedef struct softrig_dictionary {
    uint8_t part; /* Which text. SOFTRIG_PARTS_... */
    uint16_t offset; /* First byte wanted. */
    uint8_t count; /* How many bytes at most. */
} softrig_dictionary;

static inline int softrig_pack_dictionary(const softrig_dictionary *in, uint8_t *out, size_t room)
{
    if (room < SOFTRIG_DICTIONARY_BYTES)
        return -1;
    out[0] = in->part;
    softrig_put16(out + 1, in->offset);
    out[3] = in->count;
    return (int)SOFTRIG_DICTIONARY_BYTES;
}

static inline int softrig_unpack_dictionary(softrig_dictionary *out, softrig_bytes payload)
{
    if (payload.size != SOFTRIG_DICTIONARY_BYTES)
        return -1;
    out->part = payload.at[0];
    out->offset = softrig_get16(payload.at + 1);
    out->count = payload.at[3];
    return 0;
}

/* 0x04 dictionary_page: A page of the dictionary text. */
#define SOFTRIG_DICTIONARY_PAGE_BYTES 3u /* at least */
typedef struct softrig_dictionary_page {
    uint8_t part; /* Which text. SOFTRIG_PARTS_... */
    uint16_t offset; /* First byte of this page. */
    softrig_bytes text; /* The page; empty beyond the end. */
} softrig_dictionary_page;

static inline int softrig_pack_dictionary_page(const softrig_dictionary_page *in, uint8_t *out, size_t room)
{
    if (in->text.size > SOFTRIG_PAYLOAD_MAX - SOFTRIG_DICTIONARY_PAGE_BYTES || room < SOFTRIG_DICTIONARY_PAGE_BYTES + in->text.size)
        return -1;
    out[0] = in->part;
    softrig_put16(out + 1, in->offset);
    if (in->text.size)
        memcpy(out + 3, in->text.at, in->text.size);
    return (int)(SOFTRIG_DICTIONARY_PAGE_BYTES + in->text.size);
}

static inline int softrig_unpack_dictionary_page(softrig_dictionary_page *out, softrig_bytes payload)
{
    if (payload.size < SOFTRIG_DICTIONARY_PAGE_BYTES)
        return -1;
    out->part = payload.at[0];
    out->offset = softrig_get16(payload.at + 1);
    out->text.at = payload.at + 3;
    out->text.size = payload.size - SOFTRIG_DICTIONARY_PAGE_BYTES;
    return 0;
}

/* 0x05 stopped: Answers the stop pattern once everything is off. */
#define SOFTRIG_STOPPED_BYTES 11u
typedef struct softrig_stopped {
    uint8_t state; /* State of the robot. SOFTRIG_STATES_... */
    uint16_t code; /* Why it is stopped. SOFTRIG_CODES_... */
    uint32_t coils; /* Bit mask of the channels that were driven when the stop arrived. */
    uint32_t now_ms; /* The robot's clock. */
} softrig_stopped;

static inline int softrig_pack_stopped(const softrig_stopped *in, uint8_t *out, size_t room)
{
    if (room < SOFTRIG_STOPPED_BYTES)
        return -1;
    out[0] = in->state;
    softrig_put16(out + 1, in->code);
    softrig_put32(out + 3, in->coils);
    softrig_put32(out + 7, in->now_ms);
    return (int)SOFTRIG_STOPPED_BYTES;
}

static inline int softrig_unpack_stopped(softrig_stopped *out, softrig_bytes payload)
{
    if (payload.size != SOFTRIG_STOPPED_BYTES)
        return -1;
    out->state = payload.at[0];
    out->code = softrig_get16(payload.at + 1);
    out->coils = softrig_get32(payload.at + 3);
    out->now_ms = softrig_get32(payload.at + 7);
    return 0;
}

/* 0x06 nak: A greeting could not be served. */
#define SOFTRIG_NAK_BYTES 4u
typedef struct softrig_nak {
    uint8_t kind; /* Kind of the frame. */
    uint16_t code; /* Why. SOFTRIG_CODES_... */
    uint8_t version; /* Protocol version of the robot. */
} softrig_nak;

static inline int softrig_pack_nak(const softrig_nak *in, uint8_t *out, size_t room)
{
    if (room < SOFTRIG_NAK_BYTES)
        return -1;
    out[0] = in->kind;
    softrig_put16(out + 1, in->code);
    out[3] = in->version;
    return (int)SOFTRIG_NAK_BYTES;
}

static inline int softrig_unpack_nak(softrig_nak *out, softrig_bytes payload)
{
    if (payload.size != SOFTRIG_NAK_BYTES)
        return -1;
    out->kind = payload.at[0];
    out->code = softrig_get16(payload.at + 1);
    out->version = payload.at[3];
    return 0;
}

/* 0x07 sync: To all robots that wait for it: start your program now. Never answered. */
/* It has no payload. */

/* 0x08 watch: Asks, from no session, for the usual variables as slot 4 for the next two seconds. */
#define SOFTRIG_WATCH_BYTES 2u
typedef struct softrig_watch {
    uint16_t period_ms; /* Between two records; the robot takes 50 ms where less is asked. */
} softrig_watch;

static inline int softrig_pack_watch(const softrig_watch *in, uint8_t *out, size_t room)
{
    if (room < SOFTRIG_WATCH_BYTES)
        return -1;
    softrig_put16(out, in->period_ms);
    return (int)SOFTRIG_WATCH_BYTES;
}

static inline int softrig_unpack_watch(softrig_watch *out, softrig_bytes payload)
{
    if (payload.size != SOFTRIG_WATCH_BYTES)
        return -1;
    out->period_ms = softrig_get16(payload.at);
    return 0;
}

/* 0x10 alive: Acknowledges in full, gives credit, and renews the lease like any frame of the session. */
#define SOFTRIG_ALIVE_BYTES 7u
typedef struct softrig_alive {
    uint32_t have; /* Bit i: the frame i + 1 after the next expected one has arrived. */
    uint8_t slots; /* How many frames, from the next expected one on, may be on the way. 0 to 32. */
    uint16_t bytes; /* How many bytes of them. */
} softrig_alive;

static inline int softrig_pack_alive(const softrig_alive *in, uint8_t *out, size_t room)
{
    if (room < SOFTRIG_ALIVE_BYTES || in->slots > 32)
        return -1;
    softrig_put32(out, in->have);
    out[4] = in->slots;
    softrig_put16(out + 5, in->bytes);
    return (int)SOFTRIG_ALIVE_BYTES;
}

static inline int softrig_unpack_alive(softrig_alive *out, softrig_bytes payload)
{
    if (payload.size != SOFTRIG_ALIVE_BYTES)
        return -1;
    out->have = softrig_get32(payload.at);
    out->slots = payload.at[4];
    out->bytes = softrig_get16(payload.at + 5);
    return 0;
}

/* 0x11 arm: Takes the lease and allows orders until it runs out, once coils and joints have passed a self-test. */
#define SOFTRIG_ARM_BYTES 10u
typedef struct softrig_arm {
    uint32_t session; /* The session that asks, as in its hello. */
    uint16_t lease_ms; /* Everything off when nothing arrives for this long; 0 takes the robot's own. */
    uint32_t without; /* Bit mask of coils known to be broken: not tested, and never driven. */
} softrig_arm;

static inline int softrig_pack_arm(const softrig_arm *in, uint8_t *out, size_t room)
{
    if (room < SOFTRIG_ARM_BYTES)
        return -1;
    softrig_put32(out, in->session);
    softrig_put16(out + 4, in->lease_ms);
    softrig_put32(out + 6, in->without);
    return (int)SOFTRIG_ARM_BYTES;
}

static inline int softrig_unpack_arm(softrig_arm *out, softrig_bytes payload)
{
    if (payload.size != SOFTRIG_ARM_BYTES)
        return -1;
    out->session = softrig_get32(payload.at);
    out->lease_ms = softrig_get16(payload.at + 4);
    out->without = softrig_get32(payload.at + 6);
    return 0;
}

/* 0x12 disarm: Everything off, lease returned. */
/* It has no payload. */

/* 0x13 clear: Leaves the tripped state once its cause is gone. */
/* It has no payload. */

/* 0x14 fire: Heat coils for a limited time; the order carries its own end. */
#define SOFTRIG_FIRE_BYTES 8u
typedef struct softrig_fire {
    uint32_t coils; /* Bit mask of channels in the order of the profile. */
    uint16_t duty_permille; /* Share of the PWM period that they are on; 0: off. 0 to 1000. */
    uint16_t hold_ms; /* Off again after this long unless driven anew. */
} softrig_fire;

static inline int softrig_pack_fire(const softrig_fire *in, uint8_t *out, size_t room)
{
    if (room < SOFTRIG_FIRE_BYTES || in->duty_permille > 1000)
        return -1;
    softrig_put32(out, in->coils);
    softrig_put16(out + 4, in->duty_permille);
    softrig_put16(out + 6, in->hold_ms);
    return (int)SOFTRIG_FIRE_BYTES;
}

static inline int softrig_unpack_fire(softrig_fire *out, softrig_bytes payload)
{
    if (payload.size != SOFTRIG_FIRE_BYTES)
        return -1;
    out->coils = softrig_get32(payload.at);
    out->duty_permille = softrig_get16(payload.at + 4);
    out->hold_ms = softrig_get16(payload.at + 6);
    return 0;
}

/* 0x15 status_request: Asks for status. */
/* It has no payload. */

/* 0x16 subscribe: Has the robot send some of its variables as telemetry. */
#define SOFTRIG_SUBSCRIBE_BYTES 4u /* at least */
typedef struct softrig_subscribe {
    uint8_t slot; /* Which of the subscriptions. 0 to 3. */
    uint16_t period_ms; /* Between two records, at the least; 0 ends it. */
    uint8_t on_change; /* 1: only when a value has changed. 0 to 1. */
    softrig_bytes variables; /* Numbers of the variables, u8 each, in the order of the record; none: the usual ones. */
} softrig_subscribe;

static inline int softrig_pack_subscribe(const softrig_subscribe *in, uint8_t *out, size_t room)
{
    if (in->variables.size > SOFTRIG_PAYLOAD_MAX - SOFTRIG_SUBSCRIBE_BYTES || room < SOFTRIG_SUBSCRIBE_BYTES + in->variables.size || in->slot > 3 || in->on_change > 1)
        return -1;
    out[0] = in->slot;
    softrig_put16(out + 1, in->period_ms);
    out[3] = in->on_change;
    if (in->variables.size)
        memcpy(out + 4, in->variables.at, in->variables.size);
    return (int)(SOFTRIG_SUBSCRIBE_BYTES + in->variables.size);
}

static inline int softrig_unpack_subscribe(softrig_subscribe *out, softrig_bytes payload)
{
    if (payload.size < SOFTRIG_SUBSCRIBE_BYTES)
        return -1;
    out->slot = payload.at[0];
    out->period_ms = softrig_get16(payload.at + 1);
    out->on_change = payload.at[3];
    out->variables.at = payload.at + 4;
    out->variables.size = payload.size - SOFTRIG_SUBSCRIBE_BYTES;
    return 0;
}

/* 0x17 faults_request: Asks for faults. */
#define SOFTRIG_FAULTS_REQUEST_BYTES 1u
typedef struct softrig_faults_request {
    uint8_t skip; /* How many of the newest are not wanted. */
} softrig_faults_request;

static inline int softrig_pack_faults_request(const softrig_faults_request *in, uint8_t *out, size_t room)
{
    if (room < SOFTRIG_FAULTS_REQUEST_BYTES)
        return -1;
    out[0] = in->skip;
    return (int)SOFTRIG_FAULTS_REQUEST_BYTES;
}

static inline int softrig_unpack_faults_request(softrig_faults_request *out, softrig_bytes payload)
{
    if (payload.size != SOFTRIG_FAULTS_REQUEST_BYTES)
        return -1;
    out->skip = payload.at[0];
    return 0;
}

/* 0x1B clear_faults: Forgets the faults that were kept; refused while the robot is armed. */
/* It has no payload. */

/* 0x19 settings_request: Asks for settings. */
/* It has no payload. */

/* 0x1A set: Changes a setting and keeps it; refused while the robot is armed. */
#define SOFTRIG_SET_BYTES 6u
typedef struct softrig_set {
    uint8_t setting; /* Which. SOFTRIG_SETTING_NAMES_... */
    uint8_t channel; /* The channel that it belongs to; 255: none. */
    int32_t value; /* Its value, in the unit that ends its name. */
} softrig_set;

static inline int softrig_pack_set(const softrig_set *in, uint8_t *out, size_t room)
{
    if (room < SOFTRIG_SET_BYTES)
        return -1;
    out[0] = in->setting;
    out[1] = in->channel;
    softrig_put32(out + 2, (uint32_t)in->value);
    return (int)SOFTRIG_SET_BYTES;
}

static inline int softrig_unpack_set(softrig_set *out, softrig_bytes payload)
{
    if (payload.size != SOFTRIG_SET_BYTES)
        return -1;
    out->setting = payload.at[0];
    out->channel = payload.at[1];
    out->value = softrig_signed32(softrig_get32(payload.at + 2));
    return 0;
}

/* 0x1C calibrate: Keeps the resistance of every coil, cold and whole, as a self-test measures it. */
#define SOFTRIG_CALIBRATE_BYTES 8u
typedef struct softrig_calibrate {
    uint32_t session; /* The session that asks, as in its hello. */
    uint32_t without; /* Bit mask of coils known to be broken: not tested, and what was kept of them stands. */
} softrig_calibrate;

static inline int softrig_pack_calibrate(const softrig_calibrate *in, uint8_t *out, size_t room)
{
    if (room < SOFTRIG_CALIBRATE_BYTES)
        return -1;
    softrig_put32(out, in->session);
    softrig_put32(out + 4, in->without);
    return (int)SOFTRIG_CALIBRATE_BYTES;
}

static inline int softrig_unpack_calibrate(softrig_calibrate *out, softrig_bytes payload)
{
    if (payload.size != SOFTRIG_CALIBRATE_BYTES)
        return -1;
    out->session = softrig_get32(payload.at);
    out->without = softrig_get32(payload.at + 4);
    return 0;
}

/* 0x18 coils_request: Asks for coils. */
/* It has no payload. */

/* 0x1D service: Restarts the robot in service mode; refused unless everything is off. */
/* It has no payload. */

/* 0x1E clock_request: Asks for clock; posted. */
#define SOFTRIG_CLOCK_REQUEST_BYTES 4u
typedef struct softrig_clock_request {
    uint32_t host_us; /* The host's clock, modulo 2**32. */
} softrig_clock_request;

static inline int softrig_pack_clock_request(const softrig_clock_request *in, uint8_t *out, size_t room)
{
    if (room < SOFTRIG_CLOCK_REQUEST_BYTES)
        return -1;
    softrig_put32(out, in->host_us);
    return (int)SOFTRIG_CLOCK_REQUEST_BYTES;
}

static inline int softrig_unpack_clock_request(softrig_clock_request *out, softrig_bytes payload)
{
    if (payload.size != SOFTRIG_CLOCK_REQUEST_BYTES)
        return -1;
    out->host_us = softrig_get32(payload.at);
    return 0;
}

/* 0x20 program: Begins the upload of a program. */
#define SOFTRIG_PROGRAM_BYTES 0u /* at least */
typedef struct softrig_program {
    softrig_bytes header; /* The program's header, 16 bytes. */
} softrig_program;

static inline int softrig_pack_program(const softrig_program *in, uint8_t *out, size_t room)
{
    if (in->header.size > SOFTRIG_PAYLOAD_MAX - SOFTRIG_PROGRAM_BYTES || room < SOFTRIG_PROGRAM_BYTES + in->header.size)
        return -1;
    if (in->header.size)
        memcpy(out, in->header.at, in->header.size);
    return (int)(SOFTRIG_PROGRAM_BYTES + in->header.size);
}

static inline int softrig_unpack_program(softrig_program *out, softrig_bytes payload)
{
    out->header.at = payload.at;
    out->header.size = payload.size - SOFTRIG_PROGRAM_BYTES;
    return 0;
}

/* 0x21 code: A piece of the program's code. */
#define SOFTRIG_CODE_BYTES 2u /* at least */
typedef struct softrig_code {
    uint16_t offset; /* Its first byte; of a streamed program modulo 65536. */
    softrig_bytes code; /* The piece. */
} softrig_code;

static inline int softrig_pack_code(const softrig_code *in, uint8_t *out, size_t room)
{
    if (in->code.size > SOFTRIG_PAYLOAD_MAX - SOFTRIG_CODE_BYTES || room < SOFTRIG_CODE_BYTES + in->code.size)
        return -1;
    softrig_put16(out, in->offset);
    if (in->code.size)
        memcpy(out + 2, in->code.at, in->code.size);
    return (int)(SOFTRIG_CODE_BYTES + in->code.size);
}

static inline int softrig_unpack_code(softrig_code *out, softrig_bytes payload)
{
    if (payload.size < SOFTRIG_CODE_BYTES)
        return -1;
    out->offset = softrig_get16(payload.at);
    out->code.at = payload.at + 2;
    out->code.size = payload.size - SOFTRIG_CODE_BYTES;
    return 0;
}

/* 0x22 start: Verifies the uploaded program and runs it. */
#define SOFTRIG_START_BYTES 5u
typedef struct softrig_start {
    uint32_t at_ms; /* When, by the robot's clock; 0: at once; 4294967295: at the next sync. */
    uint8_t paused; /* 1: it stands still at its beginning, see pause. 0 to 1. */
} softrig_start;

static inline int softrig_pack_start(const softrig_start *in, uint8_t *out, size_t room)
{
    if (room < SOFTRIG_START_BYTES || in->paused > 1)
        return -1;
    softrig_put32(out, in->at_ms);
    out[4] = in->paused;
    return (int)SOFTRIG_START_BYTES;
}

static inline int softrig_unpack_start(softrig_start *out, softrig_bytes payload)
{
    if (payload.size != SOFTRIG_START_BYTES)
        return -1;
    out->at_ms = softrig_get32(payload.at);
    out->paused = payload.at[4];
    return 0;
}

/* 0x23 cancel: Ends the running program: all coils off, joints hold, still armed. */
/* It has no payload. */

/* 0x24 move: Bring joints to a position on a straight line, then hold them there; the order carries its own end. */
#define SOFTRIG_MOVE_BYTES 12u
typedef struct softrig_move {
    uint32_t joints; /* Bit mask of channels in the order of the profile. */
    int16_t target_centi; /* Where to, in hundredths of the joint's unit, which the profile names. */
    uint16_t over_ms; /* How long they are to take. */
    uint32_t hold_ms; /* Limp again after this long there unless driven anew. */
} softrig_move;

static inline int softrig_pack_move(const softrig_move *in, uint8_t *out, size_t room)
{
    if (room < SOFTRIG_MOVE_BYTES)
        return -1;
    softrig_put32(out, in->joints);
    softrig_put16(out + 4, (uint16_t)in->target_centi);
    softrig_put16(out + 6, in->over_ms);
    softrig_put32(out + 8, in->hold_ms);
    return (int)SOFTRIG_MOVE_BYTES;
}

static inline int softrig_unpack_move(softrig_move *out, softrig_bytes payload)
{
    if (payload.size != SOFTRIG_MOVE_BYTES)
        return -1;
    out->joints = softrig_get32(payload.at);
    out->target_centi = softrig_signed16(softrig_get16(payload.at + 4));
    out->over_ms = softrig_get16(payload.at + 6);
    out->hold_ms = softrig_get32(payload.at + 8);
    return 0;
}

/* 0x25 orient: Turn the object that both joints grip, by its angle as the camera sees it, then hold. */
#define SOFTRIG_ORIENT_BYTES 8u
typedef struct softrig_orient {
    int16_t target_centideg; /* The object's angle. */
    uint16_t time_ms; /* How long the robot regulates it. */
    uint32_t hold_ms; /* Both joints limp again after this long unless driven anew. */
} softrig_orient;

static inline int softrig_pack_orient(const softrig_orient *in, uint8_t *out, size_t room)
{
    if (room < SOFTRIG_ORIENT_BYTES)
        return -1;
    softrig_put16(out, (uint16_t)in->target_centideg);
    softrig_put16(out + 2, in->time_ms);
    softrig_put32(out + 4, in->hold_ms);
    return (int)SOFTRIG_ORIENT_BYTES;
}

static inline int softrig_unpack_orient(softrig_orient *out, softrig_bytes payload)
{
    if (payload.size != SOFTRIG_ORIENT_BYTES)
        return -1;
    out->target_centideg = softrig_signed16(softrig_get16(payload.at));
    out->time_ms = softrig_get16(payload.at + 2);
    out->hold_ms = softrig_get32(payload.at + 4);
    return 0;
}

/* 0x26 press: Press with a force, by what the load cell reads, then hold the axis where it stands. */
#define SOFTRIG_PRESS_BYTES 12u
typedef struct softrig_press {
    uint16_t target_mn; /* The force, reached on a straight line from the present one. */
    uint16_t over_ms; /* How long it is to take to reach it. */
    uint32_t time_ms; /* How long the robot regulates it, that included. */
    uint32_t hold_ms; /* The joint limp again after this long unless driven anew. */
} softrig_press;

static inline int softrig_pack_press(const softrig_press *in, uint8_t *out, size_t room)
{
    if (room < SOFTRIG_PRESS_BYTES)
        return -1;
    softrig_put16(out, in->target_mn);
    softrig_put16(out + 2, in->over_ms);
    softrig_put32(out + 4, in->time_ms);
    softrig_put32(out + 8, in->hold_ms);
    return (int)SOFTRIG_PRESS_BYTES;
}

static inline int softrig_unpack_press(softrig_press *out, softrig_bytes payload)
{
    if (payload.size != SOFTRIG_PRESS_BYTES)
        return -1;
    out->target_mn = softrig_get16(payload.at);
    out->over_ms = softrig_get16(payload.at + 2);
    out->time_ms = softrig_get32(payload.at + 4);
    out->hold_ms = softrig_get32(payload.at + 8);
    return 0;
}

/* 0x27 pause: Stops the running program's clock. Orders on their way end by themselves; guards go on guarding. */
#define SOFTRIG_PAUSE_BYTES 1u
typedef struct softrig_pause {
    uint8_t how; /* Or lets it go on, for good or up to the next step. SOFTRIG_PAUSES_... */
} softrig_pause;

static inline int softrig_pack_pause(const softrig_pause *in, uint8_t *out, size_t room)
{
    if (room < SOFTRIG_PAUSE_BYTES)
        return -1;
    out[0] = in->how;
    return (int)SOFTRIG_PAUSE_BYTES;
}

static inline int softrig_unpack_pause(softrig_pause *out, softrig_bytes payload)
{
    if (payload.size != SOFTRIG_PAUSE_BYTES)
        return -1;
    out->how = payload.at[0];
    return 0;
}

/* 0x40 ok: The request was taken. */
#define SOFTRIG_OK_BYTES 1u
typedef struct softrig_ok {
    uint8_t request; /* Sequence number of the request. */
} softrig_ok;

static inline int softrig_pack_ok(const softrig_ok *in, uint8_t *out, size_t room)
{
    if (room < SOFTRIG_OK_BYTES)
        return -1;
    out[0] = in->request;
    return (int)SOFTRIG_OK_BYTES;
}

static inline int softrig_unpack_ok(softrig_ok *out, softrig_bytes payload)
{
    if (payload.size != SOFTRIG_OK_BYTES)
        return -1;
    out->request = payload.at[0];
    return 0;
}

/* 0x41 refused: The request was not taken; nothing changed. */
#define SOFTRIG_REFUSED_BYTES 12u
typedef struct softrig_refused {
    uint8_t request; /* Sequence number of the request. */
    uint16_t code; /* Why. SOFTRIG_CODES_... */
    uint8_t channel; /* The channel it is about, 255: none. */
    int32_t value; /* What was asked, in the unit of the limit. */
    int32_t limit; /* What is allowed. */
} softrig_refused;

static inline int softrig_pack_refused(const softrig_refused *in, uint8_t *out, size_t room)
{
    if (room < SOFTRIG_REFUSED_BYTES)
        return -1;
    out[0] = in->request;
    softrig_put16(out + 1, in->code);
    out[3] = in->channel;
    softrig_put32(out + 4, (uint32_t)in->value);
    softrig_put32(out + 8, (uint32_t)in->limit);
    return (int)SOFTRIG_REFUSED_BYTES;
}

static inline int softrig_unpack_refused(softrig_refused *out, softrig_bytes payload)
{
    if (payload.size != SOFTRIG_REFUSED_BYTES)
        return -1;
    out->request = payload.at[0];
    out->code = softrig_get16(payload.at + 1);
    out->channel = payload.at[3];
    out->value = softrig_signed32(softrig_get32(payload.at + 4));
    out->limit = softrig_signed32(softrig_get32(payload.at + 8));
    return 0;
}

/* 0x42 status: Answers status_request. */
#define SOFTRIG_STATUS_BYTES 36u
typedef struct softrig_status {
    uint8_t request; /* Sequence number of the request. */
    uint8_t state; /* State of the robot. SOFTRIG_STATES_... */
    uint16_t code; /* Last fault, 0: none since boot. SOFTRIG_CODES_... */
    uint32_t uptime_ms; /* Time since boot. */
    uint16_t lease_ms; /* What is left of the lease, 0: none. */
    uint16_t step; /* Step of the program, 0: none. */
    uint8_t paused; /* 1: the program stands still. 0 to 1. */
    uint32_t coils; /* Bit mask of the channels that are driven. */
    uint16_t supply_mv; /* Supply voltage at the rail of coils and servos. */
    uint16_t current_ma; /* Supply current. */
    int16_t board_decidegc; /* Temperature of the board. */
    int16_t roll_decideg; /* Lean to the right; 0 when the attitude is not known. */
    int16_t pitch_decideg; /* Turn forward since upright, -180 to 180 deg; 0 when the attitude is not known. */
    uint8_t down; /* Channel of the coil whose direction is nearest to down; 255: the attitude is not known. */
    uint16_t dropped; /* Damaged frames since boot, modulo 65536. */
    uint16_t forged; /* Frames without the tag that the pairing key makes, since boot, modulo 65536. */
    uint16_t repeated; /* Frames of this session that were heard before, modulo 65536. */
    uint16_t overruns; /* Control steps that came late, modulo 65536. */
} softrig_status;

static inline int softrig_pack_status(const softrig_status *in, uint8_t *out, size_t room)
{
    if (room < SOFTRIG_STATUS_BYTES || in->paused > 1)
        return -1;
    out[0] = in->request;
    out[1] = in->state;
    softrig_put16(out + 2, in->code);
    softrig_put32(out + 4, in->uptime_ms);
    softrig_put16(out + 8, in->lease_ms);
    softrig_put16(out + 10, in->step);
    out[12] = in->paused;
    softrig_put32(out + 13, in->coils);
    softrig_put16(out + 17, in->supply_mv);
    softrig_put16(out + 19, in->current_ma);
    softrig_put16(out + 21, (uint16_t)in->board_decidegc);
    softrig_put16(out + 23, (uint16_t)in->roll_decideg);
    softrig_put16(out + 25, (uint16_t)in->pitch_decideg);
    out[27] = in->down;
    softrig_put16(out + 28, in->dropped);
    softrig_put16(out + 30, in->forged);
    softrig_put16(out + 32, in->repeated);
    softrig_put16(out + 34, in->overruns);
    return (int)SOFTRIG_STATUS_BYTES;
}

static inline int softrig_unpack_status(softrig_status *out, softrig_bytes payload)
{
    if (payload.size != SOFTRIG_STATUS_BYTES)
        return -1;
    out->request = payload.at[0];
    out->state = payload.at[1];
    out->code = softrig_get16(payload.at + 2);
    out->uptime_ms = softrig_get32(payload.at + 4);
    out->lease_ms = softrig_get16(payload.at + 8);
    out->step = softrig_get16(payload.at + 10);
    out->paused = payload.at[12];
    out->coils = softrig_get32(payload.at + 13);
    out->supply_mv = softrig_get16(payload.at + 17);
    out->current_ma = softrig_get16(payload.at + 19);
    out->board_decidegc = softrig_signed16(softrig_get16(payload.at + 21));
    out->roll_decideg = softrig_signed16(softrig_get16(payload.at + 23));
    out->pitch_decideg = softrig_signed16(softrig_get16(payload.at + 25));
    out->down = payload.at[27];
    out->dropped = softrig_get16(payload.at + 28);
    out->forged = softrig_get16(payload.at + 30);
    out->repeated = softrig_get16(payload.at + 32);
    out->overruns = softrig_get16(payload.at + 34);
    return 0;
}

/* 0x43 faults: Answers faults_request: a page of the faults that were kept over resets and power cuts. */
#define SOFTRIG_FAULTS_BYTES 6u /* at least */
typedef struct softrig_faults {
    uint8_t request; /* Sequence number of the request. */
    uint32_t start; /* Number of this start of the firmware in the records. */
    uint8_t count; /* How many faults there are. */
    softrig_bytes records; /* Newest first. Channel 255: none; cause: of that start, see CAUSES. Each: start u32, now_ms u32, code u16, channel u8, value i32, state u8, cause u8. */
} softrig_faults;

static inline int softrig_pack_faults(const softrig_faults *in, uint8_t *out, size_t room)
{
    if (in->records.size > SOFTRIG_PAYLOAD_MAX - SOFTRIG_FAULTS_BYTES || room < SOFTRIG_FAULTS_BYTES + in->records.size)
        return -1;
    out[0] = in->request;
    softrig_put32(out + 1, in->start);
    out[5] = in->count;
    if (in->records.size)
        memcpy(out + 6, in->records.at, in->records.size);
    return (int)(SOFTRIG_FAULTS_BYTES + in->records.size);
}

static inline int softrig_unpack_faults(softrig_faults *out, softrig_bytes payload)
{
    if (payload.size < SOFTRIG_FAULTS_BYTES)
        return -1;
    out->request = payload.at[0];
    out->start = softrig_get32(payload.at + 1);
    out->count = payload.at[5];
    out->records.at = payload.at + 6;
    out->records.size = payload.size - SOFTRIG_FAULTS_BYTES;
    return 0;
}

/* 0x44 settings: Answers settings_request. */
#define SOFTRIG_SETTINGS_BYTES 5u /* at least */
typedef struct softrig_settings {
    uint8_t request; /* Sequence number of the request. */
    uint8_t source; /* What is used: the defaults, unless something whole is stored. SOFTRIG_SETTING_SOURCES_... */
    uint8_t node; /* Setting 0: the robot's number on a shared bus. */
    int16_t board_offset_decidegc; /* Setting 1: added to what the board's thermometer reads. */
    softrig_bytes resistances; /* Setting 2: of each cold coil; 0: as in the profile. Each: resistance_mohm u16. */
} softrig_settings;

static inline int softrig_pack_settings(const softrig_settings *in, uint8_t *out, size_t room)
{
    if (in->resistances.size > SOFTRIG_PAYLOAD_MAX - SOFTRIG_SETTINGS_BYTES || room < SOFTRIG_SETTINGS_BYTES + in->resistances.size)
        return -1;
    out[0] = in->request;
    out[1] = in->source;
    out[2] = in->node;
    softrig_put16(out + 3, (uint16_t)in->board_offset_decidegc);
    if (in->resistances.size)
        memcpy(out + 5, in->resistances.at, in->resistances.size);
    return (int)(SOFTRIG_SETTINGS_BYTES + in->resistances.size);
}

static inline int softrig_unpack_settings(softrig_settings *out, softrig_bytes payload)
{
    if (payload.size < SOFTRIG_SETTINGS_BYTES)
        return -1;
    out->request = payload.at[0];
    out->source = payload.at[1];
    out->node = payload.at[2];
    out->board_offset_decidegc = softrig_signed16(softrig_get16(payload.at + 3));
    out->resistances.at = payload.at + 5;
    out->resistances.size = payload.size - SOFTRIG_SETTINGS_BYTES;
    return 0;
}

/* 0x45 coils: Answers coils_request: what the resistance of each coil, as measured last, says of it. */
#define SOFTRIG_COILS_BYTES 1u /* at least */
typedef struct softrig_coils {
    uint8_t request; /* Sequence number of the request. */
    softrig_bytes channels; /* Of each coil; resistance in 10 mohm, 0: not measured; martensite 65535: not known; its temperature at least and at most, -32768 and 32767: no bound. Each: resistance_10mohm u16, martensite_permille u16, least_decidegc i16, most_decidegc i16. */
} softrig_coils;

static inline int softrig_pack_coils(const softrig_coils *in, uint8_t *out, size_t room)
{
    if (in->channels.size > SOFTRIG_PAYLOAD_MAX - SOFTRIG_COILS_BYTES || room < SOFTRIG_COILS_BYTES + in->channels.size)
        return -1;
    out[0] = in->request;
    if (in->channels.size)
        memcpy(out + 1, in->channels.at, in->channels.size);
    return (int)(SOFTRIG_COILS_BYTES + in->channels.size);
}

static inline int softrig_unpack_coils(softrig_coils *out, softrig_bytes payload)
{
    if (payload.size < SOFTRIG_COILS_BYTES)
        return -1;
    out->request = payload.at[0];
    out->channels.at = payload.at + 1;
    out->channels.size = payload.size - SOFTRIG_COILS_BYTES;
    return 0;
}

/* 0x4F event: Something happened; sent once and surely. */
#define SOFTRIG_EVENT_BYTES 14u
typedef struct softrig_event {
    uint8_t event; /* What. SOFTRIG_EVENTS_... */
    uint16_t code; /* Why; 0: in order. SOFTRIG_CODES_... */
    uint16_t step; /* Step of the program, 0: none. */
    uint8_t channel; /* The channel it is about, 255: none. */
    int32_t value; /* What was measured, in the unit of the code's limit. */
    uint32_t now_ms; /* The robot's clock. */
} softrig_event;

static inline int softrig_pack_event(const softrig_event *in, uint8_t *out, size_t room)
{
    if (room < SOFTRIG_EVENT_BYTES)
        return -1;
    out[0] = in->event;
    softrig_put16(out + 1, in->code);
    softrig_put16(out + 3, in->step);
    out[5] = in->channel;
    softrig_put32(out + 6, (uint32_t)in->value);
    softrig_put32(out + 10, in->now_ms);
    return (int)SOFTRIG_EVENT_BYTES;
}

static inline int softrig_unpack_event(softrig_event *out, softrig_bytes payload)
{
    if (payload.size != SOFTRIG_EVENT_BYTES)
        return -1;
    out->event = payload.at[0];
    out->code = softrig_get16(payload.at + 1);
    out->step = softrig_get16(payload.at + 3);
    out->channel = payload.at[5];
    out->value = softrig_signed32(softrig_get32(payload.at + 6));
    out->now_ms = softrig_get32(payload.at + 10);
    return 0;
}

/* 0x50 telemetry: A record of a subscription, not repeated when lost. */
#define SOFTRIG_TELEMETRY_BYTES 7u /* at least */
typedef struct softrig_telemetry {
    uint8_t slot; /* Which of the subscriptions; 4: of whoever asked by watch. 0 to 4. */
    uint8_t form; /* 0: the usual variables; else 1 + (seq of subscribe modulo 255). */
    uint8_t count; /* Number of the record, modulo 256; those that found no room on the line are counted too. */
    uint32_t now_ms; /* The robot's clock. */
    softrig_bytes values; /* The variables in the order of the subscription, one with a value per coil with all of them; every byte exclusive-ored with 0x55. */
} softrig_telemetry;

static inline int softrig_pack_telemetry(const softrig_telemetry *in, uint8_t *out, size_t room)
{
    if (in->values.size > SOFTRIG_PAYLOAD_MAX - SOFTRIG_TELEMETRY_BYTES || room < SOFTRIG_TELEMETRY_BYTES + in->values.size || in->slot > 4)
        return -1;
    out[0] = in->slot;
    out[1] = in->form;
    out[2] = in->count;
    softrig_put32(out + 3, in->now_ms);
    if (in->values.size)
        memcpy(out + 7, in->values.at, in->values.size);
    return (int)(SOFTRIG_TELEMETRY_BYTES + in->values.size);
}

static inline int softrig_unpack_telemetry(softrig_telemetry *out, softrig_bytes payload)
{
    if (payload.size < SOFTRIG_TELEMETRY_BYTES)
        return -1;
    out->slot = payload.at[0];
    out->form = payload.at[1];
    out->count = payload.at[2];
    out->now_ms = softrig_get32(payload.at + 3);
    out->values.at = payload.at + 7;
    out->values.size = payload.size - SOFTRIG_TELEMETRY_BYTES;
    return 0;
}

/* 0x58 beacon: On CAN only, ten times a second to all: a frame by itself, without segment byte, head and CRC. */
#define SOFTRIG_BEACON_BYTES 8u
typedef struct softrig_beacon {
    uint8_t state; /* State of the robot. SOFTRIG_STATES_... */
    uint8_t code; /* Last fault, 0: none since boot. SOFTRIG_CODES_... */
    uint16_t step; /* Step of the program, 0: none. */
    uint16_t supply_mv; /* Supply voltage at the rail of coils and servos. */
    uint16_t current_ma; /* Supply current. */
} softrig_beacon;

static inline int softrig_pack_beacon(const softrig_beacon *in, uint8_t *out, size_t room)
{
    if (room < SOFTRIG_BEACON_BYTES)
        return -1;
    out[0] = in->state;
    out[1] = in->code;
    softrig_put16(out + 2, in->step);
    softrig_put16(out + 4, in->supply_mv);
    softrig_put16(out + 6, in->current_ma);
    return (int)SOFTRIG_BEACON_BYTES;
}

static inline int softrig_unpack_beacon(softrig_beacon *out, softrig_bytes payload)
{
    if (payload.size != SOFTRIG_BEACON_BYTES)
        return -1;
    out->state = payload.at[0];
    out->code = payload.at[1];
    out->step = softrig_get16(payload.at + 2);
    out->supply_mv = softrig_get16(payload.at + 4);
    out->current_ma = softrig_get16(payload.at + 6);
    return 0;
}

/* 0x59 beacon_coils: Like beacon, every 20 ms: two coils, all of them in turn. */
#define SOFTRIG_BEACON_COILS_BYTES 7u
typedef struct softrig_beacon_coils {
    uint8_t group; /* Half the number of the first channel. 0 to 15. */
    uint8_t duty_a_percent; /* Duty of the first. 0 to 100. */
    uint8_t duty_b_percent; /* Duty of the second, 0 where there is none. 0 to 100. */
    int16_t temperature_a_decidegc; /* Estimated temperature of the first. */
    int16_t temperature_b_decidegc; /* Estimated temperature of the second, 0 where there is none. */
} softrig_beacon_coils;

static inline int softrig_pack_beacon_coils(const softrig_beacon_coils *in, uint8_t *out, size_t room)
{
    if (room < SOFTRIG_BEACON_COILS_BYTES || in->group > 15 || in->duty_a_percent > 100 || in->duty_b_percent > 100)
        return -1;
    out[0] = in->group;
    out[1] = in->duty_a_percent;
    out[2] = in->duty_b_percent;
    softrig_put16(out + 3, (uint16_t)in->temperature_a_decidegc);
    softrig_put16(out + 5, (uint16_t)in->temperature_b_decidegc);
    return (int)SOFTRIG_BEACON_COILS_BYTES;
}

static inline int softrig_unpack_beacon_coils(softrig_beacon_coils *out, softrig_bytes payload)
{
    if (payload.size != SOFTRIG_BEACON_COILS_BYTES)
        return -1;
    out->group = payload.at[0];
    out->duty_a_percent = payload.at[1];
    out->duty_b_percent = payload.at[2];
    out->temperature_a_decidegc = softrig_signed16(softrig_get16(payload.at + 3));
    out->temperature_b_decidegc = softrig_signed16(softrig_get16(payload.at + 5));
    return 0;
}

/* 0x5E clock: Answers clock_request. */
#define SOFTRIG_CLOCK_BYTES 12u
typedef struct softrig_clock {
    uint32_t host_us; /* As in the request. */
    uint32_t received_ms; /* The robot's clock when it found the request. */
    uint32_t sent_ms; /* The robot's clock when it made this answer. */
} softrig_clock;

static inline int softrig_pack_clock(const softrig_clock *in, uint8_t *out, size_t room)
{
    if (room < SOFTRIG_CLOCK_BYTES)
        return -1;
    softrig_put32(out, in->host_us);
    softrig_put32(out + 4, in->received_ms);
    softrig_put32(out + 8, in->sent_ms);
    return (int)SOFTRIG_CLOCK_BYTES;
}

static inline int softrig_unpack_clock(softrig_clock *out, softrig_bytes payload)
{
    if (payload.size != SOFTRIG_CLOCK_BYTES)
        return -1;
    out->host_us = softrig_get32(payload.at);
    out->received_ms = softrig_get32(payload.at + 4);
    out->sent_ms = softrig_get32(payload.at + 8);
    return 0;
}

#endif
