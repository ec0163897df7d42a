/* Which program this is and where it runs. */
#ifndef TALUS_BUILD_H
#define TALUS_BUILD_H

#define TALUS_VERSION "0.1.0"

/* Git revision of the source, with "-dirty" when it was changed; "unknown" without a checkout. */
const char *build_revision(void);

const char *build_compiler(void); /* "gcc 12.2.0", "clang 14.0.6" */
const char *build_flags(void);    /* optimisation flags and CFLAGS of the build */

/* Name of this machine. Returns `buffer`. */
enum { BUILD_HOST_SIZE = 65 };
char *build_host(char buffer[BUILD_HOST_SIZE]);

#endif
