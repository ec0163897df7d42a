/* An open run file: run_file.c opens it, run_file_read.c reads what it holds. */
#ifndef TALUS_RUN_FILE_PRIVATE_H
#define TALUS_RUN_FILE_PRIVATE_H

#include <hdf5.h>

#include "run/run_file_parts.h"

struct run_file {
	unsigned char *bytes; /* the image and what is behind it */
	size_t size;          /* of the image */
	hid_t id;             /* the image, opened by HDF5 */
	bool verified;        /* its digest is right, and it is as long as it says */
	struct run_summary summary;
	char *path;
};

#endif
