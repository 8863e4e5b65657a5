#!/bin/bash
# Make data sets through Slurm and locally, and compare every file: `make slurm`, or stress/slurm.sh CONFIGURATION for
# all products of another configuration. Where sinfo finds no cluster, one of one node is started on this machine, from
# the packages of Debian, and ended afterwards; that needs root.
set -euo pipefail
cd "$(dirname "$0")/.."
configuration=${1:-workflow/config/smoke.yaml}
# of smoke.yaml: boundaries, cubes and a figure, by jobs of the cluster and by local ones
targets=(results/spectra/sine/eta-0.85.nc results/spectra/cosine/eta-0.85.nc results/figures/figure-scale-law.nc)
[ $# = 0 ] || targets=()
folder=$(mktemp -d)
settings=/etc/slurm/slurm.conf # where job steps look for them
trap 'kill $(jobs -p) 2>/dev/null || true; wait; rm -rf "$folder" ${started:+"$settings"}' EXIT

until_succeeds() {
    for _ in {1..120}; do "$@" >"$folder/wait.log" 2>&1 && return; sleep 0.5; done
    cat "$folder"/*.log >&2
    return 1
}

if ! sinfo --noheader >/dev/null 2>&1; then
    [ ! -e "$settings" ] || { echo "$settings exists, but its cluster does not answer" >&2; exit 1; }
    [ "$(id -u)" = 0 ] || { echo 'no cluster answers sinfo, and only root can start one' >&2; exit 1; }
    type slurmctld slurmd sbatch munged >/dev/null 2>&1 ||
        DEBIAN_FRONTEND=noninteractive apt-get install --yes --no-install-recommends slurmctld slurmd slurm-client munge
    host=$(hostname -s)
    mkdir -p "$folder"/{state,spool} /run/munge /etc/slurm
    started=yes
    cat >"$settings" <<SETTINGS
ClusterName=rocking
SlurmctldHost=$host(127.0.0.1)
AuthType=auth/munge
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
SlurmUser=root
SlurmdUser=root
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
ReturnToService=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) RealMemory=$(free -m | awk '/^Mem/ {print int(0.9 * $2)}') State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
SETTINGS
    if ! munge --no-input >/dev/null 2>&1; then
        chown munge:munge /run/munge
        setpriv --reuid munge --regid munge --clear-groups munged --foreground >"$folder/munged.log" 2>&1 &
        until_succeeds munge --no-input
    fi
    slurmctld -D >"$folder/slurmctld.log" 2>&1 &
    slurmd -D >"$folder/slurmd.log" 2>&1 &
    until_succeeds srun --immediate=5 true
fi

export PYTHONPATH=$PWD/build/slurm${PYTHONPATH:+:$PYTHONPATH}
make_in() {
    local begin=$SECONDS directory=$1
    snakemake "${@:2}" --configfile "$configuration" --directory "$directory" --nocolor -- "${targets[@]}"
    echo "$(basename "$directory"): $((SECONDS - begin)) s"
}
make_in "$folder/slurm" --workflow-profile profiles/slurm --slurm-no-account --slurm-status-command squeue
make_in "$folder/local" --cores all
diff -r "$folder/local/results" "$folder/slurm/results"
echo "all $(find "$folder/local/results" -type f | wc -l) files are equal"
