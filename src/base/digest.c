#include "base/digest.h"

#include <string.h>

#define XXH_STATIC_LINKING_ONLY /* for the size of the state, so that it needs no allocation */
#include <xxhash.h>

void digest_of_two(
	const void *a, size_t a_size, const void *b, size_t b_size, unsigned char digest[DIGEST_SIZE])
{
	XXH3_state_t state;
	XXH128_canonical_t canonical;

	(void)XXH3_128bits_reset(&state);
	(void)XXH3_128bits_update(&state, a, a_size);
	(void)XXH3_128bits_update(&state, b, b_size);
	XXH128_canonicalFromHash(&canonical, XXH3_128bits_digest(&state));
	memcpy(digest, canonical.digest, DIGEST_SIZE);
}
