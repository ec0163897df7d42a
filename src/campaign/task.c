#include "campaign/task.h"

#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/file.h"

enum {
	ARGUMENTS_MAX = 10,
	REFUSALS_MAX = 2,
	GRACE = 30 /* s, for the checkpoint of a run whose time is over */
};

/* Is a run that failed, or was ended by what nobody asked for, to be tried again? The failures of the
 * run itself are kept in its folder, so that the limit holds over commands; a crash is known only here. */
static bool may_try_again(const struct campaign *campaign, const struct task *task)
{
	int failures = task->report.failures > 0 ? task->report.failures : 1;
	int tries = task->starts - !task->failed_before;

	if (!campaign->options.retry)
		return false;
	if (task->report.state == RUN_STATE_FAILED && !campaign->options.anew)
		return failures <= campaign->options.retry;
	return tries < campaign->options.retry;
}

/* Damage behind a good trailer shows only when the run reads its file, which ends the first try. */
bool task_may_begin_anew(const struct campaign *campaign, const struct task *task)
{
	return campaign->options.retry && (task->starts || task->report.state == RUN_STATE_FAILED ||
										  task->report.state == RUN_STATE_DAMAGED);
}

void task_look(const struct campaign *campaign, struct task *task)
{
	struct run_report report;

	run_report_read(task->run->folder, &report);
	if (report.unknown)
		task->report.unknown = true;
	else
		task->report = report;
	if (report.unknown || (task->state != TASK_WAITING && task->state != TASK_ELSEWHERE))
		return;
	switch (task->report.state) {
	case RUN_STATE_RUNNING:
		task->state = TASK_ELSEWHERE;
		task->refusals = 0;
		break;
	case RUN_STATE_COMPLETE:
		task->state = TASK_COMPLETE;
		break;
	case RUN_STATE_FAILED:
		task->state = may_try_again(campaign, task) ? TASK_WAITING : TASK_FAILED;
		break;
	case RUN_STATE_DAMAGED: /* what is not a matter of the run's files it tells itself */
		task->state =
			task->report.blocked || may_try_again(campaign, task) ? TASK_WAITING : TASK_FAILED;
		task->code = EX_DATAERR;
		break;
	case RUN_STATE_PENDING:
	case RUN_STATE_INTERRUPTED:
		task->state = TASK_WAITING;
		break;
	}
}

/* Two campaigns may do this at the same moment: each writes under a name of its own. */
int task_write_config(const struct task *task, struct error *err)
{
	const char *folder = task->run->folder;
	struct text config = {0}, path = {0}, final = {0};
	char name[64];
	int result = -1;

	(void)snprintf(name, sizeof name, "config.%ld.yaml", (long)getpid());
	config_print(&task->run->config, &config);
	if (config.failed) {
		error_memory(err, config.length);
		goto done;
	}
	if (file_make_folders(folder, err) || file_path(&path, folder, name, err) ||
		file_path(&final, folder, "config.yaml", err) ||
		file_replace(&(struct file_place){.folder = folder, .name = name},
			&(struct file_part){config.data, config.length}, 1, err))
		goto done;
	if (rename(path.data, final.data) != 0) {
		error_at(err, EX_CANTCREAT, final.data, 0, 0, "cannot be written: %s", strerror(errno));
		(void)unlink(path.data);
		goto done;
	}
	result = 0;
done:
	text_clean(&config);
	text_clean(&path);
	text_clean(&final);
	return result;
}

/* What the child does between fork and exec. Never returns. */
static void become_run(const struct campaign *campaign, char *const *arguments, int log,
	const sigset_t *mask, const struct lock *timing, pid_t parent)
{
	const char *program = campaign->options.program ? campaign->options.program : "/proc/self/exe";
	int fd;

	/* a group of its own: Ctrl-C reaches the campaign alone, which passes it on */
	(void)setpgid(0, 0);
	(void)prctl(PR_SET_PDEATHSIG, SIGTERM);
	if (getppid() != parent)
		_exit(EX_INTERRUPTED);
	if (timing && timing->fd >= 0)
		(void)fcntl(timing->fd, F_SETFD, 0);
	fd = open("/dev/null", O_RDONLY);
	if (fd >= 0)
		(void)dup2(fd, STDIN_FILENO);
	if (dup2(log, STDOUT_FILENO) < 0 || dup2(log, STDERR_FILENO) < 0)
		_exit(EX_CANTCREAT);
	(void)sigprocmask(SIG_SETMASK, mask, NULL);
	(void)execv(program, arguments);
	(void)dprintf(STDERR_FILENO, "talus: cannot start %s: %s\n", program, strerror(errno));
	_exit(EX_UNAVAILABLE);
}

const char *task_from(const struct campaign *campaign, const struct task *task)
{
	const struct task *before = task->before == SIZE_MAX ? NULL : &campaign->tasks[task->before];

	if (task->report.state != RUN_STATE_PENDING)
		return NULL;
	if (before && (before->report.state == RUN_STATE_COMPLETE ||
					  before->report.state == RUN_STATE_INTERRUPTED))
		return before->run->folder;
	return task->from;
}

/* Not fork, which takes its time to copy the tables of all our memory: become_run changes none of it. */
static pid_t start_child(const struct campaign *campaign, char *const *arguments, int log,
	const sigset_t *mask, const struct lock *timing)
{
	pid_t parent = getpid(), pid;

	pid = vfork(); /* NOLINT(clang-analyzer-security.insecureAPI.vfork) */
	if (pid == 0)
		/* NOLINTNEXTLINE(clang-analyzer-unix.Vfork): it makes system calls, and never returns */
		become_run(campaign, arguments, log, mask, timing, parent);
	return pid;
}

int task_start(const struct campaign *campaign, struct task *task, const sigset_t *mask,
	const struct lock *timing, struct error *err)
{
	struct text config = {0}, path = {0};
	char *arguments[ARGUMENTS_MAX] = {"talus", "run", "FILE", "-o", task->run->folder, "--quiet"};
	int log = -1, count = 6, result = -1;

	if (task_may_begin_anew(campaign, task))
		arguments[count++] = "--retry";
	if (task_from(campaign, task)) {
		arguments[count++] = "--continue-from";
		arguments[count++] = (char *)task_from(campaign, task);
	}
	if (task_write_config(task, err) || file_path(&config, task->run->folder, "config.yaml", err) ||
		file_path(&path, task->run->folder, "run.log", err))
		goto done;
	log = file_open_log(text_string(&path));
	if (log < 0) {
		error_at(
			err, EX_CANTCREAT, text_string(&path), 0, 0, "cannot be opened: %s", strerror(errno));
		goto done;
	}
	/* what the program has buffered would be written twice */
	(void)fflush(NULL);
	arguments[2] = config.data;
	task->pid = start_child(campaign, arguments, log, mask, timing);
	if (task->pid < 0) {
		error_set(err, EX_SOFTWARE, "cannot start a process: %s", strerror(errno));
		goto done;
	}
	(void)setpgid(task->pid, task->pid); /* whoever of the two comes first */
	task->state = TASK_RUNNING;
	task->starts++;
	task->started = clock_wall();
	task->timed_out = false;
	result = 0;
done:
	if (log >= 0)
		(void)close(log);
	text_clean(&config);
	text_clean(&path);
	return result;
}

static bool is_stop(int number)
{
	return number == SIGTERM || number == SIGINT || number == SIGKILL || number == SIGHUP ||
		   number == SIGUSR1;
}

/* A line of ours in the run's log, for what its own process cannot know. */
static void task_log(const struct task *task, const char *message)
{
	struct text path = {0}, line = {0};
	struct error ignored = {0};
	char stamp[CLOCK_STAMP_SIZE];

	text_addf(&line, "%s campaign: %s\n", clock_stamp(stamp), message);
	if (file_path(&path, task->run->folder, "run.log", &ignored) == 0 && !line.failed)
		(void)file_append(text_string(&path), text_string(&line), &ignored);
	text_clean(&path);
	text_clean(&line);
}

void task_watch_time(const struct campaign *campaign, struct task *task)
{
	double passed = clock_wall() - task->started, timeout = campaign->options.timeout;

	if (task->state != TASK_RUNNING || timeout <= 0 || passed < timeout)
		return;
	if (!task->timed_out)
		(void)kill(task->pid, SIGTERM);
	else if (passed >= timeout + GRACE)
		(void)kill(task->pid, SIGKILL);
	task->timed_out = true;
}

bool task_reap(const struct campaign *campaign, struct task *task)
{
	int status;
	pid_t pid = waitpid(task->pid, &status, WNOHANG);

	if (pid == 0 || (pid < 0 && errno == EINTR))
		return false;
	if (pid < 0)
		status = 0; /* somebody else reaped it: the report tells */
	run_report_read(task->run->folder, &task->report);
	task->code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
	if (task->code == 0 && task->report.state == RUN_STATE_COMPLETE)
		task->state = TASK_COMPLETE;
	else if (WIFSIGNALED(status) ? is_stop(WTERMSIG(status)) : task->code == EX_INTERRUPTED)
		task->state = TASK_INTERRUPTED;
	else
		task->state = TASK_FAILED;
	if (task->timed_out && task->state != TASK_COMPLETE) {
		char span[CLOCK_SPAN_SIZE];

		(void)snprintf(task->report.reason, sizeof task->report.reason,
			"stopped after the --timeout of %s", clock_span(campaign->options.timeout, span));
		task_log(task, task->report.reason);
	}
	if (task->state != TASK_COMPLETE && !campaign->stopping &&
		(task->state == TASK_FAILED || task->timed_out || WIFSIGNALED(status)) &&
		may_try_again(campaign, task)) {
		task->state = TASK_WAITING;
		return true;
	}
	/* 75 without our asking: as a rule another process holds the run's lock. It may have let go by
	 * now, so look again later; a run that is refused time after time is left as it is. */
	if (task->state == TASK_INTERRUPTED && !WIFSIGNALED(status) && !campaign->stopping &&
		!task->timed_out && task->refusals++ < REFUSALS_MAX)
		task->state = TASK_ELSEWHERE;
	return true;
}

void task_blame_disk(struct campaign *campaign, struct task *task)
{
	enum { LEAST = 1 << 16 }; /* beside a checkpoint that may be larger than the last */
	struct text path = {0};
	struct error ignored = {0};
	size_t size = 0;

	if ((task->state != TASK_FAILED && task->state != TASK_WAITING) ||
		(task->code != EX_IOERR && task->code != EX_CANTCREAT))
		return;
	if (!file_path(&path, task->run->folder, "run.h5", &ignored))
		(void)file_size(text_string(&path), &size);
	text_clean(&path);
	if (!file_has_room(campaign->experiment->folder, 2 * size + LEAST, &campaign->fault))
		task->state = TASK_INTERRUPTED;
}
