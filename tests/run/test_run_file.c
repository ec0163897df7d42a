/* Damage to a run file is seen, whatever it hits, and nothing that can be in a file is a crash. */
#include "logistic.h"

#include <fcntl.h>
#include <sys/stat.h>

#include "base/file.h"
#include "run/trailer.h"
#include "run/verify.h"

static const char settings[] = "time.end=0.1;output.profiles_at=[0.05];domain.cells=4;layers=2";

/* Make a small run; returns the size of its file. */
static size_t make_run(void)
{
	struct config config = logistic_config(settings);
	struct stat st;

	must_execute(&config, "a");
	assert_int_equal(stat(in_folder("a/run.h5"), &st), 0);
	return (size_t)st.st_size;
}

static int try_open(const char *name, const char **warning)
{
	struct run_file *file = NULL;
	struct error err = {0};

	if (run_file_open(in_folder(name), &file, warning, &err) != 0)
		return err.code;
	run_file_close(file);
	return 0;
}

static void flip_byte(int fd, size_t at, unsigned char mask)
{
	unsigned char byte;

	assert_int_equal(pread(fd, &byte, 1, (off_t)at), 1);
	byte ^= mask;
	assert_int_equal(pwrite(fd, &byte, 1, (off_t)at), 1);
}

static void a_changed_byte_anywhere_is_seen(void **state)
{
	enum { FIRST = 4096, RANDOM = 10000 };
	size_t size = make_run();
	int fd = open(in_folder("a/run.h5"), O_RDWR);
	uint32_t random = 1;

	(void)state;
	assert_true(fd >= 0 && size > 8192);
	for (size_t i = 0; i < FIRST + RANDOM; i++) {
		size_t at = i < FIRST ? i : (random >> 4) % size;
		unsigned char mask = (unsigned char)(1U << (random & 7));

		flip_byte(fd, at, mask);
		if (try_open("a/run.h5", NULL) != EX_DATAERR)
			fail_msg("bit %u of byte %zu of %zu can be changed unseen", mask, at, size);
		flip_byte(fd, at, mask);
		random = random * 1664525U + 1013904223U;
	}
	assert_int_equal(try_open("a/run.h5", NULL), 0);
	assert_int_equal(close(fd), 0);
}

static void every_byte_of_the_trailer_is_seen(void **state)
{
	size_t size = make_run();
	int fd = open(in_folder("a/run.h5"), O_RDWR);

	(void)state;
	for (size_t at = size - TRAILER_SIZE; at < size; at++)
		for (unsigned bit = 0; bit < 8; bit++) {
			flip_byte(fd, at, (unsigned char)(1U << bit));
			if (try_open("a/run.h5", NULL) != EX_DATAERR)
				fail_msg("bit %u of byte %zu of the trailer can be changed unseen", bit,
					at - (size - TRAILER_SIZE));
			flip_byte(fd, at, (unsigned char)(1U << bit));
		}
	assert_int_equal(close(fd), 0);
}

static void every_length_but_two_is_refused(void **state)
{
	size_t size = make_run();
	const char *warning;

	(void)state;
	/* without its trailer it is a copy as other programs make them */
	for (size_t length = size - 1; length > 0; length -= length > size - 200 ? 1 : 41) {
		assert_int_equal(truncate(in_folder("a/run.h5"), (off_t)length), 0);
		assert_int_equal(
			try_open("a/run.h5", &warning), length == size - TRAILER_SIZE ? 0 : EX_DATAERR);
		assert_true((warning != NULL) == (length == size - TRAILER_SIZE));
		if (length <= 41)
			break;
	}
	assert_int_equal(truncate(in_folder("a/run.h5"), 0), 0);
	assert_int_equal(try_open("a/run.h5", &warning), EX_DATAERR);
}

/* What lost a piece in the middle ends in a trailer that is whole: its length gives it away, to those that
 * read nothing else too. */
static void a_piece_that_is_missing_is_seen_by_the_trailer(void **state)
{
	enum { PIECE = 512 };
	size_t size = make_run();
	unsigned char *bytes;
	struct run_summary summary;
	struct run_file *file = NULL;
	struct error err = {0}, peeked = {0};

	(void)state;
	assert_int_equal(file_read(in_folder("a/run.h5"), &bytes, &size, &err), 0);
	memmove(bytes + 4096, bytes + 4096 + PIECE, size - 4096 - PIECE);
	assert_int_equal(file_replace(&(struct file_place){.folder = in_folder("a"), .name = "run.h5"},
						 &(struct file_part){bytes, size - PIECE}, 1, &err),
		0);
	assert_int_equal(run_file_peek(in_folder("a/run.h5"), &summary, &peeked), -1);
	assert_int_equal(peeked.code, EX_DATAERR);
	assert_int_equal(run_file_open(in_folder("a/run.h5"), &file, NULL, &err), -1);
	assert_int_equal(err.code, EX_DATAERR);
	assert_non_null(strstr(err.text, "bytes and has"));
	free(bytes);
}

static void bytes_behind_the_trailer_are_refused(void **state)
{
	struct error err = {0};

	(void)state;
	(void)make_run();
	assert_int_equal(file_append(in_folder("a/run.h5"), "x", &err), 0);
	assert_int_equal(try_open("a/run.h5", NULL), EX_DATAERR);
}

static void what_is_no_run_file_is_refused(void **state)
{
	struct error err = {0};
	char text[200];

	(void)state;
	memset(text, 'x', sizeof text);
	text[sizeof text - 1] = '\0';
	assert_int_equal(file_append(in_folder("text"), text, &err), 0);
	assert_int_equal(try_open("text", NULL), EX_DATAERR);
	assert_int_equal(try_open("absent", NULL), EX_NOINPUT);
	assert_int_equal(try_open(".", NULL), EX_IOERR);
}

/* An image that is no HDF5, with a digest that is right. */
static void a_right_digest_over_nonsense_is_no_crash(void **state)
{
	static const unsigned char signature[] = {0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n', 0};
	unsigned char bytes[512 + TRAILER_SIZE];
	const struct file_part part = {bytes, sizeof bytes};
	const struct file_place place = {.folder = in_folder("."), .name = "forged"};
	struct run_summary summary = {.config_hash = "0123456789abcdef"};
	struct error err = {0};

	(void)state;
	for (size_t i = 0; i < 512; i++)
		bytes[i] = (unsigned char)(i * 37);
	memcpy(bytes, signature, sizeof signature);
	trailer_write(&summary, bytes, 512, bytes + 512);
	assert_int_equal(file_replace(&place, &part, 1, &err), 0);
	assert_int_equal(try_open("forged", NULL), EX_DATAERR);
}

static void the_trailer_tells_without_the_image(void **state)
{
	struct run_summary summary;
	struct config config = logistic_config(settings);
	char hash[CONFIG_HASH_SIZE];
	struct error err = {0};

	(void)state;
	(void)make_run();
	assert_int_equal(run_file_peek(in_folder("a/run.h5"), &summary, &err), 0);
	assert_int_equal(config_hash(&config, hash, &err), 0);
	assert_string_equal(summary.config_hash, hash);
	assert_int_equal(summary.status, RUN_COMPLETE);
	assert_true(summary.time == 0.1);
	assert_true(summary.step > 5);
}

static void a_copy_without_trailer_tells_the_same(void **state)
{
	size_t size = make_run();
	struct run_summary summary;
	struct run_file *file;
	struct error err = {0};

	(void)state;
	assert_int_equal(run_file_peek(in_folder("a/run.h5"), &summary, &err), 0);
	assert_int_equal(truncate(in_folder("a/run.h5"), (off_t)(size - TRAILER_SIZE)), 0);
	file = open_run("a/run.h5");
	assert_int_equal(run_file_summary(file)->step, summary.step);
	assert_true(run_file_summary(file)->time == summary.time);
	assert_string_equal(run_file_summary(file)->config_hash, summary.config_hash);
	assert_int_equal(run_file_summary(file)->status, RUN_COMPLETE);
	run_file_close(file);
}

static void what_is_absent_is_an_error_with_its_name(void **state)
{
	struct run_file *file;
	struct dataset data;
	struct text text = {0};
	struct error err = {0};
	double value;

	(void)state;
	(void)make_run();
	file = open_run("a");
	assert_int_equal(run_file_text(file, "nothing", &text, &err), -1);
	assert_int_equal(err.code, EX_DATAERR);
	assert_non_null(strstr(err.text, "'nothing'"));
	err = (struct error){0};
	assert_int_equal(run_file_text(file, "attempts", &text, &err), -1); /* a number */
	err = (struct error){0};
	assert_int_equal(run_file_real(file, "title", &value, &err), -1); /* a text */
	assert_int_equal(err.code, EX_DATAERR);
	err = (struct error){0};
	assert_int_equal(run_file_dataset(file, "/nothing", &data, &err), -1);
	assert_non_null(strstr(err.text, "'/nothing'"));
	err = (struct error){0};
	assert_int_equal(run_file_dataset(file, "/checkpoint", &data, &err), -1); /* a group */
	err = (struct error){0};
	assert_int_equal(run_file_fill(file, "/x", &value, 1, &err), -1);
	assert_non_null(strstr(err.text, "has 4 values instead of 1"));
	run_file_close(file);
}

static void the_content_of_a_run_makes_sense(void **state)
{
	struct run_file *file;
	struct text out = {0};
	struct error err = {0};

	(void)state;
	(void)make_run();
	file = open_run("a");
	assert_int_equal(verify_run_file(file, &out, &err), 0);
	assert_string_equal(text_string(&out), "");
	run_file_close(file);
}

/* Put these bytes of a run file in its place, under a trailer with this summary and the right digest. */
static void put_sealed(const struct run_summary *summary, unsigned char *bytes, size_t size)
{
	const struct file_place place = {.folder = in_folder("a"), .name = "run.h5"};
	const struct file_part part = {bytes, size};
	struct error err = {0};

	trailer_write(summary, bytes, size - TRAILER_SIZE, bytes + size - TRAILER_SIZE);
	assert_int_equal(file_replace(&place, &part, 1, &err), 0);
}

/* Change one value and make the digest right again. */
static void forge(const char *path, size_t index, double value)
{
	struct run_file *file = open_run("a/run.h5");
	struct dataset data;
	struct error err = {0};
	unsigned char *bytes, *at;
	size_t size;

	assert_int_equal(run_file_dataset(file, path, &data, &err), 0);
	assert_int_equal(file_read(in_folder("a/run.h5"), &bytes, &size, &err), 0);
	at = memmem(bytes, size, data.values, data.extent[0] * sizeof *data.values);
	assert_non_null(at);
	memcpy(at + index * sizeof value, &value, sizeof value);
	put_sealed(run_file_summary(file), bytes, size);
	free(bytes);
	free(data.values);
	run_file_close(file);
}

static void assert_breach(const char *part)
{
	struct run_file *file = open_run("a/run.h5");
	struct text out = {0};
	struct error err = {0};

	assert_int_equal(verify_run_file(file, &out, &err), 0);
	if (!strstr(text_string(&out), part))
		fail_msg("\"%s\" is not in \"%s\"", part, text_string(&out));
	text_clean(&out);
	run_file_close(file);
}

static void time_that_does_not_grow_is_found(void **state)
{
	(void)state;
	(void)make_run();
	forge("/time", 3, 0);
	assert_breach("/time: does not grow at [3]: 0");
}

static void a_trailer_that_tells_otherwise_is_found(void **state)
{
	struct run_summary summary;
	struct error err = {0};
	unsigned char *bytes;
	size_t size;

	(void)state;
	(void)make_run();
	assert_int_equal(run_file_peek(in_folder("a/run.h5"), &summary, &err), 0);
	assert_int_equal(file_read(in_folder("a/run.h5"), &bytes, &size, &err), 0);
	summary.step++;
	summary.time = 0.05;
	summary.status = RUN_FAILED;
	put_sealed(&summary, bytes, size);
	free(bytes);
	assert_breach("status: is 'complete' and the trailer says 'failed'");
	assert_breach("/checkpoint/step: is ");
	assert_breach("/checkpoint/time: is 0.1");
	assert_breach("/time: ends at 0.1");
}

static void mass_that_is_lost_is_found(void **state)
{
	(void)state;
	(void)make_run();
	forge("/mass", 2, 1023);
	assert_breach("mass and mass_outflow add up to 1024 at first and 0.998 from it later");
}

static void mass_that_is_no_number_is_found(void **state)
{
	(void)state;
	(void)make_run();
	forge("/mass", 2, NAN);
	assert_breach("nan from it later");
}

/* As was seen after 682,290 steps of a run that did not lose any. */
static void the_rounding_of_very_many_steps_is_no_loss(void **state)
{
	const double mass[] = {310000000009, 310000000011.6}, left[] = {0, 0};
	struct text out = {0};

	(void)state;
	assert_true(verify_mass(mass, left, 2, 682290, &out));
	assert_true(out.length == 0);
	assert_false(verify_mass(mass, left, 2, 10000, &out));
	assert_non_null(strstr(text_string(&out), "2.6 from it later"));
	text_clean(&out);
}

static void a_different_bit_is_told_with_its_place(void **state)
{
	struct config config = logistic_config(settings);
	struct run_file *first, *second;
	struct text out = {0};
	struct error err = {0};

	(void)state;
	(void)make_run();
	must_execute(&config, "b");
	assert_same_bits("a", "b");
	forge("/mass", 2, 1000);
	first = open_run("a/run.h5");
	second = open_run("b");
	assert_int_equal(compare_run_files(first, second, &out, &err), 0);
	assert_non_null(strstr(text_string(&out), "/mass: 1 of "));
	assert_non_null(strstr(text_string(&out), " values differ, first [2]: 1000 -> 1023.998046875"));
	text_clean(&out);
	run_file_close(first);
	run_file_close(second);
}

static void another_shape_and_config_are_told(void **state)
{
	struct config config = logistic_config("time.end=0.1;output.profiles_at=[0.05];layers=3");
	struct run_file *first, *second;
	struct text out = {0};
	struct error err = {0};

	(void)state;
	(void)make_run();
	must_execute(&config, "b");
	first = open_run("a");
	second = open_run("b");
	assert_int_equal(compare_run_files(first, second, &out, &err), 0);
	assert_non_null(strstr(text_string(&out), "config_hash: "));
	assert_non_null(strstr(text_string(&out), "\nconfig layers: 2 -> 3\n"));
	assert_non_null(strstr(text_string(&out), "/u: shape 2 x 2 x 4 -> 2 x 3 x 16"));
	text_clean(&out);
	run_file_close(first);
	run_file_close(second);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, make_folder, remove_folder)
	const struct CMUnitTest tests[] = {
		TEST(a_changed_byte_anywhere_is_seen),
		TEST(every_byte_of_the_trailer_is_seen),
		TEST(every_length_but_two_is_refused),
		TEST(a_piece_that_is_missing_is_seen_by_the_trailer),
		TEST(bytes_behind_the_trailer_are_refused),
		TEST(what_is_no_run_file_is_refused),
		TEST(a_right_digest_over_nonsense_is_no_crash),
		TEST(the_trailer_tells_without_the_image),
		TEST(a_copy_without_trailer_tells_the_same),
		TEST(what_is_absent_is_an_error_with_its_name),
		TEST(the_content_of_a_run_makes_sense),
		TEST(time_that_does_not_grow_is_found),
		TEST(a_trailer_that_tells_otherwise_is_found),
		TEST(mass_that_is_lost_is_found),
		TEST(mass_that_is_no_number_is_found),
		TEST(the_rounding_of_very_many_steps_is_no_loss),
		TEST(a_different_bit_is_told_with_its_place),
		TEST(another_shape_and_config_are_told),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
