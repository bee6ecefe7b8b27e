/* softrig.h: the wire protocol of softrig, version @VERSION@, for clients in C99 or C++11: one file, no library, no heap.
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

#define SOFTRIG_VERSION @VERSION@
#define SOFTRIG_RELIABLE @RELIABLE@u /* flags */
#define SOFTRIG_NODE @NODE@u
#define SOFTRIG_SEALED @SEALED@u
#define SOFTRIG_RESERVED @RESERVED@u
#define SOFTRIG_HEAD_BYTES @HEAD_BYTES@u
#define SOFTRIG_TAG_BYTES @TAG_BYTES@u
#define SOFTRIG_CRC_BYTES @CRC_BYTES@u
#define SOFTRIG_BODY_MIN @BODY_MIN@u
#define SOFTRIG_BODY_MAX @BODY_MAX@u
#define SOFTRIG_PAYLOAD_MAX @PAYLOAD_MAX@u
#define SOFTRIG_FRAME_MAX @FRAME_MAX@u /* on the wire: stuffed, with the zero that ends it */
#define SOFTRIG_GREETINGS_BELOW @GREETINGS_BELOW@u
#define SOFTRIG_OPEN_FROM @OPEN_FROM@u
#define SOFTRIG_OPEN_BELOW @OPEN_BELOW@u
#define SOFTRIG_WINDOW @WINDOW@u
#define SOFTRIG_START_AT_ONCE @AT_ONCE@u
#define SOFTRIG_START_AT_SYNC @AT_SYNC@u
#define SOFTRIG_STOP_BYTES @STOP_BYTES@u
#define SOFTRIG_STOP @STOP@ /* initialises uint8_t[SOFTRIG_STOP_BYTES] */

@ENUMS@
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
@SHA256_K@
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

#define SOFTRIG_CAN_ALL @CAN_ALL@u /* node of every robot, and of every host */
#define SOFTRIG_CAN_HOST @CAN_HOST@u /* node of a host that was not given one */
#define SOFTRIG_CAN_CLASSIC 8u /* bytes of data in a frame */
#define SOFTRIG_CAN_FD 64u

/* Return the 29-bit identifier of the frames of a body. */
static inline uint32_t softrig_can_identifier(uint8_t kind, unsigned robot, unsigned host, int from_robot)
{
    uint32_t priority = from_robot ? @CAN_ANSWERS@u : @CAN_ORDERS@u;
    if (kind == SOFTRIG_KIND_SYNC)
        priority = @CAN_SYNCHRONISE@u;
    else if (kind < SOFTRIG_GREETINGS_BELOW && kind != SOFTRIG_KIND_STOPPED)
        priority = @CAN_GREETINGS@u;
    else if (kind >= SOFTRIG_OPEN_FROM && kind < SOFTRIG_OPEN_BELOW)
        priority = @CAN_TELEMETRY@u;
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

@MESSAGES@
#endif
