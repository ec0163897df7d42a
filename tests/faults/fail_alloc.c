/* To be preloaded: the n-th allocation of the process fails, wherever it is asked for, in libc, HDF5 and
 * libyaml too. $FAIL_ALLOC is n, with a '+' behind it for all from the n-th on. $COUNT_ALLOC names a file
 * that gets the number of allocations at the end. With $FAIL_OURS only those count that the program itself
 * asks for, and no library. Children are left in peace. */
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <link.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static long count, fail_at;
static bool armed, stays, ours;
static uintptr_t program_begin, program_end;
static const char *count_file;

/* What we stand before. */
static void *(*next_malloc)(size_t);
static void *(*next_calloc)(size_t, size_t);
static void *(*next_realloc)(void *, size_t);
static void (*next_free)(void *);

/* While dlsym finds them it allocates and frees itself: from here, and never. */
static bool finding;
static char early[8192];
static size_t early_used;

static void *early_alloc(size_t size)
{
	void *block = early + early_used;

	early_used += (size + 15) & ~(size_t)15;
	return early_used <= sizeof early ? block : NULL;
}

static bool is_early(const void *block)
{
	return (const char *)block >= early && (const char *)block < early + sizeof early;
}

/* False while it is being done. */
static bool found(void)
{
	if (next_free || finding)
		return !finding;
	finding = true;
	*(void **)&next_malloc = dlsym(RTLD_NEXT, "malloc");
	*(void **)&next_calloc = dlsym(RTLD_NEXT, "calloc");
	*(void **)&next_realloc = dlsym(RTLD_NEXT, "realloc");
	*(void **)&next_free = dlsym(RTLD_NEXT, "free");
	finding = false;
	return true;
}

static bool fails(const void *caller)
{
	uintptr_t place = (uintptr_t)caller;

	if (!armed || (ours && (place < program_begin || place >= program_end)))
		return false;
	count++;
	if (!fail_at || (stays ? count < fail_at : count != fail_at))
		return false;
	errno = ENOMEM;
	return true;
}

void *malloc(size_t size)
{
	if (!found())
		return early_alloc(size);
	return fails(__builtin_return_address(0)) ? NULL : next_malloc(size);
}

void *calloc(size_t nmemb, size_t size)
{
	if (!found())
		return early_alloc(nmemb * size);
	return fails(__builtin_return_address(0)) ? NULL : next_calloc(nmemb, size);
}

void *realloc(void *ptr, size_t size)
{
	if (!found())
		return NULL;
	return fails(__builtin_return_address(0)) ? NULL : next_realloc(ptr, size);
}

void free(void *ptr)
{
	if (found() && !is_early(ptr))
		next_free(ptr);
}

/* The first object that is told is the program. */
static int find_program(struct dl_phdr_info *info, size_t size, void *unused)
{
	(void)size;
	(void)unused;
	for (int i = 0; i < info->dlpi_phnum; i++) {
		const ElfW(Phdr) *part = &info->dlpi_phdr[i];

		if (part->p_type == PT_LOAD && (part->p_flags & PF_X)) {
			program_begin = info->dlpi_addr + part->p_vaddr;
			program_end = program_begin + part->p_memsz;
		}
	}
	return 1;
}

__attribute__((constructor)) static void arm(void)
{
	const char *wanted = getenv("FAIL_ALLOC");

	count_file = getenv("COUNT_ALLOC");
	fail_at = wanted ? strtol(wanted, NULL, 10) : 0;
	stays = wanted && strchr(wanted, '+');
	ours = getenv("FAIL_OURS") != NULL;
	(void)dl_iterate_phdr(find_program, NULL);
	(void)unsetenv("LD_PRELOAD");
	armed = true;
}

/* Not in a child that was forked and has not become another program. */
__attribute__((destructor)) static void tell(void)
{
	char text[32];
	int fd, length;

	armed = false;
	fd = count_file ? open(count_file, O_WRONLY | O_CREAT | O_TRUNC, 0666) : -1;
	if (fd < 0)
		return;
	length = snprintf(text, sizeof text, "%ld\n", count);
	(void)!write(fd, text, (size_t)length);
	(void)close(fd);
}
