/* Saved states of the unit, also serialised: a mark, the token of the unit, the variable part, and a checksum, which
 * detects truncated or modified data. The bytes are valid for this unit on the same kind of machine. */

static int save(const instance *unit, void **saved) {
    point *copy;
    if (!saved) {
        return refuse(unit, ERROR, "a null pointer in place of a saved state");
    }
    copy = *saved ? *saved : malloc(sizeof *copy);
    if (!copy) {
        return refuse(unit, ERROR, "there is no memory for a saved state");
    }
    *copy = unit->now;
    *saved = copy;
    return OK;
}

static int restore(instance *unit, const void *saved) {
    if (!saved) {
        return refuse(unit, ERROR, "a null pointer in place of a saved state");
    }
    if (((const point *)saved)->is_exchange != unit->is_exchange) {
        return refuse(unit, ERROR, "the saved state is of an instance of the other kind");
    }
    memcpy(&unit->now, saved, sizeof unit->now);
    unit->coefficients_known = 0;
    return OK;
}

static int forget(const instance *unit, void **saved) {
    (void)unit;
    if (saved) {
        free(*saved);
        *saved = NULL;
    }
    return OK;
}

#define HEAD (8 + sizeof TOKEN)
#define SERIALISED (HEAD + sizeof(point) + 8)

static void put_sum(const unsigned char *bytes, unsigned char *sum) {
    uint64_t hash = (uint64_t)0xcbf29ce4 << 32 | 0x84222325;
    for (size_t i = 0; i < SERIALISED - 8; ++i) {
        hash = (hash ^ bytes[i]) * ((uint64_t)1 << 40 | 0x1b3);
    }
    for (int i = 0; i < 8; ++i) {
        sum[i] = (unsigned char)(hash >> (8 * i));
    }
}

static int serialise(const instance *unit, const void *saved, unsigned char *bytes, size_t size) {
    if (!saved || !bytes || size < SERIALISED) {
        return refuse(unit, ERROR, "no saved state, or no room for its bytes");
    }
    memset(bytes, 0, size);
    memcpy(bytes, "eomgen 1", 8);
    memcpy(bytes + 8, TOKEN, sizeof TOKEN);
    memcpy(bytes + HEAD, saved, sizeof(point));
    put_sum(bytes, bytes + SERIALISED - 8);
    return OK;
}

static int deserialise(const instance *unit, const unsigned char *bytes, size_t size, void **saved) {
    unsigned char sum[8];
    point *copy;
    if (!bytes || !saved || size < SERIALISED) {
        return refuse(unit, ERROR, "the bytes of a saved state are missing or cut");
    }
    put_sum(bytes, sum);
    if (memcmp(bytes, "eomgen 1", 8) != 0 || memcmp(bytes + 8, TOKEN, sizeof TOKEN) != 0
        || memcmp(bytes + SERIALISED - 8, sum, 8) != 0) {
        return refuse(unit, ERROR, "these bytes are no saved state of this unit");
    }
    copy = malloc(sizeof *copy);
    if (!copy) {
        return refuse(unit, ERROR, "there is no memory for a saved state");
    }
    memcpy(copy, bytes + HEAD, sizeof *copy);
    *saved = copy;
    return OK;
}
