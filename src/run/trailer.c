#include "run/trailer.h"

#include <endian.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/digest.h"

/* A first byte that is no text, and line ends that a text transfer would change. */
static const unsigned char magic[8] = {0x89, 'T', 'A', 'L', 'U', 'S', '\r', '\n'};

enum { VERSION = 1 };

/* Places of the fields; numbers are little-endian. */
enum {
	AT_MAGIC = 0,
	AT_VERSION = 8,
	AT_STATUS = 12,
	AT_STEP = 16,
	AT_TIME = 24,
	AT_HASH = 32,
	AT_SIZE = 40,
	AT_DIGEST = 48
};

static void put_32(unsigned char *at, uint32_t value)
{
	value = htole32(value);
	memcpy(at, &value, sizeof value);
}

static void put_64(unsigned char *at, uint64_t value)
{
	value = htole64(value);
	memcpy(at, &value, sizeof value);
}

static uint32_t get_32(const unsigned char *at)
{
	uint32_t value;

	memcpy(&value, at, sizeof value);
	return le32toh(value);
}

static uint64_t get_64(const unsigned char *at)
{
	uint64_t value;

	memcpy(&value, at, sizeof value);
	return le64toh(value);
}

void trailer_write(const struct run_summary *summary, const void *image, size_t image_size,
	unsigned char trailer[TRAILER_SIZE])
{
	uint64_t time;

	memcpy(&time, &summary->time, sizeof time);
	memcpy(trailer + AT_MAGIC, magic, sizeof magic);
	put_32(trailer + AT_VERSION, VERSION);
	put_32(trailer + AT_STATUS, (uint32_t)summary->status);
	put_64(trailer + AT_STEP, summary->step);
	put_64(trailer + AT_TIME, time);
	put_64(trailer + AT_HASH, strtoull(summary->config_hash, NULL, 16));
	put_64(trailer + AT_SIZE, image_size);
	digest_of_two(image, image_size, trailer, AT_DIGEST, trailer + AT_DIGEST);
}

bool trailer_read(
	const unsigned char trailer[TRAILER_SIZE], struct run_summary *summary, uint64_t *image_size)
{
	uint64_t time = get_64(trailer + AT_TIME);
	uint32_t status = get_32(trailer + AT_STATUS);

	if (memcmp(trailer + AT_MAGIC, magic, sizeof magic) != 0 ||
		get_32(trailer + AT_VERSION) != VERSION || status > RUN_FAILED)
		return false;
	summary->status = (enum run_status)status;
	summary->step = get_64(trailer + AT_STEP);
	memcpy(&summary->time, &time, sizeof time);
	(void)snprintf(summary->config_hash, sizeof summary->config_hash, "%016" PRIx64,
		get_64(trailer + AT_HASH));
	*image_size = get_64(trailer + AT_SIZE);
	return true;
}

bool trailer_matches(
	const unsigned char trailer[TRAILER_SIZE], const void *image, size_t image_size)
{
	unsigned char digest[DIGEST_SIZE];

	digest_of_two(image, image_size, trailer, AT_DIGEST, digest);
	return memcmp(digest, trailer + AT_DIGEST, DIGEST_SIZE) == 0;
}
