#include "base/build.h"

#include <stdio.h>
#include <unistd.h>

#ifndef TALUS_REVISION
#define TALUS_REVISION "unknown"
#endif
#ifndef TALUS_FLAGS
#define TALUS_FLAGS "unknown"
#endif

const char *build_revision(void)
{
	return TALUS_REVISION;
}

const char *build_compiler(void)
{
#if defined __clang__
	return "clang " __clang_version__;
#else
	return "gcc " __VERSION__;
#endif
}

const char *build_flags(void)
{
	return TALUS_FLAGS;
}

char *build_host(char buffer[BUILD_HOST_SIZE])
{
	if (gethostname(buffer, BUILD_HOST_SIZE) != 0)
		(void)snprintf(buffer, BUILD_HOST_SIZE, "unknown");
	buffer[BUILD_HOST_SIZE - 1] = '\0';
	return buffer;
}
