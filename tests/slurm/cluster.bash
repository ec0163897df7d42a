# shellcheck shell=bash
# A Slurm of this machine's own: one node on 127.0.0.1 with a munge, state, ports and logs of its own,
# below $cluster. Started with cluster_start, ended with cluster_stop; nothing is left behind.

cluster=$(mktemp -d "${TMPDIR:-/tmp}/talus-slurm-XXXXXX")
export SLURM_CONF=$cluster/slurm.conf
munged=() munged_pid='' slurmctld_pid='' slurmd_pid=''

free_port() # FROM: the first port from there on that nobody listens on
{
	local port=$1

	while (: <"/dev/tcp/127.0.0.1/$port") 2>/dev/null; do
		port=$((port + 1))
	done
	echo "$port"
}

write_conf()
{
	local host ctld_port

	host=$(hostname -s)
	ctld_port=$(free_port $((20000 + RANDOM % 10000)))
	cat >"$SLURM_CONF" <<-END
		ClusterName=talus
		SlurmctldHost=$host(127.0.0.1)
		SlurmctldPort=$ctld_port
		SlurmdPort=$(free_port $((ctld_port + 1)))
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
		AccountingStorageType=accounting_storage/none
		JobAcctGatherType=jobacct_gather/none
		SchedulerParameters=batch_sched_delay=0,sched_interval=1,bf_interval=1
		ReturnToService=2
		MaxArraySize=4
		SlurmdTimeout=10
		KillWait=5
		MinJobAge=60
		NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
		PartitionName=work Nodes=$host Default=YES MaxTime=10 DefaultTime=5
	END
}

start_munged()
{
	install -d -m 755 "$cluster/munge"
	dd if=/dev/urandom of="$cluster/munge/key" bs=1024 count=1 status=none
	chmod 600 "$cluster/munge/key"
	if (($(id -u) == 0)); then
		chown -R munge: "$cluster/munge"
		munged=(setpriv --reuid=munge --regid=munge --clear-groups)
	fi
	"${munged[@]}" "$(command -v munged || echo /usr/sbin/munged)" --foreground \
		--key-file="$cluster/munge/key" --socket="$cluster/munge/socket" \
		--pid-file="$cluster/munge/pid" --seed-file="$cluster/munge/seed" \
		--log-file="$cluster/munge/log" 2>"$cluster/munged.err" &
	munged_pid=$!
}

start_slurmctld()
{
	slurmctld -D -f "$SLURM_CONF" >"$cluster/slurmctld.out" 2>&1 &
	slurmctld_pid=$!
}

start_slurmd()
{
	slurmd -D -f "$SLURM_CONF" >"$cluster/slurmd.out" 2>&1 &
	slurmd_pid=$!
}

node_is_up()
{
	sinfo --noheader --format=%T 2>/dev/null | grep -Eq '^(idle|mixed|allocated)$'
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
