/* One of the targets, as libFuzzer and AFL++ want it. */
#include "targets.h"

#ifndef TARGET
#define TARGET fuzz_config
#endif

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
	return TARGET(bytes, size);
}
