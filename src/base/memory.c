#include "base/memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Bytes, caches that the kernel would give up among them; 0: nobody tells. */
static double available(void)
{
	static const char name[] = "MemAvailable:";
	FILE *file = fopen("/proc/meminfo", "re");
	char line[128];
	double kilobytes = 0;

	while (file && kilobytes == 0 && fgets(line, sizeof line, file))
		if (strncmp(line, name, sizeof name - 1) == 0)
			kilobytes = strtod(line + sizeof name - 1, NULL);
	if (file)
		(void)fclose(file);
	return 1024 * kilobytes;
}

int memory_check(size_t bytes, struct error *err)
{
	double here = bytes < MEMORY_SMALL ? 0 : available();

	if (here == 0 || (double)bytes <= here)
		return 0;
	return error_set(err, EX_SOFTWARE, "%.1f GB of memory are needed, and %.1f GB are available",
		1e-9 * (double)bytes, 1e-9 * here);
}
