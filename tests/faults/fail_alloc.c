/* To be preloaded: the n-th allocation of the process fails, wherever it is asked for, in libc, HDF5 and
 * libyaml too. With $FAIL_OURS only those count that the program itself asks for, and no library. */
#include <dlfcn.h>
#include <link.h>
#include <stdint.h>

#include "fail_alloc.h"

static bool ours;
static uintptr_t program_begin, program_end;

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

static bool fails_for(const void *caller)
{
	uintptr_t place = (uintptr_t)caller;

	return !(ours && (place < program_begin || place >= program_end)) && fails();
}

void *malloc(size_t size)
{
	if (!found())
		return early_alloc(size);
	return fails_for(__builtin_return_address(0)) ? NULL : next_malloc(size);
}

void *calloc(size_t nmemb, size_t size)
{
	if (!found())
		return early_alloc(nmemb * size);
	return fails_for(__builtin_return_address(0)) ? NULL : next_calloc(nmemb, size);
}

void *realloc(void *ptr, size_t size)
{
	if (!found())
		return NULL;
	return fails_for(__builtin_return_address(0)) ? NULL : next_realloc(ptr, size);
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

__attribute__((constructor)) static void look(void)
{
	ours = getenv("FAIL_OURS") != NULL;
	(void)dl_iterate_phdr(find_program, NULL);
}
