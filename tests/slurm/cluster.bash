# shellcheck shell=bash
# A Slurm of this machine's own: one node on 127.0.0.1 with munge, state, ports and logs of its own below
# $cluster. cluster_start starts it, cluster_stop ends it and leaves nothing behind.

cluster=$(mktemp -d "${TMPDIR:-/tmp}/talus-slurm-XXXXXX")
export SLURM_CONF=$cluster/slurm.conf
munged_pid='' slurmctld_pid='' slurmctld_began='' slurmd_pid=''

wait_for() # SECONDS COMMAND...: until it succeeds
{
	local end=$((SECONDS + $1))

	shift
	until "$@"; do
		((SECONDS < end)) || return 1
		sleep 0.1
	done
}

free_port() # FROM: the first from there on that nobody listens on
{
	local port=$1

	while (: <"/dev/tcp/127.0.0.1/$port") 2>/dev/null; do
		port=$((port + 1))
	done
	echo "$port"
}

# The node claims four processors, whatever the machine has, so that more tasks could run at a time than
# a throttle of two lets through.
write_conf()
{
	local host port

	host=$(hostname -s)
	port=$(free_port $((20000 + RANDOM % 10000)))
	cat >"$SLURM_CONF" <<-END
		ClusterName=talus
		SlurmctldHost=$host(127.0.0.1)
		SlurmctldPort=$port
		SlurmdPort=$(free_port $((port + 1)))
		SlurmUser=$(id -un)
		SlurmdUser=$(id -un)
		AuthType=auth/munge
		AuthInfo=socket=$cluster/munge/socket,cred_expire=5
		CredType=cred/munge
		StateSaveLocation=$cluster/state
		SlurmdSpoolDir=$cluster/spool
		SlurmctldPidFile=$cluster/slurmctld.pid
		SlurmdPidFile=$cluster/slurmd.pid
		SlurmctldLogFile=$cluster/slurmctld.log
		SlurmdLogFile=$cluster/slurmd.log
		ProctrackType=proctrack/linuxproc
		TaskPlugin=task/none
		SwitchType=switch/none
		MpiDefault=none
		SelectType=select/cons_tres
		SelectTypeParameters=CR_Core
		SlurmdParameters=config_overrides
		SchedulerParameters=batch_sched_delay=0,sched_interval=1,bf_interval=1
		ReturnToService=2
		MaxArraySize=4
		SlurmdTimeout=5
		PreemptType=preempt/partition_prio
		PreemptMode=REQUEUE
		KillWait=10
		NodeName=$host NodeAddr=127.0.0.1 CPUs=4 RealMemory=1000 State=UNKNOWN
		PartitionName=work Nodes=$host Default=YES MaxTime=10 DefaultTime=5
		PartitionName=urgent Nodes=$host PriorityTier=9 MaxTime=10 DefaultTime=5
	END
}

start_munged()
{
	local as_munge=()

	install -d -m 755 "$cluster/munge"
	dd if=/dev/urandom of="$cluster/munge/key" bs=1024 count=1 status=none
	chmod 600 "$cluster/munge/key"
	if (($(id -u) == 0)); then
		chown -R munge: "$cluster/munge"
		as_munge=(setpriv --reuid=munge --regid=munge --clear-groups)
	fi
	"${as_munge[@]}" munged --foreground --key-file="$cluster/munge/key" \
		--socket="$cluster/munge/socket" --pid-file="$cluster/munge/pid" \
		--seed-file="$cluster/munge/seed" --log-file="$cluster/munge/log" >"$cluster/munged.log" 2>&1 &
	munged_pid=$!
}

start_slurmctld()
{
	slurmctld -D -f "$SLURM_CONF" >/dev/null 2>&1 &
	slurmctld_pid=$! slurmctld_began=$SECONDS
}

start_slurmd()
{
	slurmd -D -f "$SLURM_CONF" >/dev/null 2>&1 &
	slurmd_pid=$!
}

node_is_up()
{
	sinfo --noheader --format=%T 2>/dev/null | grep -Eq '^(idle|mixed|allocated)$'
}

node_is_down()
{
	sinfo --noheader --format=%T 2>/dev/null | grep -q '^down'
}

cluster_start()
{
	PATH=$PATH:/usr/sbin:/sbin
	chmod 755 "$cluster"
	mkdir "$cluster/state" "$cluster/spool"
	start_munged
	wait_for 10 test -S "$cluster/munge/socket" || return
	write_conf
	start_slurmctld
	start_slurmd
	wait_for 30 node_is_up
}

# The processes of this cluster's jobs and of the daemons that watch over them.
job_processes()
{
	local folder

	for folder in /proc/[0-9]*; do
		tr '\0' '\n' <"$folder/environ" 2>/dev/null | grep -Fxq "SLURM_CONF=$SLURM_CONF" || continue
		if [[ $(<"$folder/comm") == slurmstepd ]]; then
			echo "${folder#/proc/}"
		elif tr '\0' '\n' <"$folder/environ" | grep -q '^SLURM_JOB_ID='; then
			echo "${folder#/proc/}"
		fi
	done 2>/dev/null
}

# The node dies: daemon, jobs and all. `slurmd` alone: only the daemon.
kill_slurmd()
{
	kill -KILL "$slurmd_pid"
	wait "$slurmd_pid"
} 2>/dev/null

kill_node()
{
	# shellcheck disable=SC2046 # a list
	kill -KILL "$slurmd_pid" $(job_processes)
	wait "$slurmd_pid"
} 2>/dev/null

cluster_stop()
{
	[[ ! $slurmd_pid ]] || kill_node
	[[ ! $slurmctld_pid ]] || kill -KILL "$slurmctld_pid"
	[[ ! $munged_pid ]] || kill "$munged_pid"
	wait
	[[ ! ${mounted:-} ]] || umount "$mounted"
	rm -rf "$cluster"
} 2>/dev/null
