#!/usr/bin/env bash
# Rehearses `workers up --slurm` on one machine: a Slurm controller and two nodes of one core each, from
# Debian's packages (apt-get install slurm-wlm munge), in network, mount, process and host-name namespaces
# of its own. It needs root and leaves nothing behind.
#
#     cargo build --release && sudo deploy/slurm/rehearse.sh
#
# The same search runs on one machine; on the nodes by `workers up --slurm`, with a job that is requeued; and
# by `sbatch` of workers.sbatch as an array of jobs that reach their time limit, until `workers up` brings
# others. All must end with the same digest.
set -euo pipefail
cd "$(dirname "$0")/../.."
programs=$(realpath "${HORSEHEAD_PROGRAMS:-target/release}")
if [[ "${1:-}" != --inside ]]; then
  scratch=$(mktemp -d)
  trap 'rm -rf "$scratch"' EXIT
  mkdir -p /etc/slurm
  unshare --net --mount --pid --uts --fork --kill-child --mount-proc "$0" --inside "$scratch"
  exit
fi
scratch=$2
PATH="$programs:$PATH"
head=10.99.0.1

# a machine of its own: an address, a name, a key of munge, a controller and two daemons of nodes
ip link set lo up
ip link add spare type veth peer name other
ip address add "$head/24" dev spare
ip link set spare up
ip link set other up
hostname head
mkdir "$scratch"/{etc,log,state,n1,n2,munge}
printf '127.0.0.1 localhost\n%s head\n' "$head" >"$scratch/hosts"
mount --bind "$scratch/hosts" /etc/hosts
mount --bind "$scratch/etc" /etc/slurm
head -c 1024 /dev/urandom >"$scratch/munge/key"
chmod 400 "$scratch/munge/key"
munged --force --key-file="$scratch/munge/key" --socket="$scratch/munge/socket" \
  --pid-file="$scratch/munge/pid" --log-file="$scratch/munge/log" --seed-file="$scratch/munge/seed"
# a requeued job may begin again when its credential has expired, by default after two minutes
cat >/etc/slurm/slurm.conf <<END
ClusterName=rehearsal
SlurmctldHost=head($head)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$scratch/munge/socket,cred_expire=5
StateSaveLocation=$scratch/state
SlurmdSpoolDir=$scratch/%n
SlurmctldPidFile=$scratch/controller.pid
SlurmdPidFile=$scratch/%n.pid
SlurmctldLogFile=$scratch/log/controller
SlurmdLogFile=$scratch/log/%n
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
MpiDefault=none
NodeName=n1 NodeHostname=head NodeAddr=$head Port=17001 CPUs=1 RealMemory=1000
NodeName=n2 NodeHostname=head NodeAddr=$head Port=17002 CPUs=1 RealMemory=1000
PartitionName=spare Nodes=n1,n2 Default=YES State=UP
END
slurmctld
slurmd -N n1
slurmd -N n2
until [[ "$(sinfo --noheader --format=%t)" == idle ]]; do sleep 0.5; done

# the output of a job is a file in the folder in which it is handed in
repository=$PWD
cd "$scratch"

show() {
  printf '\n$ %s\n' "$*"
  "$@"
}
calibrate() {
  local search=(horsehead calibrate "$repository/cases/cyjs10-5-37hb" --preset paper --set generations=6)
  "${search[@]}" --run "$1" --output json "${@:2}" >"$1.json" 2>"$1.log"
}
listen() {
  calibrate "$1" --workers 0 --listen "quic/$head:7447" --tls keys &
  run=$!
}
finish() {
  wait "$run"
  printf '\n%s: digest %s\n' "$1" "$(grep -o '"log_digest": *"[^"]*"' "$1.json" | cut -d'"' -f4)"
}
in_state() {
  { horsehead workers list --run "$1" --output json 2>/dev/null || true; } | grep -o "\"$2\"" | wc -l
}
wait_for() {
  for _ in $(seq 480); do
    if [[ "$(in_state "$1" "$2")" == "$3" ]]; then return; fi
    sleep 0.5
  done
  echo "in vain: $*" >&2
  exit 1
}

calibrate one-machine --workers 2 &
run=$!
finish one-machine

show horsehead keys new keys --workers 2 --host "$head" >keys.log 2>&1
listen requeued
show horsehead workers up --connect "quic/$head:7447" --tls keys --slurm nodes=2,time=00:10:00
wait_for requeued working 2
sleep 10
show squeue
show horsehead workers list --run requeued
show scontrol requeue 1
wait_for requeued working 0
show squeue
wait_for requeued working 2
show squeue
show horsehead workers list --run requeued
finish requeued
show scancel --user root
until [[ -z "$(squeue --noheader)" ]]; do sleep 0.5; done

listen time-limit
show sbatch --array=1-2 --nodes=1 --time=1 \
  "--export=ALL,HORSEHEAD_CONNECT=quic/$head:7447,HORSEHEAD_TLS=$scratch/keys/worker-01" \
  "$repository/deploy/slurm/workers.sbatch"
wait_for time-limit working 2
show squeue
wait_for time-limit working 0
show horsehead workers list --run time-limit
show horsehead workers up --connect "quic/$head:7447" --tls keys --slurm nodes=2,time=00:10:00
finish time-limit
show tail --lines=3 slurm-2_1.out
